"""From a launch file to a plan: settings in layers, templates, processes, parts, own folders."""

import json
import re
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from fwk.model.errors import PlanError
from fwk.model.plan import NOBODY, ComponentPlan, Plan
from fwk.model.plan_document import document_of, plan_from
from fwk.model.sections import RestartPolicy
from fwk.plan.load import LaunchOptions, load_plan
from fwk.plan.wiring.start_order import start_order

Load = Callable[..., Plan]

DRIVING = """
components:
  it/wheels: {use: plan_parts:Wheels}
  it/pilot: {use: plan_parts:Pilot}
"""

ROBOTS = """
templates:
  driving:
    wheels: {use: plan_parts:Wheels, config: {label: "{team} {number}", count: "{number}"}}
    pilot: {use: plan_parts:Pilot, needs: [wheels, world/watcher]}
  seeing:
    camera: {use: plan_parts:Camera}
    eye: {use: plan_parts:Eye}
robots:
  cyan1: {use: [driving, seeing], values: {team: cyan, number: 1}}
  cyan2: {use: driving, values: {team: cyan, number: 2}, config: {wheels: {gain: 0.25}}}
components:
  world/watcher: {use: plan_parts:Watcher}
"""


def component(plan: Plan, name: str) -> ComponentPlan:
    return next(each for each in plan.components if each.name == name)


def channel_names(plan: Plan) -> list[str]:
    return [channel.name for channel in plan.channels]


def test_missing_keys_have_defaults(load: Load, folder: Path) -> None:
    plan = load(DRIVING)
    assert (plan.name, plan.file, plan.period_us, plan.clock) == ("it", str(folder / "it.yaml"), 50_000, "simulated")
    assert (plan.seed, plan.speed, plan.stage_time_us, len(plan.stages)) == (1, 1.0, 0, 10)
    wheels = component(plan, "it/wheels")
    assert (wheels.restart, wheels.ready_timeout_s, wheels.needs) == (RestartPolicy(), None, ())
    assert wheels.config["limits"] == {"speed_m_s": 2.0, "turns": [-1.0, 1.0]}
    assert set(wheels.origins.values()) == {"default"}


def test_a_run_imports_only_what_it_uses(folder: Path) -> None:
    (folder / "heavy.py").write_text("def seen() -> None: ...")
    (folder / "it.yaml").write_text(f"evaluation: heavy:seen\nvideo: heavy:nothing{DRIVING}")
    plan = load_plan(str(folder / "it.yaml"), LaunchOptions(run_only=True))
    assert (plan.evaluation, plan.video, "heavy" in sys.modules) == ("heavy:seen", "heavy:nothing", False)
    with pytest.raises(PlanError, match="video: module 'heavy' has no 'nothing'"):
        load_plan(str(folder / "it.yaml"))


def test_keys_of_a_file_describe_the_run(load: Load) -> None:
    plan = load(
        "name: other\nperiod_s: 0.01\nclock: wall\nspeed: max\nseed: 9\nstage_time_s: 0.002\n"
        "stages: [act_exec, sensor_acquire]\npublic_url: udpm://239.255.76.67:7777?ttl=1\n"
        "scoreboard: plan_parts:greet\nloop_time_s: 0.02\nloop_time_warnings: false\ncores: namespace\n"
        "components: {it/a: {use: plan_parts:Odometer, restart: {when: never, limit: 2}, ready_timeout_s: 3}}\n"
    )
    assert (plan.name, plan.period_us, plan.clock, plan.speed, plan.seed) == ("other", 10_000, "wall", 0.0, 9)
    assert (plan.stage_time_us, plan.stages) == (2_000, ("act_exec", "sensor_acquire"))
    assert (plan.loop_time_us, plan.loop_time_warnings, plan.cores) == (20_000, False, "namespace")
    assert plan.public_url == "udpm://239.255.76.67:7777?ttl=1&recv_buf_size=4194304"
    assert (plan.scoreboard, plan.scoreboard_channels) == ("plan_parts:greet", ("it/odometry",))
    only = plan.components[0]
    assert (only.restart.when, only.restart.limit, only.ready_timeout_s, only.stages) == ("never", 2, 3.0, (1,))


