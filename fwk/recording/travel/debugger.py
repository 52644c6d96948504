"""pdb in a replay, with commands that go back: `back`, `goto`, `until`."""

import bdb
import os
import signal
import sys
import threading
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib import import_module
from types import CodeType
from typing import Any

from fwk.component.component import Component
from fwk.engine.failures import ComponentFailedError, DebuggerLeft
from fwk.host.debugger import QuietPdb, first_line_of_loop
from fwk.model.plan import ComponentPlan
from fwk.recording.travel.snapshots import Snapshot, Snapshots

LEFT = "left"
"""Result of a replay whose debugger was left."""
SNAPSHOT_COST_S = 0.2
"""CPU time of the replay between two snapshots."""
PROGRESS_S = 1.0
"""CPU time between two lines that say where a travel is."""
_NOTHING = 1 << 62
_ENDED = "the component has failed; nothing comes after this iteration"


@dataclass
class Order:
    """Place where the replay stops next; survives going back."""

    iteration: int = _NOTHING
    """Iteration of the component, from 1, at which it stops."""
    tick: int = _NOTHING
    """Tick from which on it stops."""
    condition: str = ""
    """Expression that holds where it stops; empty: none."""
    before: int = 0
    """Searches backwards: the iteration to stop at is the last one before this one where `condition` holds; 0: no."""
    came_from: int = 0
    """Iteration at which the order was given; 0: before the first one."""
    breakpoints: list[tuple[str, int, bool, str | None]] = field(default_factory=list)


class TravelPdb(QuietPdb):
    """pdb with the commands of a `Travel`."""

    def __init__(self, travel: "Travel") -> None:
        super().__init__(nosigint=True, skip=["fwk.*"])
        self._travel = travel

    def do_back(self, arg: str) -> bool | None:
        """Goes back by iterations of the component: `back`, `back N`; or to the last one where a condition holds:
        `back until self.ball.value.x_m > 2`.
        """
        word, _, condition = arg.strip().partition(" ")
        if word == "until" and condition.strip():
            return self._done(self._travel.search_back(condition.strip()))
        if word and not word.isdigit():
            self.error("back takes a number of iterations, or 'until CONDITION'")
            return None
        return self._done(self._travel.back(int(word or 1)))

    def do_goto(self, arg: str) -> bool | None:
        """Goes to the first iteration of the component in a tick or after it, back or forward: `goto TICK`."""
        if not arg.strip().isdigit():
            self.error("goto takes a tick: goto 1200")
            return None
        return self._done(self._travel.goto(int(arg)))

    def do_until(self, arg: str) -> bool | None:
        """Continues to the next iteration where a condition holds: `until self.ball.value.x_m > 2`; `until` and
        `until LINE` are those of pdb.
        """
        if not arg.strip() or arg.strip().isdigit():
            return bool(super().do_until(arg)) or None
        return self._done(self._travel.until(arg.strip()))

    do_unt = do_until

    def _done(self, problem: str) -> bool | None:
        """Shows a problem and keeps the prompt, or continues."""
        if problem:
            self.error(problem)
            return None
        self.set_continue()
        return True


