"""Mistakes in commands and requests: no owner, two owners, or the wrong owner."""

from collections.abc import Callable
from pathlib import Path
from textwrap import dedent

from fwk.model.plan import Plan
from tests.fwk.plan.plan_mistakes import Broken, expected, rows, said, write

PARTS = """
--- lcmtypes/garden.lcm
package garden;
struct dig_t { core.header_t header; core.command_t command; double depth_m; }
struct sow_t { core.header_t header; core.command_t command; string seed; }
struct seen_t { core.header_t header; core.answer_t answer; double height_m; }
--- garden_parts.py
from fwk import Calls, Component, Each, Serves
from lcmtypes.core import acknowledgement_t
from lcmtypes.garden import dig_t, seen_t, sow_t
from lcmtypes.robot import odometry_t
from lcmtypes.soccer import obstacle_t

class Digger(Component):
    stage = "act"
    dig: Serves[dig_t]

class Boss(Component):
    stage = "think"
    dig: Calls[dig_t]

class Sower(Component):
    stage = "think"
    dig: Calls[sow_t]

class Bosses(Component):
    stage = "think"
    digs: Each[Calls[dig_t]]

class Diggers(Component):
    stage = "act"
    digs: Each[Serves[dig_t]]

class Twice(Component):
    stage = "think"
    dig: Calls[dig_t]
    digs: Each[Calls[dig_t]]

class Asker(Component):
    stage = "think"
    dig: Calls[dig_t, seen_t]

class Plain(Component):
    stage = "think"
    dig: Calls[odometry_t]

class Device(Component):
    stage = "think"
    dig: Calls[obstacle_t]

class Devices(Component):
    stage = "think"
    dig: Serves[dig_t, obstacle_t]

class Replyless(Component):
    stage = "think"
    dig: Serves[dig_t, dig_t]
"""
LONG = "x" * 30


def garden(broken: Broken) -> Broken:
    """A row with the types and components that all rows use."""
    return broken._replace(text=dedent(broken.text).strip("\n") + "\n" + PARTS.strip("\n"))


@rows(
    Broken(
        "it.yaml:2: a/boss: no component carries out 'a/dig', which a/boss sends as 'dig'; "
        "add a component that does, or name other commands",
        """
        components:
          a/boss: {use: garden_parts:Boss}
        """,
    ),
    Broken(
        "it.yaml:3: a/boss: no component carries out 'a/digg', which a/boss sends as 'dig'; did you mean 'a/dig'?",
        """
        components:
          a/digger: {use: garden_parts:Digger}
          a/boss: {use: garden_parts:Boss, channels: {dig: digg}}
        """,
    ),
    Broken(
        "it.yaml:4: w/diggers: two components carry out 'a/dig': a/digger and w/diggers; keep one",
        """
        components:
          a/digger: {use: garden_parts:Digger}
          a/boss: {use: garden_parts:Boss}
          w/diggers: {use: garden_parts:Diggers, channels: {digs: "*/dig"}}
        """,
    ),
    Broken(
        "it.yaml:3: b/digger: two components carry out 'a/dig': a/digger and b/digger; keep one",
        """
        components:
          a/digger: {use: garden_parts:Digger}
          b/digger: {use: garden_parts:Digger, channels: {dig: a/dig}}
        """,
    ),
    Broken(
        "it.yaml:3: a/sower: 'a/dig' is garden.dig_t for a/digger, which carries it out, "
        "and garden.sow_t for a/sower, which sends it; use one type",
        """
        components:
          a/digger: {use: garden_parts:Digger}
          a/sower: {use: garden_parts:Sower}
        """,
    ),
    Broken(
        "it.yaml:3: a/asker: the reply to 'a/dig' is core.acknowledgement_t for a/digger, which carries it out, "
        "and garden.seen_t for a/asker, which sends it; use one type",
        """
        components:
          a/digger: {use: garden_parts:Digger}
          a/asker: {use: garden_parts:Asker}
        """,
    ),
    Broken(
        "it.yaml:3: a/twice: a/twice sends 'a/dig' by two ports, one of them 'digs'; keep one",
        """
        components:
          a/digger: {use: garden_parts:Digger}
          a/twice: {use: garden_parts:Twice, channels: {digs: "*/dig"}}
        """,
    ),
    Broken(
        "it.yaml:2: a/plain: garden_parts.Plain.dig: robot.odometry_t is not a request: "
        "its second member is not 'core.command_t command;'",
        """
        components:
          a/plain: {use: garden_parts:Plain}
        """,
    ),
    Broken(
        "it.yaml:2: a/device: garden_parts.Device.dig: soccer.obstacle_t is not a request: it does not begin with "
        "'core.header_t header;'; types of devices go with Reads, Writes and Each of them",
        """
        components:
          a/device: {use: garden_parts:Device}
        """,
    ),
    Broken(
        "it.yaml:2: a/device: garden_parts.Devices.dig: soccer.obstacle_t is not a reply: it does not begin with "
        "'core.header_t header;'; types of devices go with Reads, Writes and Each of them",
        """
        components:
          a/device: {use: garden_parts:Devices}
        """,
    ),
    Broken(
        "it.yaml:2: a/x: garden_parts.Replyless.dig: garden.dig_t is not a reply: "
        "its second member is not 'core.answer_t answer;'",
        """
        components:
          a/x: {use: garden_parts:Replyless}
        """,
    ),
    Broken(
        f"it.yaml:3: {LONG}/boss: '{LONG}/dig@{LONG}/boss' would have 70 bytes, LCM carries 63; shorten a name",
        f"""
        components:
          {LONG}/digger: {{use: garden_parts:Digger}}
          {LONG}/boss: {{use: garden_parts:Boss}}
        """,
    ),
    Broken(
        "it.yaml:3: outside: a component that is called 'outside' cannot send or carry out commands; rename it",
        """
        components:
          a/digger: {use: garden_parts:Digger}
          outside: {use: garden_parts:Boss, channels: {dig: a/dig}}
        """,
    ),
    Broken(
        "it.yaml:2: a/digger: port 'dig': 'fwk/dig': names that begin with 'fwk/' are the framework's own; "
        "take another namespace",
        """
        components:
          a/digger: {use: garden_parts:Digger, channels: {dig: fwk/dig}}
        """,
    ),
)
def test_commands(folder: Path, broken: Broken) -> None:
    assert said(garden(broken), folder) == expected(broken)


