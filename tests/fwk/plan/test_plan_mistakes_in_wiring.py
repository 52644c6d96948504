"""Mistakes in channels, processes, parts of a plan, user types, and missing files."""

from pathlib import Path

import pytest

from fwk.model.errors import PlanError
from fwk.plan.load import LaunchOptions, load_plan
from tests.fwk.plan.plan_mistakes import Broken, expected, rows, said

LONG = "x" * 60


@rows(
    Broken(
        "it.yaml:4: a/two: two writers of 'a/odometry': a/one and a/two; keep one",
        """
        components:
          a/one: {use: plan_parts:Odometer}
          b/reader: {use: plan_parts:Reader, channels: {odometry: a/odometry}}
          a/two: {use: plan_parts:Odometer}
        """,
    ),
    Broken(
        "it.yaml:3: feeder: two writers of 'a/odometry': a/one and feeder; keep one",
        """
        components:
          a/one: {use: plan_parts:Odometer}
          feeder: {use: plan_parts:Feeder}
          a/reader: {use: plan_parts:Reader}
        """,
    ),
    Broken(
        "it.yaml:3: a/one: two writers of 'a/odometry': programs outside and a/one; keep one",
        """
        outside: {a/odometry: robot.odometry_t}
        components:
          a/one: {use: plan_parts:Odometer}
        """,
    ),
    Broken(
        "it.yaml:3: a/reader: no component writes 'a/odometri', which a/reader reads as 'odometry'; "
        "did you mean 'a/odometry'?",
        """
        components:
          a/one: {use: plan_parts:Odometer}
          a/reader: {use: plan_parts:Reader, channels: {odometry: odometri}}
        """,
    ),
    Broken(
        "it.yaml:2: a/reader: no component writes 'a/odometry', which a/reader reads as 'odometry'; "
        "it/feeder writes 'b*/odometry', which matches no channel",
        """
        components:
          a/reader: {use: plan_parts:Reader}
          it/feeder: {use: strange:Feeder, channels: {odometries: "b*/odometry"}}
        --- strange.py
        from fwk import Component, Each, Writes
        from lcmtypes.robot import odometry_t
        class Feeder(Component):
            stage = "think"
            odometries: Each[Writes[odometry_t]]
        """,
    ),
    Broken(
        "it.yaml:4: a/reader (and 1 more): no component writes 'a/odometry', which a/reader reads as 'odometry'; "
        "add a component that writes it, or name another channel",
        """
        robots: {a: {use: bot}, b: {use: bot}}
        templates:
          bot:
            reader: {use: plan_parts:Reader}
        """,
    ),
    Broken(
        "it.yaml:3: a/mistaken: 'a/odometry' is written by a/one as robot.odometry_t and read by a/mistaken as "
        "robot.motor_command_t; use one type",
        """
        components:
          a/one: {use: plan_parts:Odometer}
          a/mistaken: {use: plan_parts:Mistaken}
        """,
    ),
    Broken(
        "it.yaml:3: a/eye: 'a/image' is not a camera: a/announcer is not its vision master; "
        "read a channel that is an Image",
        """
        components:
          a/announcer: {use: plan_parts:Announcer}
          a/eye: {use: plan_parts:Eye}
        """,
    ),
    Broken(
        "it.yaml:2: a/reader: no port 'odometri'; did you mean 'odometry'?",
        """
        components:
          a/reader: {use: plan_parts:Reader, channels: {odometri: a/x}}
          a/one: {use: plan_parts:Odometer}
        """,
    ),
    Broken(
        f"""
        it.yaml:2: a/one: port 'odometry': 'a/{LONG}xx' has 64 bytes, LCM carries 63; shorten it
        it.yaml:3: b/one: port 'odometry': 'b/o.d' is not a valid name; use letters, digits, '_', '-' and '/', such as cyan1/ball
        it.yaml:4: c/one: port 'odometry': 'fwk/odometry': names that begin with 'fwk/' are the framework's own; take another namespace
        it.yaml:5: watcher: port 'odometries': 'cyan*' is not a valid pattern; put '*' for the namespace and a name after the last '/', such as */ball
        """,  # noqa: E501 - as users see it
        f"""
        components:
          a/one: {{use: plan_parts:Odometer, channels: {{odometry: {LONG}xx}}}}
          b/one: {{use: plan_parts:Odometer, channels: {{odometry: o.d}}}}
          c/one: {{use: plan_parts:Odometer, channels: {{odometry: fwk/odometry}}}}
          watcher: {{use: plan_parts:Watcher, channels: {{odometries: cyan*}}}}
        """,
    ),
    Broken(
        """
        it.yaml:2: a/b: no LCM type 'robot.odometri_t' in lcmtypes/; did you mean 'robot.odometry_t'?
        it.yaml:3: a/c: core.answer_t belongs to the framework and does not begin with 'core.header_t header;'
        it.yaml:4: 'a d' is not a valid name; use letters, digits, '_', '-' and '/', such as cyan1/ball
        """,
        """
        outside:
          a/b: robot.odometri_t
          a/c: core.answer_t
          a d: robot.odometry_t
        components: {a/one: {use: plan_parts:Odometer}}
        """,
    ),
)
def test_channels(folder: Path, broken: Broken) -> None:
    assert said(broken, folder) == expected(broken)