class Travel:
    """A replay under pdb that can go back.

    Args:
        component: the debugged component.
        snapshots: the processes to go back to.
        from_tick: the first stop is at the first iteration from this tick on.
    """

    def __init__(self, component: ComponentPlan, snapshots: Snapshots, from_tick: int) -> None:
        self.tick = 0
        self.iterations = 0
        """Iterations of the component so far."""
        self._plan = component
        self._snapshots = snapshots
        self._order = Order(tick=from_tick)
        self._code: CodeType | None = None  # of the condition
        self._component: Component | None = None
        self._found = 0  # last iteration where the condition of a search holds
        self._begun_s = -SNAPSHOT_COST_S  # CPU time at the newest snapshot
        self._cost_s = 0.0  # CPU time of the replay until then
        self._told_s = 0.0  # CPU time of the replay at the last line of progress
        self._class: Any = getattr(import_module(component.module), component.class_name)
        self._line = first_line_of_loop(component)
        self._pdb = TravelPdb(self)
        self._threads = threading.active_count()
        self._failed = False  # the component has raised: there is only a past

    def run(self, work: Callable[[Callable[[int], None]], None]) -> str:
        """Runs a replay; returns `LEFT` if the user left the debugger. `work` calls its argument before each tick."""
        loop = self._class.loop
        travel = self

        def watched(component: Component) -> None:
            if component.name != travel._plan.name:
                loop(component)
                return
            travel._enter(component)
            try:
                loop(component)
            finally:
                travel._leave()

        self._class.loop = watched
        signal.signal(signal.SIGINT, self._pdb.on_interrupt)
        print(f"fwk: {self._plan.name} under pdb; it stops at the beginning of loop()", flush=True)
        print(
            "fwk: 'c' continues, 'back', 'back N', 'goto TICK', 'until CONDITION' and 'back until CONDITION' travel, "
            "'q' ends the replay",
            flush=True,
        )
        try:
            work(self._begin)
            while self._order.before:  # the search reached the end of the recording
                self._end_search()
            self._end_forward()
        except DebuggerLeft:
            return LEFT
        except ComponentFailedError as failure:
            sys.settrace(None)
            self._failed = True
            print(f"fwk: {failure}", flush=True)
            print("fwk: stopped where the exception was raised; 'back' travels, 'q' ends the replay", flush=True)
            self._pdb.look_back_at(failure.__cause__ or failure)
            return LEFT
        finally:
            sys.settrace(None)
            self._class.loop = loop
        return ""

    def back(self, number: int) -> str:
        """Goes back by a number of iterations; returns a problem."""
        if number >= self.iterations:
            return f"there are {self.iterations - 1} iterations before this one"
        return self._go(Order(iteration=self.iterations - number))

    def goto(self, tick: int) -> str:
        """Goes to a tick; returns a problem."""
        return self._go(Order(tick=tick))

    def until(self, condition: str) -> str:
        """Goes on to the next iteration where a condition holds; returns a problem."""
        problem = self._compile(condition) or (_ENDED if self._failed else "")
        if not problem:
            self._order = Order(condition=condition, came_from=self.iterations)
        return problem

    def search_back(self, condition: str) -> str:
        """Goes back to the last iteration where a condition holds; returns a problem."""
        if problem := self._compile(condition):
            return problem
        order = Order(condition=condition, before=self.iterations, came_from=self.iterations)
        return self._go_back(order, lambda each: each.iterations < order.before - 1)

    def _go(self, order: Order) -> str:
        """Carries out an order that lies before the present iteration, or after it."""
        if order.iteration > self.iterations and order.tick > self.tick:
            order.came_from = self.iterations
            self._order = order
            return _ENDED if self._failed else ""
        return self._go_back(order, lambda each: each.iterations < order.iteration and each.tick <= order.tick)

    def _go_back(self, order: Order, fits: Callable[[Snapshot], bool]) -> str:
        order.breakpoints = [
            (each.file, each.line, each.temporary, each.cond)
            for each in bdb.Breakpoint.bpbynumber
            if each and not each.temporary
        ]
        while snapshot := self._snapshots.last_before(fits):
            self._snapshots.go_back(snapshot, order)
        if threading.active_count() > self._threads:
            return f"{self._plan.name} has started threads, which no snapshot keeps; run the replay again"
        return "there is no earlier iteration"

    def _begin(self, tick: int) -> None:
        """Begins a tick: leaves a snapshot behind if the last one is long ago."""
        self.tick = tick
        cost_s = _cpu_s() - self._begun_s
        if self._cost_s + cost_s >= self._told_s + PROGRESS_S:
            self._told_s = self._cost_s + cost_s
            self._show(f"replaying tick {tick}")
        if cost_s < SNAPSHOT_COST_S or self._order.before or threading.active_count() > self._threads:
            return
        self._cost_s += cost_s
        order = self._snapshots.take(tick, self.iterations, self._cost_s)
        self._begun_s = _cpu_s()
        if order:
            self._resume(order)

    def _resume(self, order: Order) -> None:
        """Goes on from a snapshot with the order of a later front."""
        sys.settrace(None)
        self._order, self._found = order, 0
        self._pdb.clear_all_breaks()
        bdb.Breakpoint.clearBreakpoints()  # numbers begin with 1 again
        for file, line, temporary, condition in order.breakpoints:
            self._pdb.set_break(file, line, temporary, condition)
        if order.condition:
            self._compile(order.condition)

    def _enter(self, component: Component) -> None:
        """Begins an iteration: stops in it if the order says so."""
        self.iterations += 1
        self._component = component
        order = self._order
        if order.before:
            if self.iterations < order.before:
                self._found = self.iterations if self._holds() else self._found
                return
            self._end_search()
            order = self._order
        reached = self.iterations >= order.iteration or self.tick >= order.tick
        if reached or (order.condition and not order.before and self._holds()):
            self._order = Order()
            self._stop()

    def _leave(self) -> None:
        """Ends an iteration: a step out of it leads into the next one; without breakpoints nothing else is traced."""
        if not sys.gettrace():
            return
        stepping = self._pdb.stopframe is not self._pdb.botframe
        if stepping:
            self._order = Order(iteration=self.iterations + 1)
        if stepping or not self._pdb.breaks:
            sys.settrace(None)

    def _end_search(self) -> None:
        """Goes to what a search has found between a snapshot and its end, or searches before that snapshot."""
        order = self._order
        if self._found:
            self._go_back(Order(iteration=self._found), lambda each: each.iterations < self._found)
        start = self._snapshots.last_before(lambda each: each.iterations < order.before - 1)
        first = start.iterations + 1 if start else 1
        earlier = Order(condition=order.condition, before=first, came_from=order.came_from)
        if first > 1:
            self._go_back(earlier, lambda each: each.iterations < first - 1)
        print(f"fwk: no earlier iteration where {order.condition}", flush=True)
        self._order = Order(iteration=order.came_from)

    def _end_forward(self) -> None:
        """Ends an order that the end of the recording has left undone: goes back to where it was given."""
        order = self._order
        if order.condition or order.tick != _NOTHING:
            what = f"where {order.condition}" if order.condition else f"in tick {order.tick} or after it"
            print(f"fwk: the recording ends without an iteration {what}", flush=True)
        if order.came_from:
            self._go_back(Order(iteration=order.came_from), lambda each: each.iterations < order.came_from)

    def _stop(self) -> None:
        """Starts tracing, with a stop at the first line of the running iteration."""
        self._show("")
        print(f"fwk: tick {self.tick}", flush=True)
        debugger = self._pdb
        debugger.reset()
        debugger.botframe = sys._getframe(2)  # no frame below the component's is stepped into
        debugger.begin_at(*self._line, lambda component: component.name == self._plan.name)
        debugger.set_continue()
        sys.breakpointhook = lambda *_, **__: debugger.set_trace(sys._getframe(1))
        sys.settrace(debugger.trace_dispatch)

    def _show(self, progress: str) -> None:
        """Shows on a terminal where a long travel is, in a line that the next output replaces."""
        if sys.stderr.isatty():
            print(f"\r\x1b[K{progress}", end="", file=sys.stderr, flush=True)

    def _compile(self, condition: str) -> str:
        """Compiles a condition, and tries it in the present iteration; returns a problem."""
        try:
            self._code = compile(condition, "<condition>", "eval")
            if self._component:
                eval(self._code, self._globals(), {"self": self._component})
        except Exception as error:
            return f"{condition}: {type(error).__name__}: {error}"
        return ""

    def _holds(self) -> bool:
        """Returns whether the condition holds at the beginning of the iteration; one that raises does not."""
        assert self._code
        try:
            return bool(eval(self._code, self._globals(), {"self": self._component}))
        except Exception:
            return False

    def _globals(self) -> dict[str, Any]:
        return vars(sys.modules[self._class.__module__])


def _cpu_s() -> float:
    """Returns the CPU time of this process and of those that it has continued, in s."""
    times = os.times()
    return times.user + times.system
