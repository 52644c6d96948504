"""Counts the modules of fwk that an event passes: `python -m tests.simulation.passed_modules`.

A small system is simulated in one thread, and every call of a function is noted by module and process. A tick
passes the modules that run in quiet ticks. A change and a crash pass the further modules that run until the tick
after them.
"""

import sys
import tempfile
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

from fwk.model.plan import Plan
from tests.simulation.faults import Action
from tests.simulation.scenario import Part, Scenario
from tests.simulation.system import System
from tests.simulation.trace import Trace

QUIET = range(6, 12)
"""Ticks in which nothing but ticks happens."""
EVENT_TICK = 13
LAST_TICK = 18
_FWK = Path(sys.modules[Plan.__module__].__file__ or "").parents[1]

Passed = dict[str, set[str]]
"""By process: the modules whose functions were called."""


class Watched(System):
    """A system that notes which modules run in quiet ticks and after the event."""

    def __init__(self, scenario: Scenario, folder: Path) -> None:
        self.quiet: Passed = defaultdict(set)
        self.later: Passed = defaultdict(set)
        self._noted: Passed | None = None
        self._modules: dict[CodeType, str] = {}
        super().__init__(scenario, folder, Trace(False))

    def note(self, frame: FrameType, event: str, _argument: Any) -> None:
        """Notes a call; an argument for `sys.setprofile`."""
        running = self.world.running
        if event != "call" or self._noted is None or running is None:
            return
        code = frame.f_code
        module = self._modules.get(code)
        if module is None:
            path = Path(code.co_filename)
            inside = path.is_relative_to(_FWK) and "<" not in path.name
            module = self._modules[code] = str(path.relative_to(_FWK)).removesuffix(".py") if inside else ""
        if module:
            process = running.name if running.name in ("supervisor", "gateway") else "host"
            self._noted[process].add(module)

    def _reached(self, tick: int) -> None:
        self._noted = self.quiet if tick in QUIET else self.later if EVENT_TICK <= tick < LAST_TICK else None
        super()._reached(tick)


def passed(*actions: Action) -> tuple[Passed, Passed]:
    """Returns the modules that run in quiet ticks, and after the actions."""
    parts = (Part("b0/player", "Player"), Part("c1/player", "Player", ("act",)))
    scenario = Scenario(seed=1, ticks=20, parts=parts, stages=("think", "act"), actions=actions)
    with tempfile.TemporaryDirectory() as folder:
        system = Watched(scenario, Path(folder))
        profile: Callable[..., None] = system.note
        sys.setprofile(profile)
        try:
            system.run()
        finally:
            sys.setprofile(None)
    return system.quiet, system.later


def report(event: str, modules: Passed) -> str:
    """Describes the modules that an event passes, in all processes together and in each."""
    together = set().union(*modules.values())
    each = ", ".join(f"{process} {len(found)}" for process, found in sorted(modules.items()))
    return f"{event}: {len(together)} modules ({each}): {' '.join(sorted(together))}"


def main() -> None:
    """Prints the figures."""
    tick, _ = passed()
    print(report("tick", tick))
    events = {
        "settings change": Action("set", EVENT_TICK, 0, "b0/player", amount=3),
        "crash": Action("kill", EVENT_TICK, 0, "b0/player"),
    }
    for event, action in events.items():
        quiet, later = passed(action)
        further = {process: found - quiet[process] for process, found in later.items()}
        print(report(f"{event}, beside those of a tick", further))


if __name__ == "__main__":
    main()
