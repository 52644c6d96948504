"""The schema for editors accepts every launch file of the project and refuses what the check refuses."""

import json
import textwrap
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import jsonschema_rs
import pytest
from typer.testing import CliRunner

from fwk.cli.steer.config import config
from fwk.model.errors import PlanError, Problems
from fwk.model.plan import Plan
from fwk.plan.files.json_schema import schema_of_file, schema_of_files
from fwk.plan.files.source import read_value, read_yaml

LAUNCH = Path(__file__).parents[3] / "launch"
Schema = dict[str, Any]
RIGHT = """
period_s: 0.1
speed: max
log: {console: off, files: 2}
templates:
  bot:
    wheels: {use: plan_parts:Wheels, config: {label: "{team}", gain: "{gain}", limits: {turns: [0, 1]}}}
    pilot: {use: plan_parts:Pilot, needs: wheels, channels: {odometry: "{namespace}/odometry"}}
robots:
  a: {use: bot, values: {team: cyan, gain: 0.5}, config: {wheels: {gain: 0.1, log_level: debug}}}
components:
  world/reader: {use: plan_parts:Reader, channels: {odometry: a/odometry}, stage: think, restart: {when: never}}
config: {"*/wheels": {mode: hard}, a/wheels: {count: 2}, a: {log_level: warning}, "a/w*": {brake: false}}
"""


def checker_of(schema: Schema) -> jsonschema_rs.Draft202012Validator:
    return jsonschema_rs.Draft202012Validator(schema)  # which checks the schema too


def mistakes(schema: Schema, data: Any) -> list[str]:
    return found_by(checker_of(schema), data)


def found_by(checker: jsonschema_rs.Draft202012Validator, data: Any) -> list[str]:
    return [f"{error.instance_path}: {error.message}" for error in checker.iter_errors(data)]


def plain(text: str) -> Any:
    node = read_value(text, "", Problems())
    assert node
    return node.plain()


@pytest.fixture
def schema(load: Callable[..., Plan]) -> Schema:
    load(RIGHT)
    made: Schema = json.loads(_schema_of_right())
    return made


@cache
def _schema_of_right() -> str:
    """Returns the schema of the launch file `RIGHT`, made once; it is the same in each folder."""
    return json.dumps(schema_of_file("it.yaml"))


@cache
def _checker_of_any() -> jsonschema_rs.Draft202012Validator:
    """Returns the checker by the schema of all launch files, made once."""
    return checker_of(schema_of_files())


@pytest.mark.parametrize("file", sorted(LAUNCH.glob("*.yaml")), ids=lambda path: path.name)
def test_every_launch_file_fits(file: Path) -> None:
    node = read_yaml(file, file.name, Problems())
    assert node
    for checker in (_checker_of_any(), checker_of(schema_of_file(str(file)))):
        assert found_by(checker, node.plain()) == []


def test_a_file_with_everything_fits(schema: Schema) -> None:
    assert mistakes(schema, plain(RIGHT)) == []


@pytest.mark.parametrize(
    ("wrong", "instead_of"),
    [
        ("perod_s: 0.1", "period_s: 0.1"),
        ("period_s: fast", "period_s: 0.1"),
        ("period_s: 0", "period_s: 0.1"),
        ("speed: 0", "speed: max"),
        ("speed: maximal", "speed: max"),
        ("console: loud", "console: off"),
        ("files: 0", "files: 2"),
        ("lable:", "label:"),
        ("turns: 1", "turns: [0, 1]"),
        ("turns: [far, 1]", "turns: [0, 1]"),
        ("channels: {odometri:", "channels: {odometry:"),
        ("brake: maybe", "brake: false"),
        ("count: many", "count: 2"),
        ("log_level: loud", "log_level: warning"),
        ("{log_level: 3}", "{log_level: warning}"),
        ("mode: harder", "mode: hard"),
        ("a/weels:", "a/wheels:"),
        ("values: {team: [cyan],", "values: {team: cyan,"),
        ("when: sometimes", "when: never"),
        ("needs: 3", "needs: wheels"),
    ],
)
def test_files_that_the_check_refuses_do_not_fit(
    schema: Schema, load: Callable[..., Plan], wrong: str, instead_of: str
) -> None:
    if instead_of == "brake: false":  # a pattern that editors do not resolve
        schema["properties"]["config"]["properties"]["a/w*"] = schema["properties"]["config"]["properties"]["a/wheels"]
    text = RIGHT.replace(instead_of, wrong, 1)
    assert text != RIGHT
    assert mistakes(schema, plain(text))
    with pytest.raises(PlanError):
        load(text)


def test_a_host_file_has_a_schema_of_its_own(schema: Schema) -> None:
    own = schema_of_file("it.yaml", host_specific=True)
    assert mistakes(own, plain("{speed: 2, config: {a/wheels: {gain: 0.3}}}")) == []
    assert mistakes(own, plain("{components: {}}"))
    assert mistakes(own, plain("{config: {a/wheels: {gian: 0.3}}}"))


def test_meanings_ranges_and_defaults_are_there(schema: Schema) -> None:
    wheels = schema["$defs"]["plan_parts:Wheels"]["properties"]
    assert wheels["gain"]["description"]
    assert wheels["log_level"]["default"] == "info"
    assert schema["properties"]["period_s"]["description"] == "Logical time from tick to tick."


def said(*arguments: str) -> tuple[int, str]:
    result = CliRunner().invoke(config, arguments)
    return result.exit_code, result.output


def test_the_command_prints_schemas_and_names_its_limits(load: Callable[..., Plan], folder: Path) -> None:
    load(RIGHT)
    for arguments in (["it.yaml"], ["it.yaml", "--host"], [], ["plan_parts:Wheels"]):
        code, text = said("schema", *arguments)
        assert code == 0
        jsonschema_rs.meta.validate(json.loads(text))
    assert json.loads(said("schema", "plan_parts:Wheels")[1])["properties"]["gain"]
    code, text = said("schema", "it.yml")
    assert (code, text.startswith("error: it.yml: no such launch file")) == (2, True)
    assert said("schema", "plan_parts:Weels") == (
        2,
        "error: module 'plan_parts' has no component 'Weels'; did you mean 'Wheels'?\n",
    )
    (folder / "bad.yaml").write_text(textwrap.dedent("components: [\n"))
    assert said("schema", "bad.yaml")[0] == 2


def test_settings_of_a_file_are_searched(load: Callable[..., Plan]) -> None:
    load(RIGHT)
    rows = json.loads(said("search", "LABEL|cyan", "--file", "it.yaml", "--json")[1])
    assert [(row["setting"], row["value"]) for row in rows] == [("label", "cyan")]
    by_value = said("search", '"hard"', "--file", "it.yaml")
    assert (by_value[0], "a/wheels.mode" in by_value[1]) == (0, True)
    assert said("search", "no such words", "--file", "it.yaml") == (
        1,
        "error: no setting matches 'no such words'\n",
    )
    assert "is not a regular expression" in said("search", "a(", "--file", "it.yaml")[1]
    assert said("get", "a/wheels.count", "--file", "it.yaml") == (0, "2\n")
    assert "did you mean 'count'?" in said("get", "a/wheels.cuont", "--file", "it.yaml")[1]
