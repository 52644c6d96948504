"""A small system in a real terminal, and `fwk` in another."""

import os
import sys
from pathlib import Path

import pexpect

from tests.harness.components import sources
from tests.harness.runs import PortBlock

FILES = {
    **sources("sensors.py"),
    "parts.yaml": """
name: parts
components:
  r/sensor: {use: "sensors:Sensor"}
  r/world_model: {use: "sensors:WorldModel"}
""",
}
LOOP_LINE = 1 + next(n for n, line in enumerate(FILES["sensors.py"].splitlines()) if "self.pose.value.heading" in line)
COMMAND = [sys.executable, "-m", "fwk.cli.launch", "parts.yaml", "--ticks", "40", "--speed", "max"]


class Terminal:
    """A command in a terminal, in a folder."""

    def __init__(self, folder: Path, *command: str) -> None:
        self._folder = folder
        env = {**os.environ, "HOME": str(folder)}
        self.child = pexpect.spawn(command[0], [*command[1:]], cwd=folder, env=env, timeout=60, encoding="utf-8")

    @classmethod
    def launch(cls, folder: Path, ports: PortBlock, *arguments: str) -> "Terminal":
        """Runs `fwk-launch parts.yaml`."""
        where = ["--bus-port", str(ports.bus), "--set", f"public_url={ports.public_url}"]
        return cls(folder, *COMMAND, *where, *arguments)

    @classmethod
    def debug(cls, folder: Path, ports: PortBlock, *arguments: str) -> "Terminal":
        """Runs `fwk debug ...` on that run."""
        return cls(folder, sys.executable, "-m", "fwk.cli.main", "debug", *arguments, "--bus-port", str(ports.bus))

    def kill(self) -> None:
        self.child.close(force=True)

    def type(self, line: str) -> None:
        self.child.sendline(line)

    def ask(self, line: str) -> str:
        """Types a line at the prompt; returns the output before the next prompt."""
        self.type(line)
        return self.prompt()

    def prompt(self) -> str:
        self.child.expect(r"\(Pdb\) ")
        return str(self.child.before)

    def end(self) -> int:
        self.child.expect(pexpect.EOF)
        self.child.close()
        return int(self.child.exitstatus)

    @property
    def turns(self) -> int:
        """Returns the ticks in which the sensor has run."""
        file = self._folder / "turns.txt"
        return int(file.read_text()) if file.exists() else 0
