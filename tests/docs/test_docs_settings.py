"""Every setting of the soccer that pages and examples of commands override exists."""

import re
from collections.abc import Iterator
from functools import cache

import pytest

from fwk.cli.examples import EXAMPLES
from fwk.cli.steer.setting_files import rows_of
from fwk.model.selection import matches
from fwk.plan.files.overrides import EXAMPLE, SHARED
from tests.docs.docs_pages import ROOT

FILES = ("soccer.yaml", "soccer-percepts.yaml", "one-robot.yaml", "kidnapped.yaml", "vision.yaml")
TURNS = {"every", "offset"}
_OVERRIDE = re.compile(r"(?<![\w/*])((?:[\w*]+/[\w*]+|shared)\.[\w.]+)=")


@cache
def known() -> frozenset[tuple[str, str]]:
    """Returns components with the dotted names of their settings, and of what these contain."""
    rows = [(row["component"], row["setting"]) for file in FILES for row in rows_of(str(ROOT / "launch" / file), [])]
    return frozenset((name, part) for name, setting in rows for part in parts(setting))


def parts(setting: str) -> Iterator[str]:
    words = setting.split(".")
    yield from (".".join(words[:count]) for count in range(1, len(words) + 1))


def exists(override: str) -> bool:
    """Returns whether a component has the setting; keys of mappings that are empty are not known."""
    pattern, _, setting = override.partition(".")
    free = {"world/simulator.errors", "world/simulator.stuck_wheels"}
    setting = next((each.partition(".")[2] for each in free if override.startswith(f"{each}.")), setting)
    return any(
        (setting == own or setting in TURNS) and (pattern == SHARED or matches(name, pattern)) for name, own in known()
    )


@pytest.mark.parametrize("page", ["soccer", "launch-file", "control", "images"])
def test_settings_on_a_page_exist(page: str) -> None:
    overrides = _OVERRIDE.findall((ROOT / "docs" / f"{page}.md").read_text())
    assert not [each for each in overrides if not exists(each)]


def test_settings_in_examples_of_commands_exist() -> None:
    overrides = _OVERRIDE.findall("\n".join((EXAMPLE, *(line for lines in EXAMPLES.values() for line in lines))))
    assert overrides
    assert not [each for each in overrides if not exists(each)]


@pytest.mark.parametrize(
    ("override", "there"),
    [
        ("cyan*/agent.use_roles", True),
        ("world/simulator.physics.battery.capacity_wh", True),
        ("shared.ball.radius_m", True),
        ("*/camera.every", True),
        ("cyan1/omni_ball.gain", False),
        ("cyan9/agent.use_roles", False),
    ],
)
def test_a_setting_that_does_not_exist_is_noticed(override: str, there: bool) -> None:
    assert exists(override) is there
