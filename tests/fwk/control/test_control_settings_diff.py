"""Launch files compared with the settings of a run."""

import pytest
from pydantic import Field

from fwk import Component, Config, Writes
from fwk.control.settings import RunSettings
from fwk.control.settings_diff import differences
from fwk.testing.plans import plan_of
from lcmtypes.robot import imu_t


class Limits(Config):
    most: float | None = None


class RobotConfig(Config):
    gain: float = 0.3
    limits: Limits = Limits()
    stuck: dict[str, list[int]] = {}
    fixed: int = Field(1, frozen=True)


class Robot(Component):
    stage = "think"
    config: RobotConfig
    imu: Writes[imu_t]


FILES = plan_of({"a/robot": Robot})


@pytest.fixture
def run() -> RunSettings:
    for name in ("gain", "limits.most", "stuck", "fixed"):
        FILES.components[0].origins[name] = "default"
    return RunSettings(FILES)


def change(run: RunSettings, *sets: str) -> None:
    for new in run.check(sets):
        run.take(new, "fwk config set")


def test_change_that_was_not_kept_is_undone(run: RunSettings) -> None:
    """Also that of a setting without a value in the files."""
    change(run, "a/robot.gain=1", "a/robot.limits.most=5")
    now, later = differences(run.rows([]), FILES)
    assert (now, later) == (["a/robot.gain=0.3", "a/robot.limits.most=null"], [])
    change(run, *now)
    assert differences(run.rows([]), FILES) == ([], [])


def test_key_that_the_files_lack_stays_until_the_run_ends(run: RunSettings) -> None:
    change(run, "a/robot.stuck={x: [1], y: [2]}")
    assert [row["setting"] for row in run.rows(["a/robot.stuck"])] == ["stuck.x", "stuck.y"]
    assert differences(run.rows([]), FILES) == ([], ["a/robot.stuck={}"])


def test_fixed_setting_is_for_the_next_run(run: RunSettings) -> None:
    edited = plan_of({"a/robot": Robot}, {"a/robot": {"fixed": 2, "stuck": {"x": [3]}}})
    assert differences(run.rows([]), edited) == (["a/robot.stuck={x: [3]}"], ["a/robot.fixed=2"])


def test_every_and_offset_are_for_the_next_run(run: RunSettings) -> None:
    told = [{"name": "a/robot", "every": 1, "offset": 0}, {"name": "gone/robot", "every": 3, "offset": 0}]
    edited = plan_of({"a/robot": Robot}, turns={"a/robot": (2, 1)})
    assert differences(run.rows([]), edited, told) == ([], ["a/robot.every=2", "a/robot.offset=1"])
    assert differences(run.rows([]), FILES, told) == ([], [])
