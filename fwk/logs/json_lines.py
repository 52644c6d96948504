"""The text log for programs: one JSON object a line."""

import json

from fwk.component.log import LEVEL_NAMES
from fwk.lcm.messages import to_dict
from fwk.logs.rotating import RotatingFile
from lcmtypes.core import log_t

FILE = "fwk.log.jsonl"


class JsonLog:
    """Sink of the gateway that writes the fields of `core.log_t`, with the level as a word."""

    def __init__(self, file: RotatingFile) -> None:
        self._file = file

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        """Writes a line of text; ignores all other messages."""
        if channel != "fwk/log":
            return
        line = to_dict(log_t.decode(data))
        line["level"] = LEVEL_NAMES.get(line["level"], str(line["level"]))
        self._file.write(json.dumps(line))

    def tick(self) -> None:
        """Does nothing."""

    def close(self) -> None:
        """Closes the file."""
        self._file.close()