def test_robots_take_turns_by_their_numbers(load: Load) -> None:
    plan = load(
        "templates: {eye: {odometer: {use: plan_parts:Odometer, every: 3, offset: '{number}'}}}\n"
        "robots: {cyan1: {use: eye}, cyan12: {use: eye}, lone: {use: eye}}\n"
    )
    assert [(each.name, each.every, each.offset) for each in plan.components] == [
        ("cyan1/odometer", 3, 1),
        ("cyan12/odometer", 3, 12),
        ("lone/odometer", 3, 0),
    ]
    assert [[tick for tick in range(1, 8) if each.due(tick)] for each in plan.components] == [[1, 4, 7], [3, 6], [3, 6]]


def test_options_win_over_the_file(load: Load) -> None:
    plan = load(DRIVING + "seed: 9\nspeed: 2\n", seed=4, speed=0.0, bus_port=20_000)
    assert (plan.seed, plan.speed, plan.bus_port) == (4, 0.0, 20_000)
    assert load(DRIVING, sets=["period_s=0.1", "speed=max"]).period_us == 100_000


PORTS = [(None, 7667), (17_700, 7667), (18_700, 8667), (11_057, 1024), (11_056, 65_535)]


@pytest.mark.parametrize(("bus_port", "port"), PORTS)
def test_public_bus_moves_with_the_bus_port_unless_named(load: Load, bus_port: int | None, port: int) -> None:
    assert load(DRIVING, bus_port=bus_port).public_url.startswith(f"udpm://239.255.76.67:{port}?")
    named = load(DRIVING + "public_url: udpm://239.255.76.67:7000\n", bus_port=bus_port)
    assert named.public_url == "udpm://239.255.76.67:7000?recv_buf_size=4194304"


def test_settings_override_each_other_and_name_their_origin(load: Load, folder: Path) -> None:
    (folder / "part.yaml").write_text(
        "components:\n"
        "  it/wheels:\n"
        "    use: plan_parts:Wheels\n"
        "    config: {gain: 0.1, count: 1, mode: hard, label: part, limits: {speed_m_s: 1.0}}\n"
        "config: {'*/wheels': {gain: 0.2}}\n"
    )
    (folder / "it.host.yaml").write_text("config:\n  it/wheels:\n    mode: soft\n    label: host\n")
    plan = load(
        "include: part.yaml\ncomponents: {it/pilot: {use: plan_parts:Pilot}}\n"
        "config:\n  it/wheels: {count: 2, mode: hard,\n    limits: {turns: [-2, 2]}}\n",
        sets=["it/wheels.label=typed", "it/wheels.limits.speed_m_s=3"],
    )
    wheels = component(plan, "it/wheels")
    limits = {"speed_m_s": 3.0, "turns": [-2.0, 2.0]}
    assert wheels.config == {
        "gain": 0.2, "count": 2, "brake": True, "mode": "soft", "label": "typed", "limits": limits,
        "log_level": "info",
    }  # fmt: skip
    assert wheels.origins == {
        "gain": "part.yaml:5",
        "count": "it.yaml:4",
        "brake": "default",
        "mode": "it.host.yaml:3",
        "label": "--set",
        "limits.speed_m_s": "--set",
        "limits.turns": "it.yaml:5",
        "log_level": "default",
    }


def test_a_template_makes_the_components_of_each_robot(load: Load) -> None:
    plan = load(ROBOTS)
    assert [each.name for each in plan.components] == [
        "world/watcher",
        "cyan1/wheels",
        "cyan1/pilot",
        "cyan1/camera",
        "cyan1/eye",
        "cyan2/wheels",
        "cyan2/pilot",
    ]
    first, second = component(plan, "cyan1/wheels").config, component(plan, "cyan2/wheels").config
    assert (first["label"], first["count"], first["gain"]) == ("cyan 1", 1, 0.5)
    assert (second["label"], second["count"], second["gain"]) == ("cyan 2", 2, 0.25)
    assert component(plan, "cyan2/wheels").origins["gain"] == "it.yaml:11"
    assert component(plan, "cyan2/pilot").needs == (5, 0)
    assert component(plan, "world/watcher").channels == {"odometries": ("cyan1/odometry", "cyan2/odometry")}


def test_a_viewer_of_images_needs_the_camera(load: Load) -> None:
    plan = load("components: {it/eye: {use: plan_parts:Eye}, it/camera: {use: plan_parts:Camera}}")
    assert [each.needs for each in plan.components] == [(1,), ()]


