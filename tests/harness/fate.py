"""Random actions of people, other programs and the machine on a run."""

import contextlib
import os
import random
import signal
from typing import Any

import lcm

from fwk.control.address import gateway_address
from fwk.control.client import Client, ControlError
from fwk.lcm.messages import type_named
from lcmtypes.robot import motor_command_t
from tests.harness.runs import TIMEOUT_S, PortBlock, pause
from tests.programs.control_system import Steered
from tests.programs.orchestra import PLAYERS


class Fate:
    """Performs random actions on a run."""

    def __init__(self, run: Steered, ports: PortBlock, luck: random.Random) -> None:
        self.done: list[str] = []
        self._run = run
        self._ports = ports
        self._luck = luck
        self._bus = lcm.LCM(ports.public_url)
        self._real_time = run.ask("run")["clock"] == "wall"

    def strike(self, what: str = "", name: str = "") -> None:
        """Performs one action on a component, both given or drawn at random."""
        kinds = ("kill", "kill", "stop and start", "restart", "set", "set", "still", "call", "wish")
        what = what or self._luck.choice(kinds)
        components = self._run.ask("status")["components"]
        one = next((each for each in components if each["name"] == name), None) or self._luck.choice(components)
        self.done.append(f"tick {self._run.tick}: {what} {one['name']}")
        getattr(self, "_" + what.replace(" ", "_"))(one, [each for each in components if each["pid"]])

    def _kill(self, one: dict[str, Any], _: list[dict[str, Any]]) -> None:
        with contextlib.suppress(ProcessLookupError):
            if one["pid"]:
                os.kill(one["pid"], signal.SIGKILL)

    def _stop_and_start(self, one: dict[str, Any], running: list[dict[str, Any]]) -> None:
        names = [each["name"] for each in running if each["process"] == one["process"]] or [one["name"]]
        self._run.steer("stop", *names)
        self._run.ticks_pass(self._luck.randrange(1, 4))
        self._run.steer("start", *names)

    def _restart(self, one: dict[str, Any], running: list[dict[str, Any]]) -> None:
        names = [each["name"] for each in running if each["process"] == one["process"]] or [one["name"]]
        self._run.steer("restart", *names)

    def _set(self, one: dict[str, Any], _: list[dict[str, Any]]) -> None:
        if one["name"] in ("z/planner", "z/follower"):
            changes = [f"{one['name']}.gain={self._luck.randrange(1, 9)}"]
        else:
            player = one["name"] if one["name"].endswith("/player") else f"{self._luck.choice(PLAYERS)}/player"
            changes = [f"{player}.bursts={self._luck.randrange(6)}", f"{player}.ballast={self._luck.randrange(100)}"]
        self._run.ask("set", changes=changes)

    def _still(self, one: dict[str, Any], _: list[dict[str, Any]]) -> None:
        with contextlib.suppress(ProcessLookupError):
            if one["pid"]:
                os.kill(one["pid"], signal.SIGSTOP)
                if self._real_time:
                    self._run.ticks_pass(self._luck.choice((1, 2, 3, 20)))
                os.kill(one["pid"], signal.SIGCONT)

    def _call(self, *_: object) -> None:
        made: Any = type_named("lift.lift_t")()
        made.height_m = self._luck.uniform(-1.0, 5.0)
        with Client(gateway_address(self._ports.bus), TIMEOUT_S) as client, contextlib.suppress(ControlError):
            next(client.follow("call", TIMEOUT_S, name="r/lift", data=made.encode().hex(), expires_s=100.0), None)

    def _wish(self, *_: object) -> None:
        for _number in range(self._luck.randrange(1, 4)):
            wish = motor_command_t()
            wish.vx_m_s = self._luck.uniform(-2.0, 2.0)
            self._bus.publish("r/wish", wish.encode())
        pause(0.01)
