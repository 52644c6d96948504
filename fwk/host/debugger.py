"""Runs a host under a debugger: pdb in the terminal of fwk-launch, or debugpy for an editor to attach to."""

import inspect
import os
import pdb
import signal
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module
from types import FrameType
from typing import Any

from fwk.engine.failures import ComponentFailedError, DebuggerLeft
from fwk.model.plan import ComponentPlan

LEFT = 75
"""Exit code of a host whose debugger was left: it is given back to the supervisor, which starts it normally."""


@dataclass(frozen=True)
class DebugRequest:
    """Host to be debugged, and how."""

    host: int
    component: ComponentPlan
    debugpy_port: int = 0
    """Port on which debugpy listens; 0: pdb in the terminal."""


class DebuggerMissingError(Exception):
    """debugpy was requested and is not installed."""


def check(request: DebugRequest) -> None:
    """Checks before anything starts that the debugger is installed.

    Raises:
        DebuggerMissingError: it is not; names the command that installs it.
    """
    if request.debugpy_port:
        try:
            import_module("debugpy")
        except ImportError as error:
            raise DebuggerMissingError(
                "--debugpy: debugpy is not installed; type: pip install 'fwk[debugpy]'"
            ) from error


def debug(
    request: DebugRequest,
    serve: Callable[[], None],
    ready: Callable[[], bool] = lambda: True,
    leaving: str = "gives the component back",
) -> int:
    """Runs `serve` under the debugger, stopped where the component's first iteration begins; returns an exit code.

    Iterations before `ready` returns True do not count. An exception of a component under pdb can be examined before
    the process ends.
    """
    if request.debugpy_port:
        return _debugpy(request, serve)
    file, line = first_line_of_loop(request.component)
    debugger = QuietPdb(nosigint=True)
    debugger.begin_at(file, line, lambda component: component.name == request.component.name and ready())
    signal.signal(signal.SIGINT, debugger.on_interrupt)
    print(f"fwk: {request.component.name} under pdb; it stops at the beginning of loop()", flush=True)
    print(f"fwk: 'c' continues, Ctrl-C stops again, 'q' leaves the debugger and {leaving}", flush=True)
    try:
        debugger.run_quietly(serve)
    except DebuggerLeft:
        return LEFT
    except ComponentFailedError as failure:
        print(f"fwk: {failure}", flush=True)
        print(f"fwk: stopped where the exception was raised; 'q' leaves the debugger and {leaving}", flush=True)
        debugger.look_back_at(failure.__cause__ or failure)
        return LEFT
    return 0


class SingleLines:
    """Input that takes one line at a time from a descriptor, so that another process can read the next one."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor

    def readline(self) -> str:
        """Returns the next line; empty at the end."""
        line = bytearray()
        while not line.endswith(b"\n") and (character := os.read(self._descriptor, 1)):
            line += character
        return line.decode(errors="replace")


class QuietPdb(pdb.Pdb):
    """pdb that stops at breakpoints only, never in the code of the framework before them.

    Commands may come from a pipe, also if several processes take them in turns.
    """

    def __init__(self, **options: Any) -> None:
        if not os.isatty(0):
            options |= {"stdin": SingleLines(0), "stdout": sys.stdout}
        super().__init__(**options)
        self._silent = False
        self._first: tuple[str, int] | None = None
        self._wanted: Callable[[Any], bool] = lambda _: True

    def message(self, msg: str) -> None:
        """Prints a message, unless it tells that the temporary breakpoint is gone."""
        if not self._silent:
            super().message(msg)

    def begin_at(self, file: str, line: int, wanted: Callable[[Any], bool]) -> None:
        """Stops once at this line, when `wanted` accepts the object whose method is running."""
        self._first = (self.canonic(file), line)
        self._wanted = wanted
        self.set_break(file, line, temporary=True)

    def break_here(self, frame: FrameType) -> bool:
        """Returns whether to stop at this line; called in files with breakpoints."""
        if (self.canonic(frame.f_code.co_filename), frame.f_lineno) == self._first:
            if not self._wanted(frame.f_locals[frame.f_code.co_varnames[0]]):
                return False
            self._wanted = lambda _: True
        self._silent = True
        try:
            return bool(super().break_here(frame))
        finally:
            self._silent = False

    def run_quietly(self, work: Callable[[], object]) -> None:
        self.reset()
        self.botframe = sys._getframe()  # no call below this one is stepped into
        self.set_continue()
        sys.breakpointhook = lambda *_, **__: self.set_trace(sys._getframe(1))
        sys.settrace(self.trace_dispatch)
        try:
            work()
        finally:
            sys.settrace(None)

    def look_back_at(self, error: BaseException) -> None:
        self.reset()
        with suppress(DebuggerLeft):
            self.interaction(None, error.__traceback__)

    def on_interrupt(self, _number: int, frame: FrameType | None) -> None:
        """Handles Ctrl-C: stops at the next line of the code that runs; at the prompt ends the command that runs."""
        if self.allow_kbdint:  # type: ignore[attr-defined]
            raise KeyboardInterrupt
        sys.settrace(None)  # the debugger does not stop in itself
        self.set_trace(frame)

    def set_quit(self) -> None:
        """Leaves the debugger.

        Raises:
            DebuggerLeft: always. An `Exception`, as pdb raises it, would mean damaged bytes if Ctrl-C stopped in the
                decoder of a message, and the run would go on without a debugger.
        """
        super().set_quit()
        raise DebuggerLeft

    def set_continue(self) -> None:
        """Continues with tracing on, so that Ctrl-C can stop again."""
        self._set_stopinfo(self.botframe, None, -1)  # type: ignore[attr-defined]


def _debugpy(request: DebugRequest, serve: Callable[[], None]) -> int:
    debugpy = import_module("debugpy")
    debugpy.listen(("127.0.0.1", request.debugpy_port))
    where = f"127.0.0.1:{request.debugpy_port}"
    print(f"fwk: {request.component.name} (pid {os.getpid()}) waits for a debugger at {where}", flush=True)
    on_interrupt = signal.signal(signal.SIGINT, signal.SIG_DFL)  # no other event ends the wait
    debugpy.wait_for_client()
    signal.signal(signal.SIGINT, on_interrupt)
    serve()
    return 0


def first_line_of_loop(component: ComponentPlan) -> tuple[str, int]:
    """Returns file and number of the first line of a component's `loop()`."""
    loop = getattr(import_module(component.module), component.class_name).loop
    code = loop.__code__
    file = inspect.getsourcefile(loop) or code.co_filename
    lines: Sequence[int] = sorted({line for _, _, line in code.co_lines() if line and line > code.co_firstlineno})
    return file, lines[0] if lines else code.co_firstlineno