GARDEN = """
components:
  a/digger: {use: "garden_parts:Digger"}
  b/digger: {use: "garden_parts:Digger"}
  a/boss: {use: "garden_parts:Boss"}
  b/boss: {use: "garden_parts:Boss", channels: {dig: a/dig}}
  w/all: {use: "garden_parts:Bosses", channels: {digs: "*/dig"}}
"""


def written(folder: Path) -> None:
    """Writes types and components."""
    write(garden(Broken("", "")), folder)


def test_each_sender_has_a_channel_of_its_own(folder: Path, load: Callable[..., Plan]) -> None:
    written(folder)
    plan = load(GARDEN)
    names = [component.name for component in plan.components]
    lines = {
        channel.name: (names[channel.writer] if channel.writer >= 0 else "", [names[i] for i in channel.readers])
        for channel in plan.channels
    }
    assert {name: line for name, line in lines.items() if not name.endswith("@outside")} == {
        "a/dig@a/boss": ("a/boss", ["a/digger"]),
        "a/dig@answers": ("a/digger", ["a/boss", "b/boss", "w/all"]),
        "a/dig@b/boss": ("b/boss", ["a/digger"]),
        "a/dig@w/all": ("w/all", ["a/digger"]),
        "b/dig@answers": ("b/digger", ["w/all"]),
        "b/dig@w/all": ("w/all", ["b/digger"]),
    }
    every = plan.components[names.index("w/all")].channels["digs"]
    assert every == ("a/dig@w/all", "a/dig@answers", "b/dig@w/all", "b/dig@answers")


def test_one_component_may_serve_all_targets(folder: Path, load: Callable[..., Plan]) -> None:
    written(folder)
    plan = load("""
        components:
          b/boss: {use: garden_parts:Boss}
          a/boss: {use: garden_parts:Boss}
          w/boss: {use: garden_parts:Boss, channels: {dig: a/dig}}
          w/other: {use: garden_parts:Bosses, channels: {digs: "*/dig"}}
          w/diggers: {use: garden_parts:Diggers, channels: {digs: "*/dig"}}
    """)
    assert plan.components[4].channels["digs"] == (
        *("a/dig@answers", "a/dig@outside", "a/dig@a/boss", "a/dig@w/boss", "a/dig@w/other"),
        *("b/dig@answers", "b/dig@outside", "b/dig@b/boss", "b/dig@w/other"),
    )


def test_sender_and_owner_of_a_command_run_without_each_other(folder: Path, load: Callable[..., Plan]) -> None:
    written(folder)
    plan = load(GARDEN, without=["*/digger"])
    assert {channel.name: channel.writer >= 0 for channel in plan.channels} == {
        "a/dig@a/boss": True,
        "a/dig@answers": False,
        "a/dig@b/boss": True,
    }
    plan = load(GARDEN, only=["b/digger"])
    assert plan.components[0].channels["dig"][0] == "b/dig@answers"
