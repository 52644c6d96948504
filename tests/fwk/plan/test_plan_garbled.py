"""Any launch file ends the check with a plan or with mistakes, never with a traceback."""

import random
from collections.abc import Callable
from contextlib import suppress

import pytest

from fwk.model.errors import PlanError
from fwk.model.plan import Plan

GOOD = """
period_s: 0.1
stages: [sensor_acquire, act, act_exec, think]
templates:
  bot:
    wheels: {use: plan_parts:Wheels, config: {label: "{team}", limits: {turns: [0, 1]}}}
    pilot: {use: plan_parts:Pilot, needs: [wheels], restart: {when: never}}
robots:
  cyan1: {use: [bot], values: {team: cyan}, config: {wheels: {gain: 0.1}}}
components:
  world/reader: {use: plan_parts:Reader, channels: {odometry: cyan1/odometry}, stage: think}
outside: {b/odometry: robot.odometry_t}
hosts: {pair: ["cyan1/*"]}
config: {"*/wheels": {mode: hard}}
"""
PIECES = [
    "[",
    "]",
    "{",
    "}",
    ":",
    " ",
    "\n",
    "null",
    "1",
    "-",
    "{x}",
    "*",
    "&a ",
    "*a ",
    "!!int ",
    "'",
    "/",
    ".nan",
    "#",
]


def garbled(text: str, dice: random.Random) -> str:
    for _ in range(dice.randint(1, 3)):
        at = dice.randrange(len(text))
        kind = dice.randrange(3)
        if kind == 0:
            text = text[:at] + dice.choice(PIECES) + text[at:]
        elif kind == 1:
            text = text[:at] + text[at + dice.randint(1, 6) :]
        else:
            lines = text.split("\n")
            first, second = dice.randrange(len(lines)), dice.randrange(len(lines))
            lines[first], lines[second] = lines[second], lines[first]
            text = "\n".join(lines)
    return text


def test_the_files_are_right_before_they_are_garbled(load: Callable[..., Plan]) -> None:
    assert len(load(GOOD).components) == 3


@pytest.mark.parametrize("seed", range(5))
def test_garbled_files(load: Callable[..., Plan], seed: int) -> None:
    dice = random.Random(seed)
    for _ in range(40):
        with suppress(PlanError):
            load(garbled(GOOD, dice))
