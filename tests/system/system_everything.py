"""A system in which everything happens at once, and who makes it happen.

Orchestra and lift in one run, with a continuous planner, programs outside, and a driver that takes the main loop over
and starts another component anew.
"""

import contextlib
import os
import random
import re
import signal
import subprocess
from pathlib import Path
from typing import Any

import lcm

from fwk.control.address import gateway_address
from fwk.control.client import Client, ControlError
from fwk.messages import type_named
from lcmtypes.robot import motor_command_t
from tests.system.command_system import command_system
from tests.system.control_system import Steered
from tests.system.system_orchestra import GROUPS, PLAYERS, orchestra
from tests.system.system_runs import BIN, TIMEOUT_S, PortBlock, pause

PARTS = '''
"""Who takes the main loop over, who plans at its own pace, and who hears of it and of programs outside."""

import zlib

import numpy as np

from fwk import Clock, Component, Config, MainLoop, PluginControl, Reads, ReadsEach, Writes, channel
from fwk.clock import sleep_s
from lcmtypes.play import note_t
from lcmtypes.robot import imu_t, motor_command_t

ORDER = ["pre_loop", "sensor_acquire", "think", "sensor_prepare", "worldstate", "think", "act", "act", "post_loop"]


class Driver(Component):
    """Has the main loop for eight ticks of twenty-four."""

    stage = "think"
    clock: Clock
    main_loop: MainLoop
    plugins: PluginControl

    def loop(self) -> None:
        if self.clock.tick % 24 == 4:
            self.plugins.restart("d/player")
        if self.clock.tick % 24 == 8:
            self.main_loop.take_over(ORDER)
        if self.clock.tick % 24 == 16:
            self.main_loop.give_back()


class PlannerConfig(Config):
    takes_s: float = 0.01
    """How long a plan takes."""
    gain: float = 1.0
    """Goes into each plan."""


class Planner(Component):
    """Plans by all that it hears, as often as it can."""

    rate_hz = 0
    config: PlannerConfig
    rng: np.random.Generator
    notes: ReadsEach[note_t] = channel("*/note")
    plan: Writes[imu_t]

    def init(self) -> None:
        self.digest = 0

    def loop(self) -> None:
        for _, reader in self.notes.items():
            for note in reader.fresh:
                self.digest = zlib.crc32(note.encode(), self.digest)
        sleep_s(self.config.takes_s)
        self.plan.value.heading_rad = self.config.gain * self.digest + float(self.rng.random())
        self.plan.write()

    def finalize(self) -> None:
        self.plan.value.heading_rad = -self.config.gain
        self.plan.write()


class Follower(Component):
    """Adds up plans and wishes; says at the end how far it has come, and by which settings."""

    stage = ("sensor_process", "act")
    config: PlannerConfig
    plan: Reads[imu_t] = channel("z/plan")
    wish: Reads[motor_command_t] = channel("r/wish", history=3)
    way: Writes[imu_t]

    def loop(self) -> None:
        self.way.value.heading_rad += sum(each.heading_rad for each in self.plan.fresh)
        self.way.value.heading_rad += self.config.gain * sum(each.vx_m_s for each in self.wish.history)
        self.way.write()

    def finalize(self) -> None:
        self.way.value.heading_rad += self.config.gain
        self.way.write()
'''
LAUNCH = """
name: everything
include: [orchestra.yaml, lift.yaml]
components:
  z/driver: {use: "everything_parts:Driver"}
  z/planner: {use: "everything_parts:Planner", restart: {limit: 100, backoff_s: 0.01}}
  z/follower: {use: "everything_parts:Follower", restart: {limit: 100, backoff_s: 0.01}}
outside:
  r/wish: robot.motor_command_t
"""
WALL = """
clock: wall
period_s: 0.05
stage_time_s: 0.03
"""
FILE = "launch/everything.yaml"


def everything(public_url: str, *, real_time: bool, groups: bool = False) -> dict[str, str]:
    """The files of a user's folder."""
    files = orchestra(public_url, GROUPS if groups else "") | command_system(public_url)
    files |= {"everything_parts.py": PARTS, FILE: LAUNCH + (WALL if real_time else "")}
    for name in ("launch/orchestra.yaml", "launch/lift.yaml"):
        files[name] = re.sub(r'use: ("[\w.:]+")', r"use: \1, restart: {limit: 100, backoff_s: 0.01}", files[name])
        if real_time:  # the wall's clock instead of the conductor's, and no frames, which are not recorded
            no_source = r"  world/conductor: .*\n|, world/conductor|  a/viewer: .*\n|speed: max\n"
            files[name] = re.sub(no_source, "", files[name])
    return files


class Fate:
    """What people, other programs and fate do to a run, by chance."""

    def __init__(self, run: Steered, ports: PortBlock, luck: random.Random) -> None:
        self.done: list[str] = []
        self._run = run
        self._ports = ports
        self._luck = luck
        self._bus = lcm.LCM(ports.public_url)
        self._real_time = run.ask("run")["clock"] == "wall"

    def strike(self, what: str = "", name: str = "") -> None:
        """Lets one thing happen, to a component of that name, or both by chance."""
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


def replayed(folder: Path, *arguments: str, code: int = 0) -> str:
    """What `fwk replay log.lcm --verify` prints."""
    done = subprocess.run(
        [str(BIN / "fwk"), "replay", "log.lcm", "--verify", *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=2 * TIMEOUT_S,
        check=False,
    )
    assert done.returncode == code, f"{done.stdout}\n{done.stderr}"
    return done.stdout
