"""The text log once more for programs: one JSON object a line."""

import json

from fwk.component.log import LEVEL_NAMES
from fwk.lcm.messages import to_dict
from fwk.logs.rotating import RotatingFile
from lcmtypes.core import log_t

FILE = "fwk.log.jsonl"


class JsonLog:
    """A sink of the gateway: the fields of `core.log_t`, the level as a word."""

    def __init__(self, file: RotatingFile) -> None:
        self._file = file

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        """Adds a line of text; anything else is not its business."""
        if channel != "fwk/log":
            return
        line = to_dict(log_t.decode(data))
        line["level"] = LEVEL_NAMES.get(line["level"], str(line["level"]))
        self._file.write(json.dumps(line))

    def tick(self) -> None:
        """Nothing to do."""

    def close(self) -> None:
        """Closes the file."""
        self._file.close()
