"""Starts the console beside a run: `fwk-launch --web`."""

import importlib.util
import os
import signal
import socket
import subprocess
import sys
from functools import partial
from pathlib import Path

import typer

from fwk.host.process import die_with_parent

PORT = 8460
"""TCP port of the console, unless another one is asked for."""
MISSING = "the console needs NiceGUI: pip install 'fwk[web]'"
_ADDRESS = "127.0.0.1"
_OUTPUT = "web.txt"


def can_serve() -> bool:
    """Tells whether the library of the console is installed."""
    return importlib.util.find_spec("nicegui") is not None


def beside(run: str, run_dir: Path) -> str:
    """Starts a console for a run and returns its link; it is a process of its own that ends with this one.

    It serves on the usual port, or on another one if that is taken, and prints into `web.txt` in the run directory.
    """
    port = _free_port()
    with open(run_dir / _OUTPUT, "wb") as output:
        subprocess.Popen(
            [sys.executable, "-m", "fwk.cli.main", "web", "--run", run, "--port", str(port)],
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=output,
            start_new_session=True,  # Ctrl-C is meant for the run
            preexec_fn=partial(die_with_parent, os.getpid(), signal.SIGTERM),
        )
    return f"http://{_ADDRESS}:{port}/"


def check_library() -> None:
    """Refuses `--web` without the library of the console.

    Raises:
        typer.BadParameter: it is not installed.
    """
    if not can_serve():
        raise typer.BadParameter(f"--web: {MISSING}")


def _free_port() -> int:
    for port in (PORT, 0):
        with socket.socket() as candidate:
            candidate.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            try:
                candidate.bind((_ADDRESS, port))
            except OSError:
                continue
            return int(candidate.getsockname()[1])
    return PORT
