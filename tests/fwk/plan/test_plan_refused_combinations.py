"""Combinations of components that are refused, all in one launch file and all reported at once by `fwk check`."""

from pathlib import Path

import typer
from typer.testing import CliRunner

from fwk.cli.check.check import check

ROWS = [
    (
        "a/eye: {use: plan_parts:Eye}",
        "a/eye: 'a/image' has no vision master, and a/eye looks at it as 'image'; did you mean 'b/image'?",
    ),
    ("b/camera: {use: plan_parts:Camera}", ""),
    (
        "b/other: {use: plan_parts:Camera}",
        "b/other: two writers of 'b/image': b/camera and b/other; keep one",
    ),
    ("c/announcer: {use: plan_parts:Announcer}", ""),
    (
        "c/eye: {use: plan_parts:Eye}",
        "c/eye: 'c/image' is not a camera: c/announcer is not its vision master; read a channel that is an Image",
    ),
    ("d/one: {use: plan_parts:Odometer}", ""),
    ("d/two: {use: plan_parts:Odometer}", "d/two: two writers of 'd/odometry': d/one and d/two; keep one"),
    (
        "d/mistaken: {use: plan_parts:Mistaken}",
        "d/mistaken: 'd/odometry' is written by d/one as robot.odometry_t and read by d/mistaken as "
        "robot.motor_command_t; use one type",
    ),
    (
        "e/reader: {use: plan_parts:Reader}",
        "e/reader: no component writes 'e/odometry', which e/reader reads as 'odometry'; did you mean 'h/odometry'?",
    ),
    (
        "f/guide: {use: plan_parts:Guide}",
        "f/guide: 2 components provide Way, which f/guide asks for as 'way': g/farer and h/farer; keep one, or set "
        "'providers: {way: g/farer}'",
    ),
    ("g/farer: {use: plan_parts:Wayfarer}", ""),
    ("h/farer: {use: plan_parts:Wayfarer}", ""),
    (
        "i/follower: {use: combined:Follower}",
        "i/follower: no component provides Alone, which i/follower asks for as 'alone'; add a component whose class "
        "has 'provides = Alone'",
    ),
    ("j/sun: {use: plan_parts:Sun}", ""),
    ("k/sun: {use: plan_parts:Sun}", "k/sun: two time sources: j/sun (it.yaml:{j/sun}) and k/sun; keep one"),
    (
        "l/mute: {use: combined:Mute}",
        "l/mute: combined.Mute: it provides Way, which reads its channel 'odometry'; add odometry: Writes[odometry_t]",
    ),
    (
        "m/one: {use: plan_parts:Watcher, needs: two}",
        "m/one: components need each other in a cycle: m/one -> m/two -> m/one; leave one 'needs' out",
    ),
    ("m/two: {use: plan_parts:Watcher, needs: one}", ""),
    (
        "n/user: {use: plan_parts:Watcher, needs: later}",
        "n/user: it starts with the run and needs 'n/later', which does not; "
        "set 'start: false' here too, or remove it there",
    ),
    ("n/later: {use: plan_parts:Watcher, start: false}", ""),
    (
        "n/needy: {use: plan_parts:Watcher, needs: ltaer}",
        "n/needy: it needs 'n/ltaer', which does not exist; did you mean 'n/later'?",
    ),
    ("o/one: {use: plan_parts:Watcher}", ""),
    ("o/two: {use: plan_parts:Watcher, start: false}", ""),
]
"""A component, and the message about it with the line number left open."""
MODULE = """
from fwk import Aspect, Component
from plan_parts import Way
class Alone(Aspect): ...
class Follower(Component):
    stage = "think"
    alone: Alone
class Mute(Component):
    stage = "think"
    provides = Way
"""


def test_every_combination_is_reported_with_both_sides(folder: Path) -> None:
    (folder / "combined.py").write_text(MODULE)
    lines = ["hosts:", "  both: o/*", "components:", *(f"  {component}" for component, _ in ROWS)]
    (folder / "it.yaml").write_text("\n".join(lines))
    number = {component.partition(":")[0]: place for place, (component, _) in enumerate(ROWS, 4)}
    expected = [
        "it.yaml:2: o/one and o/two share a process and only one starts with the run; set 'start' alike for both"
    ]
    for component, text in ROWS:
        if text:
            place = number[component.partition(":")[0]]
            expected.append(f"it.yaml:{place}: {text.replace('{j/sun}', str(number['j/sun']))}")
    app = typer.Typer()
    app.command()(check)
    result = CliRunner().invoke(app, ["it.yaml"])
    *told, count = result.stderr.splitlines()
    assert result.exit_code == 2
    assert told == expected
    assert count == f"{len(expected)} mistakes"
