"""A host that somebody starts by hand for a run that goes on: what it needs of the run, and its life."""

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
from fwk.host.memory import limit_memory
from fwk.host.plain_logging import forward_logging
from fwk.host.process import StopSignal, raise_file_limit
from fwk.model.plan import ComponentPlan, Plan
from fwk.model.ports import Ports

FAILED = 1
REFUSED = 2


class NoPlace(Exception):  # noqa: N818 - what is
    """The run does not give the place; says why."""


@dataclass(frozen=True)
class Place:
    """A component's place in a run: `ask` waits until it is free and returns what the supervisor says then."""

    plan: Plan
    component: ComponentPlan
    folder: str
    """The run's working directory."""
    debug: DebugRequest | None
    """Under which debugger; None: under none."""
    ask: Callable[[], Mapping[str, Any]]
    """Raises `NoPlace`."""

    def take(self, stop: StopSignal) -> int:
        """Has the place until the run says stop or the debugger is left; returns an exit code.

        The modules are imported before the run is asked: what is wrong with them comes out while it goes on.
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
        except (NoPlace, DeclarationError) as reason:
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
                raise NoPlace(f"{module} cannot be imported; the run goes on with what it has\n{text}") from error

    def _assignment(self, told: Mapping[str, Any]) -> Assignment:
        return Assignment(
            self.plan,
            self.component.host,
            told["run"],
            Start(**told["start"]),
            {channel: Ring(os.open(path, os.O_RDWR)) for channel, path in told["rings"].items()},
        )
