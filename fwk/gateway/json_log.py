"""The text log once more for programs: one JSON object a line."""

import contextlib
import json
from pathlib import Path

from fwk.aspects.logging import LEVEL_NAMES
from fwk.messages import to_dict
from lcmtypes.core import log_t

FILE = "fwk.log.jsonl"


class JsonLog:
    """A sink of the gateway: the fields of `core.log_t`, the level as a word."""

    def __init__(self, path: Path) -> None:
        self._file = open(path, "a", buffering=1, encoding="utf-8")  # noqa: SIM115 - closed by close()

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        """Adds a line of text; anything else is not its business."""
        if channel != "fwk/log":
            return
        line = to_dict(log_t.decode(data))
        line["level"] = LEVEL_NAMES.get(line["level"], str(line["level"]))
        with contextlib.suppress(OSError):  # a full disk: the run goes on, the bus still has the lines
            self._file.write(json.dumps(line) + "\n")

    def tick(self) -> None:
        """Nothing to do."""

    def close(self) -> None:
        """Closes the file."""
        with contextlib.suppress(OSError):
            self._file.close()
