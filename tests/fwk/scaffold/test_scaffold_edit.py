"""Edits of components: ports, settings and imports come and go, and everything else stays byte for byte."""

import ast
import json
import re
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fwk.cli.project.add import add
from fwk.cli.project.remove import remove
from fwk.scaffold.changes import ScaffoldError, write
from fwk.scaffold.interface import new_interface
from fwk.scaffold.new import new_project
from fwk.scaffold.ports import PortRequest, add_port, remove_port
from fwk.scaffold.project import Project
from fwk.scaffold.settings import SettingRequest, add_setting, python_value, remove_setting
from fwk.scaffold.source import Source, find_source
from fwk.scaffold.types import check_port_types, check_type

PLAIN = '''"""Tracks."""

from fwk import Component, Config, Writes
from lcmtypes.garden import pose_t


class TrackerConfig(Config):
    """Settings."""

    gain: float = 0.3
    """Weight."""


class Tracker(Component):
    """Tracks the ball."""

    stage = "think"

    config: TrackerConfig
    pose: Writes[pose_t]  # where it is

    def loop(self) -> None:
        self.pose.write()
'''
BALL = PortRequest("reads", "ball", ("garden.ball_t",))


def source_of(folder: Path, text: str, name: str = "") -> Source:
    path = folder / "tracker.py"
    path.write_text(text, newline="")
    return Source(path, name)


def added(folder: Path, text: str, *requests: PortRequest, name: str = "") -> str:
    source = source_of(folder, text, name)
    for request in requests:
        add_port(source, request)
    once = source.module.code
    for request in requests:
        add_port(source, request)
    assert source.module.code == once  # a second time changes nothing
    ast.parse(once)
    return once


def edited(source: Source, request: PortRequest | SettingRequest) -> None:
    if isinstance(request, PortRequest):
        add_port(source, request)
    else:
        add_setting(source, request)


def difference(before: str, after: str) -> tuple[list[str], list[str]]:
    """Returns the lines that are gone and those that are new."""
    old, new = before.splitlines(), after.splitlines()
    return [line for line in old if line not in new], [line for line in new if line not in old]


def test_port_joins_its_kind_and_its_imports(tmp_path: Path) -> None:
    after = added(tmp_path, PLAIN, BALL, PortRequest("serves", "kick", ("garden.kick_t", "garden.done_t")))
    assert difference(PLAIN, after) == (
        ["from fwk import Component, Config, Writes", "from lcmtypes.garden import pose_t"],
        [
            "from fwk import Component, Config, Reads, Serves, Writes",
            "from lcmtypes.garden import ball_t, done_t, kick_t, pose_t",
            "    ball: Reads[ball_t]",
            "    kick: Serves[kick_t, done_t]",
        ],
    )
    body = after.partition("    config: TrackerConfig\n")[2]
    assert body.startswith("    ball: Reads[ball_t]\n    pose: Writes[pose_t]  # where it is\n    kick: ")


@pytest.mark.parametrize(
    ("request_", "line"),
    [
        (PortRequest("reads", "ball", ("garden.ball_t",), each=True), "ball: Each[Reads[ball_t]]"),
        (PortRequest("reads", "joy", ("garden.joy_t",), channel="/JOY"), 'joy: Reads[joy_t] = channel("/JOY")'),
        (PortRequest("reads", "b", ("garden.b_t",), history=9), "b: Reads[b_t] = channel(history=9)"),
        (PortRequest("calls", "k", ("x.k_t",), True, "*/k"), 'k: Each[Calls[k_t]] = channel("*/k")'),
    ],
)
def test_forms_of_ports_come_and_go(tmp_path: Path, request_: PortRequest, line: str) -> None:
    after = added(tmp_path, PLAIN, request_)
    assert f"\n    {line}\n" in after
    source = source_of(tmp_path, after)
    assert remove_port(source, request_.kind, request_.name) == []
    assert source.module.code == PLAIN


