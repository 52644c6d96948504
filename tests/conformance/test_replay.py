"""Every component of `procs` writes the same messages in a replay as in the short recorded run that contains it."""

from collections.abc import Callable
from functools import cache
from pathlib import Path

import pytest

from fwk import Component
from fwk.recording.replay.recording import Recording, RecordingError
from fwk.recording.replay.replay import Replay
from procs.vision.calibration import MirrorConfig
from tests.conformance.discovery import LAUNCH, discovered, label, usage
from tests.harness.runs import Launched, PortBlock, write_files
from tests.procs.vision.picture_parts import shades, write_folder

pytestmark = pytest.mark.system

TICKS = 30
SIZE_PX = MirrorConfig().size_px
ALONE = """
include: {file}
name: alone
components:
  cyan1/component: {{use: "{module}:{name}", config: {config}}}
"""
CONFIG = {"scenarios.crew": "{actions: [{place_ball: {x_m: 1.0, y_m: 0.5}}]}"}
"""Settings of components that write nothing by default."""
STILL = '  cyan1/still: {use: "procs.scenarios.dummy:Dummy"}\n'
IN_AN_EMPTY_FIELD = {"scenarios.dummy": "", "scenarios.perfect_world": STILL}
"""Components that write the same as others of a usual robot, and what they need besides."""
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


@pytest.mark.parametrize("component", discovered(), ids=label)
def test_a_component_replays_alone(
    recorded: Recorded, component: type[Component], monkeypatch: pytest.MonkeyPatch
) -> None:
    used, ticks = usage(component), LATE.get(label(component), TICKS)
    if used:
        log, name = recorded(used[0], "", ticks), used[1].name
    else:  # no launch file contains it: add it to a system of one robot
        which = label(component)
        file = LAUNCH / ("msl-field.yaml" if which in IN_AN_EMPTY_FIELD else "one-robot.yaml")
        config, module, kind = CONFIG.get(which, "{}"), component.__module__, component.__name__
        text = ALONE.format(file=file, module=module, name=kind, config=config)
        log, name = recorded("alone.yaml", text + IN_AN_EMPTY_FIELD.get(which, ""), ticks), "cyan1/component"
    monkeypatch.chdir(log.parent)
    if component.reaches_outside:
        with pytest.raises(RecordingError, match="it reaches outside"):
            Replay(Recording(log), [name])
        return
    replay = Replay(Recording(log), [name])
    replay.run()
    assert [str(each) for each in replay.differences] == []
    assert replay.compared > 0
