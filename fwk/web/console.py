"""State that all pages of a console share."""

import asyncio
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fwk.lcm.event_log import LogError
from fwk.web.extensions import Extensions
from fwk.web.log_tail import LogTails
from fwk.web.rates import Rates
from fwk.web.recorded import RecordedRun, RecordedRuns
from fwk.web.recorded_link import RecordedLink
from fwk.web.run_link import RunLink, Runs
from fwk.web.shared import Shared
from fwk.web.usage import Figures, Usage

_USAGE_AGE_S = 1.5


@dataclass(frozen=True)
class Console:
    """State that all pages of a console share.

    Args:
        runs: the runs of this machine.
        shared: answers that browsers share.
        extensions: views and pages of projects.
        logs: the newest lines of the logs.
        recordings: lists the run directories, the newest first.
        run: name of the run that pages show at first; empty: the first run found.
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
    folders: dict[str, str] = field(default_factory=dict)
    """Run directories by name, as they were listed last."""
    usages: dict[str, Usage] = field(default_factory=dict)
    """Meters of CPU and memory by run."""

    async def usage(self, run: str, pids: Iterable[int]) -> dict[int, Figures]:
        """Returns CPU and memory of the processes of a run."""
        meter = self.usages.setdefault(run, Usage())
        found: dict[int, Figures] = await self.shared.get(
            ("usage", run), _USAGE_AGE_S, lambda: asyncio.to_thread(meter.measure, [*pids])
        )
        return found

    def link(self, query: Mapping[str, str], run: str = "", anew: bool = False) -> RunLink | RecordedLink:
        """Returns the source that an address names: the recording `log` at `tick`, with `anew` as it is now, or a run.

        Raises:
            LogError: there is no such recording, or it cannot be read.
        """
        if name := query.get("log", ""):
            tick = query.get("tick", "")
            return RecordedLink(self.recorded(name, anew), name, int(tick) if tick.isdecimal() else 1)
        return self.runs.link(run or query.get("run", ""))

    def recorded(self, name: str, anew: bool = False) -> RecordedRun:
        """Returns the recording in the run directory of that name; with `anew` as it is now.

        Raises:
            LogError: there is none, or it cannot be read.
        """
        if anew or name not in self.folders:
            self.folders.update({Path(each["path"]).name: each["path"] for each in self.recordings()})
        if name not in self.folders:
            raise LogError(f"no recording '{name}'; 'fwk runs list' shows all")
        return self.opened.of(self.folders[name], anew)


STATIC = Path(__file__).with_name("static")