@pytest.mark.parametrize(
    ("head", "base", "line"),
    [
        ("import fwk\nimport lcmtypes.garden\n", "fwk.Component", "ball: fwk.Reads[lcmtypes.garden.ball_t]"),
        ("import fwk as f\nimport lcmtypes.garden as g\n", "f.Component", "ball: f.Reads[g.ball_t]"),
        ("from fwk import Component as C, Reads as R\nfrom lcmtypes import garden\n", "C", "ball: R[garden.ball_t]"),
        ("from fwk import Component\nfrom lcmtypes.other import ball_t\n", "Component", "ball: Reads[garden_ball_t]"),
        ("from fwk import (\n    Component,  # base\n)\n", "Component", "ball: Reads[ball_t]"),
        ("from fwk import *\nfrom fwk import Component\n", "Component", "ball: Reads[ball_t]"),
        ("try:\n    from fwk import Component\nexcept ImportError:\n    raise\n", "Component", "ball: Reads[ball_t]"),
    ],
)
def test_aliases_and_forms_of_imports_are_used(tmp_path: Path, head: str, base: str, line: str) -> None:
    after = added(tmp_path, f'{head}\n\nclass Tracker({base}):\n    stage = "think"\n', BALL)
    assert f'    stage = "think"\n\n    {line}\n' in after


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('class A(Component): stage = "x"\n', 'class A(Component):\n    stage = "x"\n\n    ball: Reads[ball_t]\n'),
        ("class A(Component): pass\n", "class A(Component):\n    ball: Reads[ball_t]\n"),
        ("class A(Component):\n\t...\n", "class A(Component):\n\tball: Reads[ball_t]\n"),
        (
            "@known\n@o(1)\nclass A( Component ) :\n  '''T'''\n  a:Reads[ x_t ];b: int=3 # c\n\n\n  def f(self): ...\n",
            "@known\n@o(1)\nclass A( Component ) :\n  '''T'''\n  a:Reads[ x_t ];b: int=3 # c\n"
            "  ball: Reads[ball_t]\n\n\n  def f(self): ...\n",
        ),
        (
            "class A(Component):\r\n    x: int = 1\r\n",
            "class A(Component):\r\n    x: int = 1\r\n    ball: Reads[ball_t]\r\n",
        ),
    ],
)
def test_odd_formatting_is_kept(tmp_path: Path, text: str, expected: str) -> None:
    newline = "\r\n" if "\r" in text else "\n"
    head = f"from fwk import Component, Reads{newline}from lcmtypes.garden import ball_t{newline}{newline}"
    assert added(tmp_path, head + text, BALL) == head + expected


def test_one_class_of_several_is_edited(tmp_path: Path) -> None:
    text = PLAIN + '\n\nclass Other(Tracker):\n    """Another."""\n\n    stage = "act"\n'
    with pytest.raises(ScaffoldError, match=r"several component classes; name one: tracker:Tracker or tracker:Other"):
        source_of(tmp_path, text)
    after = added(tmp_path, text, BALL, name="Other")
    assert after.endswith('    stage = "act"\n\n    ball: Reads[ball_t]\n')
    with pytest.raises(ScaffoldError, match=r"has no component class 'Othr'; did you mean 'Other'\?"):
        source_of(tmp_path, text, "Othr")


def test_long_imports_are_wrapped(tmp_path: Path) -> None:
    names = [f"quite_a_long_name_{number}_t" for number in range(4)]
    text = PLAIN.replace("import pose_t", f"import pose_t, {', '.join(names)}")
    after = added(tmp_path, text, PortRequest("reads", "ball", ("garden.ball_of_the_game_t",)))
    assert "from lcmtypes.garden import (\n    ball_of_the_game_t,\n    pose_t,\n" in after
    assert f"    {names[-1]},\n)\n" in after


def test_comments_and_neighbours_survive_a_removal(tmp_path: Path) -> None:
    text = PLAIN.replace(
        "    config:", "    # what it reads\n    ball: Reads[ball_t]; near: int = 3\n\n    # settings\n    config:"
    )
    text = text.replace("Config, W", "Config, Reads, W").replace("pose_t\n", "ball_t, pose_t\n", 1)
    source = source_of(tmp_path, text)
    assert remove_port(source, "reads", "ball") == []
    assert difference(text, source.module.code)[1] == [
        "from fwk import Component, Config, Writes",
        "from lcmtypes.garden import pose_t",
        "    near: int = 3",
    ]
    source = source_of(tmp_path, PLAIN.replace("    pose:", "    # kept\n    pose:"))
    (place,) = remove_port(source, "writes", "pose")
    assert place.endswith("tracker.py:22")
    assert "    config: TrackerConfig\n    # kept\n\n    def loop" in source.module.code


