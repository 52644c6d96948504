"""Settings of the world model at the ends of their ranges."""

import pytest

from fwk.control.requests import RequestError
from fwk.control.settings import RunSettings
from fwk.plan.load import load_plan
from fwk.testing import system_of

NAME = "cyan1/world_model"


@pytest.mark.slow
def test_settings_are_refused_or_the_match_goes_on() -> None:
    """Numbers of any size that `fwk config set` takes leave a running match in order."""
    plan = load_plan("soccer-1v1.yaml")
    settings = RunSettings(plan)
    before = next(each.config for each in plan.components if each.name == NAME)
    system = system_of("soccer-1v1.yaml")
    system.tick(60)
    numbers = [row["setting"] for row in settings.rows([NAME]) if row["editable"] and "float" in row["type"]]
    assert "mate_radius_m" in numbers
    for number in numbers:
        for value in ("0", "1e-300", "100", "1e6", "1e300"):
            try:
                (new,) = settings.check([f"{NAME}.{number}={value}"])
            except RequestError:
                continue
            system.runners[NAME].configure(new.values)
            system.tick(4)
    system.runners[NAME].configure(before)
    system.tick(60)
    assert system.newest(f"{NAME}").localized


@pytest.mark.parametrize(
    ("number", "most"),
    [
        ("mate_radius_m", "100"),
        ("obstacle_deviation_m", "100"),
        ("border_m", "100"),
        ("sight_correlation", "1000000"),
        ("ball_shake_s_m", "100"),
        ("robot_shake_s_m", "100"),
        ("pose_correlation", "1000000"),
        ("team_correlation", "1000000"),
    ],
)
def test_numbers_that_no_match_survives_are_refused(number: str, most: str) -> None:
    settings = RunSettings(load_plan("soccer-1v1.yaml"))
    with pytest.raises(RequestError, match=f"'{number}' is 1e\\+300; it should be less than or equal to {most}"):
        settings.check([f"{NAME}.{number}=1e300"])
