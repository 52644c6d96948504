"""Puts a run into the background: `fwk-launch --detach`."""

import os
import signal
import sys
from pathlib import Path
from typing import Any

from fwk.clock import US_PER_S, monotonic_us, sleep_s
from fwk.control.address import supervisor_address
from fwk.control.client import Client, ControlError
from fwk.model.signals import ignore

CONSOLE_FILE = "console.txt"
"""File in the run directory that gets what a run in the background prints."""
_LOOK_S = 0.05
_ASK_S = 1.0
_TELL_US = US_PER_S


def detach(run_dir: Path, bus_port: int, name: str) -> None:
    """Returns in a new process in the background; the calling process waits for the first tick, reports and exits.

    While it waits longer than a second, it names the components that the start waits for. Its exit code is 0 once the
    run ticks, also if its report cannot be written; else that of the run.
    """
    sys.stdout.flush()
    child = os.fork()
    if child:
        os._exit(_report(child, run_dir, bus_port, name))
    os.setsid()
    ignore(signal.SIGHUP)
    null = os.open(os.devnull, os.O_RDONLY)
    console = os.open(run_dir / CONSOLE_FILE, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)
    os.dup2(null, 0)
    os.dup2(console, 1)
    os.dup2(console, 2)


def _report(child: int, run_dir: Path, bus_port: int, name: str) -> int:
    began_us, told_us = monotonic_us(), _TELL_US
    try:
        while not (status := _status(bus_port)).get("tick"):
            pid, code = os.waitpid(child, os.WNOHANG)
            if pid:
                return _ended(os.waitstatus_to_exitcode(code), run_dir)
            waited_us = monotonic_us() - began_us
            if waited_us >= told_us and status.get("waits_for"):
                told_us = 2 * waited_us
                waits_for = ", ".join(status["waits_for"])
                _tell(2, f"{name}: the start has waited {waited_us / US_PER_S:.0f} s for {waits_for}")
            sleep_s(_LOOK_S)
    except KeyboardInterrupt:
        os.kill(child, signal.SIGINT)
        return _ended(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), run_dir)
    report = (
        f"{name}: runs in the background, pid {child}, --run {name}",
        f"fwk log -f --run {name}; fwk stop --all --run {name}",
        f"run directory: {run_dir}",
    )
    if not _tell(1, *report):
        _tell(2, "error: standard output cannot be written; the run goes on", *report)
    return 0


def _tell(descriptor: int, *lines: str) -> bool:
    """Writes lines to a standard stream; returns whether they could be written. A run does not end for want of one."""
    try:
        os.write(descriptor, "".join(f"{line}\n" for line in lines).encode(errors="surrogateescape"))
    except OSError:
        return False
    return True


def _status(bus_port: int) -> dict[str, Any]:
    """Returns the status of the run; empty while it does not answer."""
    try:
        with Client(supervisor_address(bus_port), _ASK_S) as run:
            return run.ask("status")
    except ControlError:
        return {}


def _ended(code: int, run_dir: Path) -> int:
    """Prints the console output of a run that has already ended, and returns its exit code."""
    try:
        sys.stdout.write((run_dir / CONSOLE_FILE).read_text(errors="replace"))
        sys.stdout.flush()
    except OSError:
        pass
    return code if code >= 0 else 1
