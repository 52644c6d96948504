"""A small system in a real terminal, and `fwk` in another."""

import os
import signal
import subprocess
import termios
from pathlib import Path

import pexpect
from pexpect.fdpexpect import fdspawn

from tests.harness import commands
from tests.harness.commands import BIN
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
LAUNCH = ("fwk-launch", "parts.yaml", "--ticks", "40", "--speed", "max")
_LINES_COLUMNS = (24, 80)
_END_S = 1.0


class Child(fdspawn):  # type: ignore[misc]
    """A forked command in a terminal of its own, used like `pexpect.spawn`."""

    def __init__(self, folder: Path, command: list[str]) -> None:
        ours, theirs = os.openpty()
        termios.tcsetwinsize(theirs, _LINES_COLUMNS)
        environment = {**os.environ, "HOME": str(folder)}
        self._process = commands.start(command, folder, environment, theirs, theirs, terminal=theirs)
        os.close(theirs)
        super().__init__(ours, timeout=60, encoding="utf-8")
        self.pid = self._process.pid

    def sendintr(self) -> None:
        """Types Ctrl-C."""
        self.send("\x03")

    def sendeof(self) -> None:
        """Types Ctrl-D."""
        self.send("\x04")

    def wait(self) -> int:
        """Waits for the end of the command; returns its exit code."""
        return self._process.wait(self.timeout)

    def close(self) -> None:
        """Closes the terminal, which ends the command; kills the command if it goes on."""
        super().close()
        try:
            self._process.wait(_END_S)
        except subprocess.TimeoutExpired:
            self._process.send_signal(signal.SIGKILL)
            self._process.wait()


class Terminal:
    """`fwk` or `fwk-launch` in a terminal, in a folder."""

    def __init__(self, folder: Path, program: str, *words: str) -> None:
        self._folder = folder
        self.child = Child(folder, [str(BIN / program), *words])

    @classmethod
    def launch(cls, folder: Path, ports: PortBlock, *arguments: str) -> "Terminal":
        """Runs `fwk-launch parts.yaml`."""
        where = ["--bus-port", str(ports.bus), "--set", f"public_url={ports.public_url}"]
        return cls(folder, *LAUNCH, *where, *arguments)

    @classmethod
    def debug(cls, folder: Path, ports: PortBlock, *arguments: str) -> "Terminal":
        """Runs `fwk debug ...` on that run."""
        return cls(folder, "fwk", "debug", *arguments, "--bus-port", str(ports.bus))

    def kill(self) -> None:
        self.child.close()

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
        return self.child.wait()

    @property
    def turns(self) -> int:
        """Returns the ticks in which the sensor has run."""
        file = self._folder / "turns.txt"
        return int(file.read_text()) if file.exists() else 0