def test_imports_that_something_else_uses_stay(tmp_path: Path) -> None:
    text = PLAIN.replace("self.pose.write()", "self.pose.value = pose_t()") + '\n__all__ = ["Writes"]\n'
    source = source_of(tmp_path, text)
    (place,) = remove_port(source, "writes", "pose")
    assert place.endswith("tracker.py:22")
    assert difference(text, source.module.code) == (["    pose: Writes[pose_t]  # where it is"], [])
    assert remove_port(source, "writes", "pose") == []


def test_settings_come_and_go_with_their_docstrings(tmp_path: Path) -> None:
    source = source_of(tmp_path, PLAIN)
    for _ in range(2):
        add_setting(source, SettingRequest("near_m", "float", "1.0", "Distance below which it is near."))
    assert difference(PLAIN, source.module.code) == (
        [],
        ["    near_m: float = 1.0", '    """Distance below which it is near."""'],
    )
    assert remove_setting(source, "near_m") == []
    assert source.module.code == PLAIN
    assert remove_setting(source, "gain") == []
    assert '"""Weight."""' not in source.module.code
    ast.parse(source.module.code)


@pytest.mark.parametrize(
    "lines", ['    stage = "think"\n', '    stage = "think"\n\n    ball: Reads[ball_t]\n\n    def loop(self): ...\n']
)
def test_the_last_setting_goes_with_the_class_made_for_it(tmp_path: Path, lines: str) -> None:
    text = f"from fwk import Component, Reads\n\n\nclass Tracker(Component):\n{lines}"
    source = source_of(tmp_path, text)
    requests = [SettingRequest("gain", "float", "0.3", "Weight."), SettingRequest("near_m", "float", "1.0")]
    for request in requests:
        add_setting(source, request)
    for request in requests:
        assert remove_setting(source, request.name) == []
    assert source.module.code == text


def test_a_class_of_settings_that_others_name_stays(tmp_path: Path) -> None:
    source = source_of(tmp_path, "from fwk import Component\n\n\nclass Tracker(Component):\n    pass\n")
    add_setting(source, SettingRequest("gain", "float", "0.3"))
    source = source_of(tmp_path, f"{source.module.code}\n\nDEFAULT = TrackerConfig()\n")
    remove_setting(source, "gain")
    assert "class TrackerConfig(Config):" in source.module.code
    assert "config: TrackerConfig" in source.module.code


def test_a_class_of_settings_is_made_once(tmp_path: Path) -> None:
    text = 'from fwk import Component\n\n\nclass Tracker(Component):\n    stage = "think"\n'
    source = source_of(tmp_path, text)
    for _ in range(2):
        add_setting(source, SettingRequest("gain", "float", "0.3"))
    assert source.module.code == (
        "from fwk import Component, Config\n\n\nclass TrackerConfig(Config):\n"
        '    """Settings of Tracker."""\n\n    gain: float = 0.3\n\n\n'
        'class Tracker(Component):\n    stage = "think"\n\n    config: TrackerConfig\n'
    )


@pytest.mark.parametrize(
    ("kind", "text", "value"),
    [("float", "3", "3.0"), ("int", "7", "7"), ("bool", "true", "True"), ("str", "a b", '"a b"')],
)
def test_defaults_are_written_as_python(kind: str, text: str, value: str) -> None:
    assert python_value(kind, text) == value


def test_mistakes_name_file_and_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)

    def refused(text: str, expected: str, request: PortRequest | SettingRequest = BALL) -> None:
        with pytest.raises(ScaffoldError, match=re.escape(expected)):
            edited(source_of(tmp_path, text), request)

    refused("class A(:\n", "tracker.py:1: not valid Python")
    refused("class A: ...\n", "tracker.py has no class derived from Component")
    refused(PLAIN.replace("pose: W", "ball: W"), "tracker.py:20: Tracker has 'ball: Writes[pose_t]' already")
    refused(PLAIN.replace("def loop", "def ball"), "tracker.py:22: Tracker has a 'ball' already")
    refused(PLAIN.replace('stage = "think"', "ball = 3"), "tracker.py:17: Tracker has a 'ball' already")
    refused(PLAIN, "'a b' is not the name of a port", PortRequest("reads", "a b", ("garden.ball_t",)))
    refused(PLAIN, "is not valid Python; choose a name that", PortRequest("reads", "class", ("garden.ball_t",)))
    refused(PLAIN, "every component has 'finalize'", PortRequest("reads", "finalize", ("garden.ball_t",)))
    refused(PLAIN, "tracker.py:10: TrackerConfig has 'gain: float = 0.3' already", SettingRequest("gain", "int", "3"))
    there = PLAIN.replace("class TrackerConfig", "class Others")
    refused(there, "tracker.py:19: the settings of Tracker, TrackerConfig, are not", SettingRequest("x", "int", "3"))
    with pytest.raises(
        ScaffoldError, match=re.escape("tracker.py:20: 'pose' of Tracker is pose: Writes[pose_t], not reads")
    ):
        remove_port(source_of(tmp_path, PLAIN), "reads", "pose")
    for kind, text in (("float", "x"), ("bool", "1"), ("list", "1")):
        with pytest.raises(ScaffoldError):
            python_value(kind, text)


