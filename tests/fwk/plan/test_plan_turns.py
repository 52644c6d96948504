"""Ticks in which components iterate: `every` and `offset` of a launch file, its settings and the command line."""

from collections.abc import Callable
from pathlib import Path

import jsonschema_rs
import pytest

from fwk.model.errors import PlanError
from fwk.model.plan import ComponentPlan, Plan
from fwk.plan.files.json_schema import schema_of_file
from fwk.plan.load import LaunchOptions, load_plan

Load = Callable[..., Plan]

EYES = """
templates: {eye: {odometer: {use: plan_parts:Odometer, every: 2, offset: "{number}"}}}
robots: {a1: {use: eye}, a2: {use: eye}}
"""


def component(plan: Plan, name: str) -> ComponentPlan:
    return next(each for each in plan.components if each.name == name)


def turns(plan: Plan) -> list[tuple[int, int]]:
    return [(each.every, each.offset) for each in plan.components]


@pytest.mark.parametrize(
    ("text", "sets", "expected"),
    [
        ("", (), [(2, 1), (2, 2)]),
        ("config: {'*/odometer': {every: 3}}", (), [(3, 1), (3, 2)]),
        ("config: {a2: {every: 4, offset: 0}}", (), [(2, 1), (4, 0)]),
        ("config: {'*/odometer': {every: 3}, a1/odometer: {every: 5}}", (), [(5, 1), (3, 2)]),
        ("config: {'*/odometer': {every: null, offset: null}}", (), [(1, 0), (1, 0)]),
        ("config: {'*/odometer': {every: 3}}", ("a1/odometer.every=1", "*/odometer.offset=7"), [(1, 7), (3, 7)]),
        ("", ('*/odometer.offset="{number}"', "*/odometer.every=9"), [(9, 1), (9, 2)]),
    ],
)
def test_settings_change_the_ticks_of_a_template(
    load: Load, folder: Path, text: str, sets: tuple[str, ...], expected: list[tuple[int, int]]
) -> None:
    (folder / "eyes.yaml").write_text(EYES)
    plan = load(f"include: eyes.yaml\n{text}", sets=list(sets))
    assert turns(plan) == expected
    assert not any({"every", "offset"} & set(each.config) for each in plan.components)


def test_host_file_and_robot_change_the_ticks(load: Load, folder: Path) -> None:
    (folder / "eyes.yaml").write_text(EYES.replace("a2: {use: eye}", "a2: {use: eye, config: {odometer: {every: 3}}}"))
    (folder / "it.host.yaml").write_text("config: {a1/odometer: {every: 4}}")
    assert turns(load("include: eyes.yaml")) == [(4, 1), (3, 2)]


@pytest.mark.parametrize("value", ["0", "2.0", "true", "two", "[2]", "{a: 1}", "1000001"])
def test_number_of_ticks_among_settings_is_checked(load: Load, value: str) -> None:
    right = "it should be a whole number from 1 to 1000000"
    with pytest.raises(PlanError, match=rf"it.yaml:4: a1/odometer: every is .*; {right}"):
        load(f"{EYES}config: {{a1/odometer: {{every: {value}}}}}")


@pytest.mark.parametrize("value", ["-1", "half", "1.5", "[1]"])
def test_offset_among_settings_is_checked(load: Load, value: str) -> None:
    with pytest.raises(PlanError, match=r"--set: a1/odometer: offset is .*; it should be a whole number from 0 on"):
        load(EYES, sets=[f"a1/odometer.offset={value}"])


def test_class_keeps_settings_of_its_own_named_every(load: Load, folder: Path) -> None:
    (folder / "own.py").write_text(
        "from fwk import Component, Config\n"
        "class Settings(Config):\n    every: float = 0.5\n"
        "class Own(Component):\n    stage = 'think'\n    every = 3\n    config: Settings\n"
    )
    plan = load("components: {it/own: {use: own, config: {every: 0.25, offset: 1}}}")
    assert (turns(plan), plan.components[0].config["every"]) == ([(3, 1)], 0.25)


