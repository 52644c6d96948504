"""Any settings files and requests get an answer or a sentence, and no file is damaged."""

import json
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as some

from fwk.control import requests
from fwk.control.host_file import KeepError, Kept, forget, keep
from fwk.control.requests import RequestError, parsed
from fwk.control.settings import RunSettings
from fwk.control.yaml_edit import EditError, read
from fwk.model.errors import PlanError
from fwk.plan.load import LaunchOptions, load_plan
from tests.harness.fuzz import HOSTILE_TEXT

FEW = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
PARTS = """
from fwk import Component, Config

class Inner(Config):
    deep: int = 1

class TinyConfig(Config):
    gain: float = 1.0
    names: list[str] = []
    pair: tuple[int, int] = (1, 2)
    inner: Inner = Inner()

class Tiny(Component):
    stage = "think"
    config: TinyConfig
"""
SYSTEM = 'include: part.yaml\ncomponents: {a/tiny: {use: "fuzz_parts:Tiny"}, b/tiny: {use: "fuzz_parts:Tiny"}}\n'
WORDS = ["a/tiny", "*", "config", "gain", "inner", "deep", "names", "log", "log_level", "x", "1", "a b", "ä", "~", "-"]
some_key = some.sampled_from(WORDS)
some_value = some.recursive(
    some.none() | some.booleans() | some.integers() | some.floats() | some.text(max_size=8) | some_key,
    lambda below: some.lists(below, max_size=3) | some.dictionaries(some_key, below, max_size=3),
    max_leaves=6,
)
some_yaml = some.text(alphabet="config a/b:{}[]&*!|>-?#%\"'\\,\n \t0.e~=", max_size=80)
some_words = some.sampled_from(HOSTILE_TEXT) | some.text(max_size=20) | some_key


@pytest.fixture
def system(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "fuzz_parts.py").write_text(PARTS)
    (tmp_path / "part.yaml").write_text("seed: 3\n")
    (tmp_path / "it.yaml").write_text(SYSTEM)
    return tmp_path


@pytest.mark.parametrize("name", ["it.host.yaml", "part.yaml"])
@FEW
@given(text=some_yaml | some_value.map(json.dumps) | some.sampled_from(HOSTILE_TEXT))
def test_any_host_specific_or_included_file(system: Path, name: str, text: str) -> None:
    (system / name).write_text(text, errors="replace")
    places = []
    try:
        load_plan("it.yaml", LaunchOptions())
    except PlanError as error:
        places = [problem.place for problem in error.problems]
    assert all(place.startswith((name, "it.yaml", "part.yaml")) for place in places)


@FEW
@given(some.lists(some.tuples(some_words, some_words, some_words), max_size=3))
def test_any_settings_typed_at_the_start(system: Path, typed: list[tuple[str, str, str]]) -> None:
    with suppress(PlanError):
        load_plan("it.yaml", LaunchOptions(sets=[f"{name}.{setting}={value}" for name, setting, value in typed]))


@FEW
@given(some.lists(some_words | some.tuples(some_words, some_words).map(lambda pair: f"a/tiny.{pair[0]}={pair[1]}")))
def test_any_settings_asked_of_a_run(system: Path, changes: list[str]) -> None:
    run = RunSettings(load_plan("it.yaml", LaunchOptions()))
    with suppress(RequestError):
        for new in run.check(changes):
            run.take(new, "fuzz")
    with suppress(RequestError):
        run.rows(changes)
    assert json.dumps(run.rows([]))


def commented(data: Any) -> str:
    """A mapping of settings with a comment at each line of its first two levels."""
    lines = ["# begins"]
    for key, below in data.items():
        if isinstance(below, dict) and below:
            lines.append(f"{json.dumps(key)}:  # of {key}")
            lines += [f"  {json.dumps(inner)}: {json.dumps(value)}  # {inner}" for inner, value in below.items()]
        else:
            lines.append(f"{json.dumps(key)}: {json.dumps(below)}  # of {key}")
    return "\n".join([*lines, "# ends", ""])


