"""Puts a run into the background: `fwk-launch --detach`."""

import os
import signal
import sys
from pathlib import Path

from fwk.cli.output import say
from fwk.clock import sleep_s
from fwk.control.address import supervisor_address
from fwk.control.client import Client, ControlError

CONSOLE_FILE = "console.txt"
"""File in the run directory that gets what a run in the background prints."""
_LOOK_S = 0.05
_ASK_S = 1.0


def detach(run_dir: Path, bus_port: int, name: str) -> None:
    """Returns in a new process in the background; the calling process waits for the first tick, reports and exits.

    The exit code of the calling process is 0 once the run ticks, else that of the run.
    """
    sys.stdout.flush()
    child = os.fork()
    if child:
        os._exit(_report(child, run_dir, bus_port, name))
    os.setsid()
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    null = os.open(os.devnull, os.O_RDONLY)
    console = os.open(run_dir / CONSOLE_FILE, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o644)
    os.dup2(null, 0)
    os.dup2(console, 1)
    os.dup2(console, 2)


def _report(child: int, run_dir: Path, bus_port: int, name: str) -> int:
    try:
        while not _ticks(bus_port):
            pid, status = os.waitpid(child, os.WNOHANG)
            if pid:
                return _ended(os.waitstatus_to_exitcode(status), run_dir)
            sleep_s(_LOOK_S)
    except KeyboardInterrupt:
        os.kill(child, signal.SIGINT)
        return _ended(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), run_dir)
    say(
        f"{name}: runs in the background, pid {child}, --run {name}",
        f"fwk log -f --run {name}; fwk stop --all --run {name}",
        f"run directory: {run_dir}",
    )
    sys.stdout.flush()
    return 0


def _ticks(bus_port: int) -> bool:
    try:
        with Client(supervisor_address(bus_port), _ASK_S) as run:
            return bool(run.ask("status")["tick"] >= 1)
    except ControlError:
        return False


def _ended(code: int, run_dir: Path) -> int:
    """Prints the console output of a run that has already ended, and returns its exit code."""
    try:
        sys.stdout.write((run_dir / CONSOLE_FILE).read_text(errors="replace"))
        sys.stdout.flush()
    except OSError:
        pass
    return code if code >= 0 else 1
