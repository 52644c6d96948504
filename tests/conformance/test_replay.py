"""Every component of `procs` writes the same messages in a replay as in the short recorded run that contains it."""

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import yaml

from fwk import Component
from fwk.component.declaration import declaration
from fwk.plan.load import LaunchOptions, load_plan
from fwk.recording.replay.recording import Recording, RecordingError
from fwk.recording.replay.replay import Replay
from procs.vision.calibration import MirrorConfig
from tests.conformance.discovery import LAUNCH, discovered, label, usage
from tests.harness.runs import Launched, PortBlock, write_files
from tests.procs.vision.picture_parts import shades, write_folder

pytestmark = pytest.mark.system

TICKS = 30
SIZE_PX = MirrorConfig().size_px
LINE_UP = {
    "include": [str(LAUNCH / file) for file in ("msl-field.yaml", "msl-radio.yaml")],
    "robots": {"team_cyan": {"use": "msl_radio", "values": {"team": "cyan"}}, "cyan1": {"use": "robot"}},
}
"""One robot with a radio, and the field."""
CONFIG = {"scenarios.crew": {"actions": [{"place_ball": {"x_m": 1.0, "y_m": 0.5}}]}}
"""Settings of components that write nothing by default."""
PARTS = {"scenarios.dummy": (), "scenarios.scripted": ("base", "kicker")}
"""Components that stand in for most of a robot, and its other parts."""
LATE = {"world_model.ball_spot": 110}
"""Components that write nothing in a short run, with the ticks that they need: the robot has to find the ball."""
Recorded = Callable[[str, str, int], Path]


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Recorded:
    """Runs a launch file once for all components in it that need so many ticks; returns the recording."""

    @cache
    def run(file: str, text: str, ticks: int) -> Path:
        folder = tmp_path_factory.mktemp("run")
        write_folder(folder / "pictures", shades(TICKS, SIZE_PX, SIZE_PX))
        write_files(folder, {file: text} if text else {})
        with PortBlock(blocks=3) as ports:
            options = ("--ticks", str(ticks), "--speed", "max", "--record", "log.lcm", "--hosting", "single")
            where = ("--set", f"public_url={ports.public_url}")
            launched = Launched(folder, ports, (file, *options, *where), {})
            try:
                assert launched.wait() == 0, launched.text
            finally:
                launched.end()
        return folder / "log.lcm"

    return run


def robot_with(component: type[Component]) -> dict[str, Any]:
    """Returns the template of a robot with a component, instead of those that write the same: another agent, say."""
    usual: dict[str, Any] = yaml.safe_load((LAUNCH / "msl-stereo.yaml").read_text())["templates"]["msl_robot_stereo"]
    plan = load_plan(str(LAUNCH / "one-robot.yaml"), LaunchOptions())
    own = {f"cyan1/{port.attribute}" for port in declaration(component).ports if port.writes}
    rivals = {plan.components[each.writer].name.removeprefix("cyan1/") for each in plan.channels if each.name in own}
    use = {"use": f"{component.__module__}:{component.__name__}", "config": CONFIG.get(label(component), {})}
    parts = PARTS.get(label(component), usual)
    kept = {key: entry for key, entry in usual.items() if key in parts and key not in rivals}
    return kept | {"component": use}


@pytest.mark.parametrize("component", discovered(), ids=label)
def test_a_component_replays_alone(
    recorded: Recorded, component: type[Component], monkeypatch: pytest.MonkeyPatch
) -> None:
    used, ticks = usage(component), LATE.get(label(component), TICKS)
    if used:
        log, name = recorded(used[0], "", ticks), used[1].name
    else:  # no launch file contains it: add it to a system of one robot
        text = yaml.safe_dump(LINE_UP | {"templates": {"robot": robot_with(component)}})
        log, name = recorded("alone.yaml", text, ticks), "cyan1/component"
    monkeypatch.chdir(log.parent)
    if component.reaches_outside:
        with pytest.raises(RecordingError, match="it reaches outside"):
            Replay(Recording(log), [name])
        return
    replay = Replay(Recording(log), [name])
    replay.run()
    assert [str(each) for each in replay.differences] == []
    assert replay.compared > 0