def test_types_that_a_port_cannot_have_are_refused(tmp_path: Path) -> None:
    write(new_project("garden", tmp_path))
    project = Project(tmp_path)
    write([new_interface(project, "garden.mow", ["speed_m_s:double"], "request")])
    write([new_interface(project, "garden.mown", ["area_m2:double"], "reply")])
    types = ["mow_t", "mown_t"]
    for kind in ("serves", "calls"):
        assert check_port_types(project, kind, types) == ("garden.mow_t", "garden.mown_t")
        for wrong, role in ((["distance_t"], "request"), (["mow_t", "distance_t"], "reply")):
            right = f"make one with: fwk new interface garden.NAME FIELD:TYPE --kind {role}"
            with pytest.raises(ScaffoldError, match=f"garden.distance_t is not a {role}: .*{re.escape(right)}"):
                check_port_types(project, kind, wrong)
    with pytest.raises(ScaffoldError, match="'mow_t,mown_t' are 2 types; reads takes one message type"):
        check_port_types(project, "reads", types)
    with pytest.raises(ScaffoldError, match="are 3 types; calls takes a request, and a reply if it has one"):
        check_port_types(project, "calls", [*types, "mow_t"])


def test_types_are_found_by_their_names(tmp_path: Path) -> None:
    write(new_project("garden", tmp_path))
    project = Project(tmp_path)
    assert check_type(project, "distance_t") == check_type(project, "garden.distance_t") == "garden.distance_t"
    with pytest.raises(ScaffoldError, match=r"no message type 'garden.distanc_t'; did you mean 'garden.distance_t'\?"):
        check_type(project, "garden.distanc_t")
    with pytest.raises(ScaffoldError, match=r"no component 'sensr' in .*; did you mean 'sensor'\?"):
        find_source(project, "sensr")


def test_commands_print_the_difference_and_do_it_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def typed(app: object, *words: str, code: int = 0) -> str:
        result = CliRunner().invoke(app, words)  # type: ignore[arg-type]  # a typer application
        assert result.exit_code == code, result.output
        return result.output

    write(new_project("garden", tmp_path))
    monkeypatch.chdir(tmp_path)
    (sensor,) = tmp_path.glob("*/sensor.py")
    before = sensor.read_bytes()
    words = ("reads", "sensor", "ball:garden.distance_t")
    assert "+    ball: Reads[distance_t]" in typed(add, *words, "--dry-run")
    assert sensor.read_bytes() == before
    assert json.loads(typed(add, *words, "--json"))["diff"].count("\n+") == 3
    assert "nothing to do" in typed(add, *words)
    assert "-    ball: Reads[distance_t]" in typed(remove, *words[:2], "ball")
    assert "nothing to do" in typed(remove, *words[:2], "ball")
    assert sensor.read_bytes() == before
    assert "+    rate: int = 3" in typed(add, "setting", "sensor", "rate:int=3", "--meaning", "A number.")
    assert "still used: " in typed(remove, "setting", "sensor", "noise_m")
    assert "is not a port; write NAME:TYPE" in typed(add, "writes", "sensor", "ball", code=2)
    assert "is not a setting; write NAME:TYPE=VALUE" in typed(add, "setting", "sensor", "x:int", code=2)
    monkeypatch.setitem(sys.modules, "fwk.scaffold.source", None)  # a library that is missing, or broken
    assert "pip install 'fwk[new]'" in typed(add, *words, code=2)
    for module, kind in (("ports", "reads"), ("settings", "setting")):
        monkeypatch.setitem(sys.modules, f"fwk.scaffold.{module}", None)  # they import the missing library
        assert "pip install 'fwk[new]'" in typed(remove, kind, "sensor", "ball", code=2)
