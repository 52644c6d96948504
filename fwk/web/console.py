"""What all pages of a console share."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fwk.web.extensions import Extensions
from fwk.web.log_tail import LogTails
from fwk.web.run_link import Runs
from fwk.web.shared import Shared


@dataclass(frozen=True)
class Console:
    """What all pages of a console share.

    Args:
        runs: the runs of this machine.
        shared: answers that browsers share.
        extensions: views and pages of projects.
        logs: the newest lines of the logs.
        recordings: lists the run directories, the newest first.
        run: name of the run that pages show at first; empty: the only one, or the first.
    """

    runs: Runs
    shared: Shared
    extensions: Extensions
    logs: LogTails
    recordings: Callable[[], list[dict[str, Any]]]
    run: str = ""


STATIC = Path(__file__).with_name("static")