@rows(
    Broken(
        """
        it.yaml:3: 'b' matches no component; there are a, a/one, a/watcher
        it.yaml:4: 'a/watcher' is a component; give the process of several another name
        it.yaml:5: a/one: it is in two processes, 'left' and 'right'; keep one
        """,
        """
        hosts:
          left: ["*/one"]
          odd: b
          a/watcher: [a/watcher]
          right: a/one
        components: {a/one: {use: plan_parts:Odometer}, a/watcher: {use: plan_parts:Watcher}}
        """,
    ),
    Broken(
        "--only: 'a/oen' matches no component; did you mean 'a/one'?",
        "components: {a/one: {use: plan_parts:Odometer}}",
        {"only": ["a", "a/oen"]},
    ),
    Broken(
        "--without: 'bb' matches no component; there are a, a/one",
        "components: {a/one: {use: plan_parts:Odometer}}",
        {"without": ["bb"]},
    ),
    Broken(
        "--without: no component is left; leave a pattern out",
        "components: {a/one: {use: plan_parts:Odometer}}",
        {"without": ["*"]},
    ),
    Broken(
        "--bus-port: the run would need the ports 65530 to 65567; use --bus-port 65498 or less",
        "components: {a/one: {use: plan_parts:Odometer}}",
        {"bus_port": 65530},
    ),
    Broken(
        "public_url: port 20010 is one of the run's own ports 20000 to 20037; use one outside of them",
        "{public_url: 'udpm://239.255.76.67:20010?ttl=0', components: {a/one: {use: plan_parts:Odometer}}}",
        {"bus_port": 20000},
    ),
)
def test_processes_and_parts(folder: Path, broken: Broken) -> None:
    assert said(broken, folder) == expected(broken)


def test_a_missing_file(folder: Path) -> None:
    (folder / "launch").mkdir()
    (folder / "launch" / "garden.yaml").write_text("")
    (folder / "launch" / "garden.host.yaml").write_text("")
    with pytest.raises(
        PlanError, match=r"^gardn.yaml: no such launch file; did you mean 'garden.yaml'\? there are garden.yaml, "
    ):
        load_plan("gardn.yaml", LaunchOptions())
    with pytest.raises(PlanError, match=r"^launch: no such launch file; there are garden.yaml"):
        load_plan("launch", LaunchOptions())


def test_a_file_that_cannot_be_read(folder: Path) -> None:
    (folder / "it.yaml").write_bytes(b"name: x\n# \xff")
    with pytest.raises(PlanError, match=r"^it.yaml:2: this is not UTF-8 text$"):
        load_plan("it.yaml", LaunchOptions())


def test_all_mistakes_are_reported_at_once_in_file_order(folder: Path) -> None:
    (folder / "it.yaml").write_text(
        "nam: x\n"
        "include: none.yaml\n"
        "stages: [sensor_acquire, act_exec, act, think, act]\n"
        "components:\n"
        "  a/one: {use: plan_parts:Odometer}\n"
        "  a/two: {use: plan_parts:Odometer}\n"
        "  a/wheels: {use: plan_parts:Wheels, config: {gian: 1}, channels: {odometry: mine}}\n"
        "  a/gone: {use: nowhere}\n"
        "  a/needy: {use: plan_parts:Reader, needs: a/needy}\n"
    )
    with pytest.raises(PlanError) as caught:
        load_plan("it.yaml", LaunchOptions(only=["nobody"]))
    places = [(problem.place, problem.who) for problem in caught.value.problems]
    assert places == [
        ("it.yaml:1", ""),
        ("it.yaml:2", ""),
        ("it.yaml:3", ""),
        ("it.yaml:6", "a/two"),
        ("it.yaml:7", "a/wheels"),
        ("it.yaml:8", "a/gone"),
        ("it.yaml:9", "a/needy"),
        ("--only", ""),
    ]
