"""Counts the modules of fwk that an event passes: `python -m tests.simulation.passed_modules`.

A small system is simulated in one thread, and every call of a function is noted by module and process. A tick
passes the modules that run in quiet ticks. A change and a crash pass the further modules that run until the tick
after them. A message passes the modules with a function that takes or returns it, as an object or as bytes.
"""

import sys
import tempfile
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

from lcmtypes.simulation import note_t

from fwk.model.plan import Plan
from tests.simulation.faults import Action
from tests.simulation.scenario import Part, Scenario
from tests.simulation.system import System
from tests.simulation.trace import Trace

WRITER = "b0/player"
_MARK = note_t._get_packed_fingerprint()
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
        self.message: Passed = defaultdict(set)
        self._noted: Passed | None = None
        self._modules: dict[CodeType, str] = {}
        super().__init__(scenario, folder, Trace(False))

    def note(self, frame: FrameType, event: str, argument: Any) -> None:
        """Notes a call; an argument for `sys.setprofile`."""
        running = self.world.running
        if event not in ("call", "return") or self._noted is None or running is None:
            return
        code = frame.f_code
        found = (
            argument if event == "return" else [frame.f_locals[name] for name in code.co_varnames[: code.co_argcount]]
        )
        message = self._noted is self.quiet and _holds_message(found)
        if event == "return" and not message:
            return
        module = self._modules.get(code)
        if module is None:
            path = Path(code.co_filename)
            inside = path.is_relative_to(_FWK) and "<" not in path.name
            module = self._modules[code] = str(path.relative_to(_FWK)).removesuffix(".py") if inside else ""
        if module:
            process = running.name if running.name in ("supervisor", "gateway") else "host"
            self._noted[process].add(module)
            if message:
                self.message[process].add(module)

    def _reached(self, tick: int) -> None:
        self._noted = self.quiet if tick in QUIET else self.later if EVENT_TICK <= tick < LAST_TICK else None
        super()._reached(tick)


def _holds_message(value: Any, depth: int = 3) -> bool:
    """Returns whether a value is the message of `WRITER`, its bytes, a datagram of it, or a collection with one."""
    if isinstance(value, bytes):
        return _MARK in value and WRITER.encode() in value
    if isinstance(value, note_t):
        return bool(value.header.writer == WRITER)
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list | tuple) and depth:
        return any(_holds_message(each, depth - 1) for each in value)
    return False


def watched(*actions: Action) -> Watched:
    """Returns a system that has run with these actions."""
    parts = (Part(WRITER, "Player"), Part("c1/player", "Player", ("act",)))
    scenario = Scenario(seed=1, ticks=20, parts=parts, stages=("think", "act"), actions=actions)
    with tempfile.TemporaryDirectory() as folder:
        system = Watched(scenario, Path(folder))
        profile: Callable[..., None] = system.note
        sys.setprofile(profile)
        try:
            system.run()
        finally:
            sys.setprofile(None)
    return system


def report(event: str, modules: Passed) -> str:
    """Describes the modules that an event passes, in all processes together and in each."""
    together = set().union(*modules.values())
    each = ", ".join(f"{process} {len(found)}" for process, found in sorted(modules.items()))
    return f"{event}: {len(together)} modules ({each}): {' '.join(sorted(together))}"


def main() -> None:
    """Prints the figures."""
    system = watched()
    print(report("tick", system.quiet))
    print(report("message", system.message))
    events = {
        "settings change": Action("set", EVENT_TICK, 0, WRITER, amount=3),
        "crash": Action("kill", EVENT_TICK, 0, WRITER),
    }
    for event, action in events.items():
        system = watched(action)
        further = {process: found - system.quiet[process] for process, found in system.later.items()}
        print(report(f"{event}, beside those of a tick", further))


if __name__ == "__main__":
    main()
