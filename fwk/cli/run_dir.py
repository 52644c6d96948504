"""Makes the folder that keeps what belongs to one run."""

import os
import re
from datetime import UTC, datetime
from pathlib import Path

from fwk.clock import US_PER_S, wall_us


def make_run_dir(name: str, runs: Path | None = None) -> Path:
    """Creates `<date-time>-<name>-<pid>` in `runs`, by default `~/.cache/fwk/runs`.

    Raises:
        OSError: the folder cannot be created.
    """
    when = datetime.fromtimestamp(wall_us() / US_PER_S, UTC).astimezone().strftime("%Y-%m-%dT%H-%M-%S")
    word = re.sub(r"[^\w.-]+", "_", name) or "run"
    folder = (runs or Path.home() / ".cache" / "fwk" / "runs") / f"{when}-{word}-{os.getpid()}"
    folder.mkdir(parents=True, exist_ok=True)
    return folder
