"""External process that takes the place of a host in a run: preparation and life."""

import os
import signal
import socket
import sys
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from fwk.component.images import Ring
from fwk.component.port import DeclarationError
from fwk.engine.assignment import Assignment, Start
from fwk.engine.failures import ComponentFailedError
from fwk.host.debugger import DebugRequest, debug
from fwk.host.driver import HostDriver
from fwk.host.log_capture import forward_logging
from fwk.host.process import StopSignal, limit_memory, raise_file_limit
from fwk.model.plan import ComponentPlan, Plan
from fwk.model.ports import Ports

FAILED = 1
REFUSED = 2


class NoPlaceError(Exception):
    """The run refuses an external process; the text gives the reason."""


@dataclass(frozen=True)
class Place:
    """A host's place in a run; `ask` waits until it is free and returns the supervisor's answer."""

    plan: Plan
    component: ComponentPlan
    folder: str
    """Working directory of the run."""
    debug: DebugRequest | None
    """Debugger to run under; None: no debugger."""
    ask: Callable[[], Mapping[str, Any]]
    """Asks the supervisor for the place; raises `NoPlaceError`."""

    def take(self, stop: StopSignal) -> int:
        """Runs the host until the run stops it or the user leaves the debugger; returns an exit code.

        The modules are imported before the run is asked, so that errors in them do not disturb the run.
        """
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # until it has the place
        sys.stdout.reconfigure(line_buffering=True)  # type: ignore[union-attr]
        raise_file_limit()
        os.chdir(self.folder)
        try:
            self._import_modules()
            limit = self.plan.memory_limit_mb(self.component.host)
            if limit:
                limit_memory(limit)
            told = self.ask()
        except (NoPlaceError, DeclarationError) as reason:
            print(f"error: {reason}", file=sys.stderr)
            return REFUSED
        stop.on_interrupt(ends=self.debug is None or self.debug.debugpy_port > 0)
        port = Ports.of(self.plan).host(self.component.host)
        held = socket.socket(fileno=told["descriptors"][0])
        held.setblocking(False)
        driver = HostDriver(self._assignment(told), stop, held={port: held})
        forward_logging(driver.host.current_log)
        try:
            if self.debug:
                return debug(self.debug, driver.serve)
            driver.serve()
        except ComponentFailedError as failure:
            print(f"error: {failure}", file=sys.stderr)
            return FAILED
        return 0

    def _import_modules(self) -> None:
        for index in self.plan.hosts[self.component.host].components:
            module = self.plan.components[index].module
            try:
                import_module(module)
            except Exception as error:
                text = "".join(traceback.format_exception(error)).rstrip()
                raise NoPlaceError(f"{module} cannot be imported; the run keeps the old code\n{text}") from error

    def _assignment(self, told: Mapping[str, Any]) -> Assignment:
        return Assignment(
            self.plan,
            self.component.host,
            told["run"],
            Start(**told["start"]),
            {channel: Ring(os.open(path, os.O_RDWR)) for channel, path in told["rings"].items()},
        )