json_value = some.recursive(
    some.booleans() | some.integers(-(10**6), 10**6) | some.floats(-1e6, 1e6) | some.text(max_size=8) | some_key,
    lambda below: some.lists(below, max_size=3) | some.dictionaries(some_key, below, max_size=3),
    max_leaves=5,
)
some_config = some.dictionaries(
    some.sampled_from(["config", "log", "seed"]), some.dictionaries(some_key, json_value, max_size=3) | json_value
)


@FEW
@given(some_config, some.sampled_from(["a/tiny", "*/tiny", "b"]), some.lists(some_key, min_size=1), json_value)
@example({"config": {"a/tiny": {"gain": 1}}}, "a/tiny", ["gain"], 0.5)
def test_kept_settings_are_there_and_the_rest_stays(
    tmp_path: Path, data: dict[str, Any], component: str, path: list[str], value: Any
) -> None:
    file = tmp_path / "it.host.yaml"
    before = commented(data)
    file.write_text(before)
    try:
        keep(file, [Kept(component, ".".join(path), value)])
    except KeepError:
        assert file.read_text() == before
        return
    kept = read(file.read_text())
    below = kept["config"][component]
    for key in path:
        below = below[key]
    assert below == value
    assert {key: each for key, each in kept.items() if key != "config"} == {
        key: each for key, each in data.items() if key != "config"
    }
    comments = [line for line in before.splitlines() if line.startswith("#")]
    assert [line for line in file.read_text().splitlines() if line.startswith("#")] == comments


@FEW
@given(some_yaml, some_key, some_value)
def test_no_file_is_damaged(tmp_path: Path, text: str, setting: str, value: Any) -> None:
    file = tmp_path / "it.host.yaml"
    file.write_text(text)
    with suppress(KeepError):
        keep(file, [Kept("a/tiny", setting, value)])
        assert setting in read(file.read_text())["config"]["a/tiny"]
        return
    assert file.read_text() == text
    with suppress(EditError):
        read(text)


def bare(data: Any) -> Any:
    """Returns the value without empty mappings."""
    if not isinstance(data, dict):
        return data
    below = {key: bare(each) for key, each in data.items()}
    return {key: each for key, each in below.items() if each != {}}


@FEW
@given(some_config, some.sampled_from(["a/tiny", "*/tiny", "b"]), some.lists(some_key, min_size=1), json_value)
def test_kept_and_forgotten_settings_leave_the_rest(
    tmp_path: Path, data: dict[str, Any], component: str, path: list[str], value: Any
) -> None:
    file, setting = tmp_path / "it.host.yaml", ".".join(path)
    file.write_text(commented(data))
    with suppress(KeepError):
        forget(file, [f"{component}.{setting}"])  # it may have existed before
    before = read(file.read_text())
    try:
        keep(file, [Kept(component, setting, value)])
    except KeepError:
        return
    kept = file.read_text()
    try:
        forget(file, [f"{component}.{setting}"])
    except KeepError:
        assert file.read_text() == kept
        return
    below = read(file.read_text())
    if isinstance(before.get("config"), dict) and isinstance(before["config"].get(component, {}), dict):
        assert bare(below.get("config", {})).keys() <= before["config"].keys()
    assert {key: each for key, each in below.items() if key != "config"} == {
        key: each for key, each in before.items() if key != "config"
    }


VERBS = [
    *("run", "status", "steer", "settings", "set", "watch_settings", "state", "period", "time_awake", "parameters"),
    *("kill", "channels", "show", "watch", "", "SET", None, 3),
]
FIELDS = ["verb", "names", "changes", "check", "origin", "action", "name", "channel", "ticks", "speed", "extra"]


@FEW
@given(some.sampled_from(VERBS), some.dictionaries(some.sampled_from(FIELDS), some_value | some_words), some.booleans())
def test_any_request_is_understood_or_refused(verb: object, fields: dict[str, Any], gateway: bool) -> None:
    line = json.dumps({**fields, "verb": verb}).encode()
    with suppress(RequestError):
        made = parsed(requests.to_gateway, line) if gateway else parsed(requests.to_supervisor, line)
        assert made.verb == verb