def test_channels_know_their_writer_and_readers(load: Load) -> None:
    plan = load(ROBOTS)
    odometry = plan.channels[channel_names(plan).index("cyan1/odometry")]
    assert (odometry.writer, odometry.readers, odometry.type_name) == (1, (0, 2), "robot.odometry_t")
    assert not odometry.images
    assert plan.channels[channel_names(plan).index("cyan1/image")].images
    assert [channel.index for channel in plan.channels] == list(range(len(plan.channels)))


def test_a_launch_file_can_set_channels_and_stages(load: Load) -> None:
    plan = load(
        "components:\n"
        "  a/wheels: {use: plan_parts:Wheels, channels: {motor_command: b/go, odometry: truth}, stage: think}\n"
        "  b/pilot: {use: plan_parts:Pilot, channels: {motor_command: go, odometry: a/truth}}\n"
    )
    assert component(plan, "a/wheels").channels == {"motor_command": ("b/go",), "odometry": ("a/truth",)}
    assert [plan.stages[index] for index in component(plan, "a/wheels").stages] == ["think"]


def test_a_file_that_two_others_include_counts_once(load: Load, folder: Path) -> None:
    (folder / "base.yaml").write_text(DRIVING)
    (folder / "left.yaml").write_text("include: base.yaml\nseed: 3")
    (folder / "right.yaml").write_text("include: base.yaml\nseed: 4")
    plan = load("include: [left.yaml, right.yaml]")
    assert (len(plan.components), plan.seed) == (2, 4)


@pytest.mark.parametrize(
    ("hosting", "expected"),
    [
        ("process", ["world/watcher", "driving", "cyan1/camera", "cyan1/eye"]),
        ("robot", ["world", "cyan1", "cyan2"]),
        ("single", ["all"]),
    ],
)
def test_components_share_processes(load: Load, hosting: str, expected: list[str]) -> None:
    plan = load(ROBOTS + "hosts: {driving: ['*/wheels', '*/pilot']}\n", hosting=hosting)
    assert [host.name for host in plan.hosts] == expected
    assert sorted(member for host in plan.hosts for member in host.components) == list(range(7))
    assert all(each.index in plan.hosts[each.host].components for each in plan.components)


@pytest.mark.parametrize(
    ("hosting", "expected"), [("robot", ["it", "it/eye", "it/camera"]), ("single", ["all", "it/eye", "it/camera"])]
)
def test_a_delayed_component_keeps_a_process_of_its_own(load: Load, hosting: str, expected: list[str]) -> None:
    plan = load(
        "components:\n"
        "  it/one: {use: plan_parts:Odometer}\n"
        "  it/eye: {use: plan_parts:Eye, start: false}\n"
        "  it/camera: {use: plan_parts:Camera, start: false}\n"
        "  it/two: {use: plan_parts:Watcher}\n",
        hosting=hosting,
    )
    assert [host.name for host in plan.hosts] == expected
    assert [each.start for each in plan.components] == [True, False, False, True]
    assert start_order(plan.components, [0, 1, 2, 3]) == [0, 2, 1, 3]


def test_a_channel_whose_writer_is_left_out_has_none(load: Load) -> None:
    plan = load(ROBOTS, only=["cyan1", "world"], without=["*/wheels", "cyan1/camera", "cyan1/eye"])
    assert [each.name for each in plan.components] == ["world/watcher", "cyan1/pilot"]
    assert component(plan, "world/watcher").channels == {"odometries": ()}
    assert component(plan, "cyan1/pilot").needs == (0,)
    writers = {channel.name: channel.writer for channel in plan.channels}
    assert writers == {"cyan1/odometry": NOBODY, "cyan1/motor_command": 1}


def test_a_reader_of_many_needs_no_writer(load: Load) -> None:
    text = (
        "components: {a/one: {use: plan_parts:Odometer}, a/x: {use: plan_parts:Reader}, w: {use: plan_parts:Watcher}}"
    )
    assert component(load(text), "w").channels == {"odometries": ("a/odometry",)}
    left = load(text, without=["a/one"])
    assert component(left, "w").channels == {"odometries": ()}
    assert component(left, "a/x").channels == {"odometry": ("a/odometry",)}


def test_programs_outside_write_channels(load: Load) -> None:
    plan = load("components: {a/reader: {use: plan_parts:Reader}}\noutside: {a/odometry: robot.odometry_t}\n")
    assert plan.outside == {"a/odometry": "robot.odometry_t"}
    assert (plan.channels[0].name, plan.channels[0].writer, plan.channels[0].readers) == ("a/odometry", NOBODY, (0,))


