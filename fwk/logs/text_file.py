"""The text log for people."""

from fwk.clock import US_PER_S
from fwk.component.log import LEVEL_NAMES
from fwk.logs.rotating import RotatingFile
from lcmtypes.core import log_t

FILE = "fwk.log"


class TextLog:
    """Sink of the gateway that writes wall time, tick, logical time, level, component, place and text of each line."""

    def __init__(self, file: RotatingFile) -> None:
        self._file = file

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        """Writes a line of text; ignores all other messages."""
        if channel != "fwk/log":
            return
        line = log_t.decode(data)
        self._file.write(
            f"{line.wall_us / US_PER_S:.6f} tick {line.tick} {line.time_us / US_PER_S:.3f} s "
            f"{LEVEL_NAMES.get(line.level, '?')} {line.component} {line.file}:{line.line}: {line.text}"
        )

    def tick(self) -> None:
        """Does nothing."""

    def close(self) -> None:
        """Closes the file."""
        self._file.close()
