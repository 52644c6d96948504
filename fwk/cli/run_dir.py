"""Makes the folder that keeps what belongs to one run."""

import os
import re
from datetime import UTC, datetime
from pathlib import Path

from fwk.clock import US_PER_S, wall_us


class RunDirError(Exception):
    """The folder of a run cannot be created; says which and why."""


def make_run_dir(name: str, runs: Path | None = None) -> Path:
    """Creates `<date-time>-<name>-<pid>` in `runs`, by default `~/.cache/fwk/runs`.

    Raises:
        RunDirError: the folder cannot be created.
    """
    when = datetime.fromtimestamp(wall_us() / US_PER_S, UTC).astimezone().strftime("%Y-%m-%dT%H-%M-%S")
    word = re.sub(r"[^\w.-]+", "_", name) or "run"
    folder = (runs or Path.home() / ".cache" / "fwk" / "runs") / f"{when}-{word}-{os.getpid()}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise RunDirError(f"{folder}: cannot create the run directory there: {error.strerror}") from error
    return folder
