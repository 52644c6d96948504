"""Settings of a match that `fwk config set` changes while it runs, or refuses to."""

import pytest

from fwk.control.requests import RequestError
from fwk.control.settings import RunSettings
from fwk.model.errors import PlanError
from fwk.plan.load import LaunchOptions, load_plan


@pytest.fixture(scope="module")
def settings() -> RunSettings:
    return RunSettings(load_plan("soccer-1v1.yaml"))


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("world/simulator.stuck_wheels.cyan33=[1]", "stuck_wheels: no robot 'cyan33'; there are: cyan1, magenta1"),
        ("world/simulator.stuck_wheels.cyan1=[4]", "'stuck_wheels.cyan1.0' is 4; it should be 1, 2 or 3"),
    ],
)
def test_robots_and_wheels_are_refused_as_at_launch(settings: RunSettings, text: str, cause: str) -> None:
    with pytest.raises(PlanError) as at_launch:
        load_plan("soccer-1v1.yaml", LaunchOptions(sets=[text]))
    with pytest.raises(RequestError) as in_run:
        settings.check([text])
    assert str(at_launch.value) == f"--set: world/simulator: {cause}"
    assert str(in_run.value) == f"world/simulator: {cause}"


def test_players_are_fixed_in_each_component(settings: RunSettings) -> None:
    names = [f"{row['component']}.{row['setting']}" for row in settings.rows(["*.players.cyan1.number"])]
    assert {"world/simulator", "world/referee", "cyan1/agent"} <= {name.partition(".")[0] for name in names}
    for name in names:
        with pytest.raises(RequestError, match=r"'players\.cyan1.number' cannot change during a run"):
            settings.check([f"{name}=3"])