def test_continuous_component_has_no_ticks_to_change(load: Load, folder: Path) -> None:
    (folder / "free.py").write_text("from fwk import Component\nclass Free(Component):\n    rate_hz = 20\n")
    with pytest.raises(PlanError, match="--set: it/free: it is continuous and takes part in no tick; leave 'every'"):
        load("components: {it/free: {use: free}}", sets=["it/free.every=2"])


def test_schema_for_editors_knows_ticks_among_settings(load: Load, folder: Path) -> None:
    load(EYES)
    checker = jsonschema_rs.Draft202012Validator(schema_of_file("it.yaml"))
    assert checker.is_valid({"config": {"*/odometer": {"every": 2, "offset": "{number}"}}})
    assert not checker.is_valid({"config": {"*/odometer": {"every": 0}}})


CAMERA = "components:\n  it/odometer:\n    use: plan_parts:Odometer\n"


@pytest.mark.parametrize(
    ("text", "options", "place"),
    [
        (f"{CAMERA}    config: {{every_ticks: 2}}\n", {}, "it.yaml:4"),
        (f"{CAMERA}config:\n  it/odometer: {{every_ticks: 2}}\n", {}, "it.yaml:5"),
        (f"{CAMERA}    every: 3\n    config: {{every_ticks: 3}}\n", {"sets": ["it/odometer.every_ticks=2"]}, "--set"),
    ],
)
def test_former_every_ticks_is_every_and_noted_once(
    load: Load, folder: Path, text: str, options: dict[str, list[str]], place: str
) -> None:
    notes: list[str] = []
    load(text, **options)
    (plan,) = [load_plan("it.yaml", LaunchOptions(**options), notes.append)]  # type: ignore[arg-type]
    assert component(plan, "it/odometer").every == 2
    assert "every_ticks" not in component(plan, "it/odometer").config
    assert [note.partition(": ")[0].rpartition("/")[2] for note in notes if "every: 2" in note] == [place]


@pytest.mark.parametrize("setting", ["    config: {every_ticks: 2}\n", "config:\n  it/odometer: {every_ticks: 2}\n"])
def test_former_every_ticks_must_not_contradict_every(load: Load, setting: str) -> None:
    right = r"every_ticks is 2, but every is 3 at (.*/)?it.yaml:4; leave every_ticks out"
    with pytest.raises(PlanError, match=rf"it.yaml:[56]: it/odometer: {right}"):
        load(f"{CAMERA}    every: 3\n{setting}")


def test_former_every_ticks_of_a_template_is_noted_once(load: Load) -> None:
    notes: list[str] = []
    load(
        "templates: {eye: {odometer: {use: plan_parts:Odometer, config: {every_ticks: 2}}}}\n"
        "robots: {a1: {use: eye}, a2: {use: eye}}\n"
    )
    plan = load_plan("it.yaml", LaunchOptions(), notes.append)
    assert [each.every for each in plan.components] == [2, 2]
    text = "the setting 'every_ticks' is called 'every' now; say 'every: 2'"
    assert notes == [f"it.yaml:1: a1/odometer (and 1 more): {text}"]


@pytest.mark.parametrize(
    ("keys", "noted"),
    [("offset: 1", True), ("offset: 0", False), ("every: 1\n    offset: 1", False), ("every: 2\n    offset: 1", False)],
)
def test_an_offset_without_every_is_noted(load: Load, keys: str, noted: bool) -> None:
    notes: list[str] = []
    load(f"{CAMERA}    {keys}\n")
    load_plan("it.yaml", LaunchOptions(), notes.append)
    text = "it.yaml:4: it/odometer: 'offset' changes nothing, because it iterates in each tick; add 'every'"
    assert [note for note in notes if "offset" in note] == ([text] if noted else [])


@pytest.mark.parametrize("value", ["0", "two", "1.5", "true", "1000001", "[2]"])
def test_former_every_ticks_is_checked(load: Load, value: str) -> None:
    with pytest.raises(
        PlanError, match=r"it.yaml:4: it/odometer: every_ticks is .*; it should be a whole number from 1"
    ):
        load(f"{CAMERA}    config: {{every_ticks: {value}}}\n")