def test_programs_outside_stand_in_for_left_out_writers(load: Load, folder: Path) -> None:
    plan = load(ROBOTS, without=["cyan1/wheels", "cyan1/pilot"], outside=["cyan1/[om]*"])
    assert plan.outside == {"cyan1/motor_command": "robot.motor_command_t", "cyan1/odometry": "robot.odometry_t"}
    for words, reason in (
        ({"outside": ["cyan1/odometry"]}, "'cyan1/odometry' is written by cyan1/wheels; leave it out: --without cyan1"),
        ({"outside": ["cyan1/odometri"]}, "--outside: no channel 'cyan1/odometri'; did you mean 'cyan1/odometry'?"),
    ):
        with pytest.raises(PlanError, match=re.escape(reason)):
            load(ROBOTS, **words)


def test_own_components_are_found_beside_or_above_the_file(folder: Path) -> None:
    for part in ("launch", "procs", "lcmtypes"):
        (folder / part).mkdir()
    (folder / "lcmtypes" / "planted.lcm").write_text(
        "package planted;\nstruct moisture_t { core.header_t header; double percent; }"
    )
    (folder / "procs" / "planted_probe.py").write_text(
        "from fwk import Component, Writes\nfrom lcmtypes.planted import moisture_t\n"
        "class Probe(Component):\n    stage = 'think'\n    moisture: Writes[moisture_t]\n"
    )
    (folder / "launch" / "planted_here.py").write_text(
        "from fwk import Component, Reads\nfrom lcmtypes.planted import moisture_t\n"
        "class Here(Component):\n    stage = 'think'\n    moisture: Reads[moisture_t]\n"
    )
    (folder / "launch" / "garden.yaml").write_text(
        "components: {bed/probe: {use: procs.planted_probe}, bed/here: {use: planted_here}}"
    )
    plan = load_plan("garden.yaml", LaunchOptions())
    assert plan.folders == (str(folder / "launch"), str(folder))
    assert [(each.module, each.class_name) for each in plan.components] == [
        ("procs.planted_probe", "Probe"),
        ("planted_here", "Here"),
    ]
    assert plan.channels[0].type_name == "planted.moisture_t"
    assert sys.path[:2] == list(plan.folders)


def test_any_package_above_a_folder_called_launch_can_be_used(folder: Path) -> None:
    for part in ("launch", "planted_package"):
        (folder / part).mkdir()
    (folder / "planted_package" / "sun.py").write_text("from plan_parts import Sun as Star\nclass Sun(Star): ...\n")
    (folder / "launch" / "it.yaml").write_text("components: {sun: {use: planted_package.sun}}")
    assert load_plan("it.yaml", LaunchOptions()).components[0].class_name == "Sun"


def test_a_copy_of_an_installed_type_does_no_harm(load: Load, folder: Path) -> None:
    source = Path(__file__).parents[3] / "lcmtypes" / "robot.lcm"
    (folder / "lcmtypes").mkdir()
    (folder / "lcmtypes" / "robot.lcm").write_text(source.read_text())
    assert load(DRIVING).folders == (str(folder),)


def test_a_plan_survives_being_written_down(load: Load) -> None:
    plan = load(ROBOTS, without=["cyan2/wheels"])
    assert plan_from(json.loads(json.dumps(document_of(plan)))) == plan


def test_the_same_file_gives_the_same_plan(load: Load) -> None:
    assert load(ROBOTS) == load(ROBOTS)


RESTLESS = """
components:
  it/a: {use: "restless:Restless"}
  it/b: {use: "restless:Restless", rate_hz: 0.5}
  it/c: {use: "restless:Calm"}
hosts: {all: it}
"""
RESTLESS_PARTS = """
from fwk import Component
class Restless(Component):
    rate_hz = 20
class Calm(Component):
    stage = "think"
"""


@pytest.mark.parametrize("hosting", ["process", "robot", "single"])
def test_continuous_component_has_its_own_rate_and_process(load: Load, folder: Path, hosting: str) -> None:
    (folder / "restless.py").write_text(RESTLESS_PARTS)
    plan = load(RESTLESS, hosting=hosting)
    assert [(each.rate_hz, each.stages) for each in plan.components] == [(20, ()), (0.5, ()), (None, (5,))]
    assert [host.components for host in plan.hosts] == [(0,), (1,), (2,)]
    assert plan_from(json.loads(json.dumps(document_of(plan)))) == plan
