"""Runs the real commands as a user does: in a folder and a home directory of the test, on free ports."""

import os
import subprocess
from pathlib import Path

from tests.harness import commands
from tests.harness.commands import BIN
from tests.harness.components import source, sources
from tests.harness.runs import PortBlock

TIMEOUT_S = 60.0  # generous for a busy machine; no command takes that long in normal operation

PROCS = {
    "procs/counter.py": source("card_counter.py"),
    **sources("lcmtypes/cards.lcm"),
    "launch/cards.yaml": (
        "components:\n"
        "  left/counter: { use: procs.counter }\n"
        "  right/counter: { use: procs.counter, restart: { when: never } }\n"
    ),
}
"""A user's folder: two components of one kind."""


def write_files(folder: Path, files: dict[str, str]) -> None:
    """Writes files below a folder."""
    for name, content in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(content)


def environment(home: Path) -> dict[str, str]:
    """An environment with these commands first on the path, and a home directory that the test may fill."""
    return {**os.environ, "HOME": str(home), "PATH": f"{BIN}{os.pathsep}{os.environ['PATH']}"}


def run(folder: Path, *command: str) -> subprocess.CompletedProcess[str]:
    """Runs a command to its end in a folder, which is also its home; both outputs together in `stdout`."""
    program = str(BIN / command[0]) if command[0] in ("fwk", "fwk-launch") else command[0]
    return commands.run([program, *command[1:]], folder, environment(folder), TIMEOUT_S, together=True)


def launch(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Runs `fwk-launch` on free ports."""
    with PortBlock() as ports:
        return run(folder, "fwk-launch", *arguments, "--bus-port", str(ports.bus))
