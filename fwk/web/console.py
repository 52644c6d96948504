"""State that all pages of a console share."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fwk.lcm.event_log import LogError
from fwk.web.extensions import Extensions
from fwk.web.log_tail import LogTails
from fwk.web.rates import Rates
from fwk.web.recorded import RecordedRun, RecordedRuns
from fwk.web.run_link import Runs
from fwk.web.shared import Shared


@dataclass(frozen=True)
class Console:
    """State that all pages of a console share.

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
    opened: RecordedRuns = field(default_factory=RecordedRuns)
    rates: dict[int, Rates] = field(default_factory=dict)
    """Rates of channels by process of a run."""

    def recorded(self, name: str) -> RecordedRun:
        """Returns the recording in the run directory of that name.

        Raises:
            LogError: there is none, or it cannot be read.
        """
        for each in self.recordings():
            if Path(each["path"]).name == name:
                return self.opened.of(each["path"])
        raise LogError(f"no recording '{name}'; 'fwk runs list' shows all")


STATIC = Path(__file__).with_name("static")
