"""A small system to inspect and control: a counter, its follower, and a camera with its user."""

import json
import signal
from pathlib import Path
from typing import Any

from fwk.control.address import supervisor_address
from fwk.control.client import Client, ControlError
from tests.harness.components import sources
from tests.harness.runs import TIMEOUT_S, Launched, PortBlock, fwk, write_files

LAUNCH = """
name: small
public_url: {url}
components:
  r/counter: {{use: "small:Counter", restart: {{limit: 1}}}}
  r/follower: {{use: "small:Follower"}}
  r/camera: {{use: "small:Camera"}}
  r/finder: {{use: "small:Finder"}}
"""


def write_system(folder: Path, ports: PortBlock) -> None:
    """Writes the files of the system."""
    write_files(folder, {**sources("small.py"), "small.yaml": LAUNCH.format(url=ports.public_url)})


class Steered:
    """A run of the system, and commands in another terminal."""

    def __init__(self, launched: Launched, ports: PortBlock) -> None:
        self.launched = launched
        self._ports = ports
        launched.until_true(self._ticks, "the first tick")

    def fwk(self, *arguments: str, code: int = 0) -> str:
        """Returns the output of `fwk ARGUMENTS` about this run; the command has to end with that exit code."""
        which = [] if "--verify" in arguments else ["--bus-port", str(self._ports.bus)]
        return fwk(self.launched.folder, *arguments, *which, code=code)

    def json(self, *arguments: str) -> Any:
        """Returns the output of `fwk ARGUMENTS --json`, decoded."""
        return json.loads(self.fwk(*arguments, "--json"))

    def ask(self, verb: str, **fields: Any) -> dict[str, Any]:
        """Returns an answer of the supervisor."""
        with Client(supervisor_address(self._ports.bus), TIMEOUT_S) as client:
            return client.ask(verb, **fields)

    def steer(self, action: str, *names: str) -> None:
        """Acts like `fwk ACTION NAMES`, without a process for it."""
        self.ask("steer", action=action, names=names)

    def component(self, name: str) -> dict[str, Any]:
        """Returns the state of a component."""
        found: dict[str, Any] = self.ask("status", names=[name])["components"][0]
        return found

    @property
    def tick(self) -> int:
        """Returns the newest tick."""
        return int(self.ask("status")["tick"])

    def ticks_pass(self, number: int = 3) -> None:
        """Waits for that number of ticks."""
        before = self.tick
        self.launched.until_true(lambda: self.tick >= before + number, f"{number} more ticks")

    def end(self) -> Path:
        """Ends the run regularly; returns its recording."""
        self.launched.signal(signal.SIGINT)
        assert self.launched.wait() == 0, self.launched.text
        return self.launched.run_dir / "log.lcm"

    def _ticks(self) -> bool:
        try:
            return self.tick > 1
        except ControlError:  # it does not listen yet
            return False
