"""Made projects, components, message types and launch files; names and files that are refused."""

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fwk.cli.project.new import new
from fwk.scaffold.changes import Change, ScaffoldError, refuse_overwriting, write
from fwk.scaffold.interface import new_interface
from fwk.scaffold.new import new_component, new_launch, new_project
from fwk.scaffold.project import Project, project_at
from fwk.scaffold.templates import kinds


@pytest.fixture
def project(tmp_path: Path) -> Project:
    """A new project, without generated classes."""
    write(new_project("garden", tmp_path / "garden"))
    return Project(tmp_path / "garden")


def contents(folder: Path) -> dict[str, str]:
    return {str(path.relative_to(folder)): path.read_text() for path in folder.rglob("*") if path.is_file()}


def test_no_placeholder_is_left_in_any_kind(project: Project) -> None:
    for kind in kinds():
        write(new_component(project, f"my_{kind}", kind))
    for path, text in contents(project.root).items():
        assert not re.search(r"\b(test_)?things?\b|Thing[A-Z]|\bthing_", path + text), path


def test_component_joins_launch_file_and_readme(project: Project) -> None:
    (project.root / "launch/garden.yaml").write_text("components:  # all\n    bed/tap: {use: x} # wet\nperiod_s: 0.1\n")
    write(new_component(project, "grip_driver", "driver"))
    assert (project.root / "launch/garden.yaml").read_text() == (
        "components:  # all\n    bed/tap: {use: x} # wet\n"
        f"    bed/grip_driver: {{use: {project.package}.grip_driver}}\nperiod_s: 0.1\n"
        "outside:\n  bed/grip_driver_command: grip_driver.grip_driver_command_t\n"
    )
    lines = (project.root / "README.md").read_text().splitlines()
    assert lines[-1].startswith(f"| `{project.package}.grip_driver` | Passes commands")
    assert new_component(project, "grip_driver", "driver", namespace="bed")[-1].path.name == "garden.yaml"


def test_readme_without_the_table_stays_as_it_is(project: Project) -> None:
    (project.root / "README.md").write_text("# mine\n")
    write(new_component(project, "tap"))
    assert (project.root / "README.md").read_text() == "# mine\n"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("Ball-Tracker", "'Ball-Tracker' is not the name of a component; write lower-case words, such as ball_tracker"),
        ("7", "such as ball_tracker"),
        ("Türöffner", "such as tueroeffner"),
        ("double", "'double' is a word of C++ or Java, where it cannot name message types"),
        ("def_", "such as def_part"),
        ("config", "components use the name 'config' themselves; choose another one, such as config_part"),
        ("loop", "components use the name 'loop'"),
        ("writes", "components use the name 'writes'"),
        ("while", "'while' is a keyword of Python"),
        ("a" * 25, "has 25 characters; the name of a component has at most 24"),
        ("core", "'core' is a package of installed message types"),
    ],
)
def test_impossible_names_are_refused(project: Project, name: str, text: str) -> None:
    with pytest.raises(ScaffoldError, match=re.escape(text)):
        new_component(project, name)


def test_a_module_that_would_hide_another_is_refused(project: Project, monkeypatch: pytest.MonkeyPatch) -> None:
    installed = project.root.parent / "installed"
    (installed / project.package / "vision").mkdir(parents=True)
    monkeypatch.setattr("fwk.scaffold.project.INSTALLED", installed)
    with pytest.raises(ScaffoldError, match="would hide the installed"):
        new_component(project, "vision")


@pytest.mark.parametrize(
    ("request_", "text"),
    [
        (lambda found: new_component(found, "tap", "dance"), "no kind of component 'dance'; there are aspect,"),
        (lambda found: new_component(found, "tap", launch="gardn"), "no launch file 'gardn'"),
        (lambda found: new_launch(found, "trial", ["sensr"]), "did you mean 'sensor'?"),
        (lambda found: new_launch(found, "trial", namespace="a/b"), "'a/b' is not a namespace"),
        (lambda found: new_interface(found, "ball", ["x"]), "'x' is not a field; write NAME:TYPE"),
        (lambda found: new_interface(found, "ball", ["n:int"]), "LCM has no type 'int'; write n:int64_t"),
        (lambda found: new_interface(found, "ball", ["x:doubel"]), "did you mean 'double'?"),
        (lambda found: new_interface(found, "ball", ["xs:double[n]"]), "lcmtypes/ball.lcm:5: the size of 'xs' is 'n'"),
        (lambda found: new_interface(found, "garden.distance", []), "struct garden.distance_t is defined already"),
        (lambda found: new_interface(found, "ball", [], "letter"), "no kind of message type 'letter'"),
    ],
)
def test_mistakes_are_explained(project: Project, request_: Callable[[Project], object], text: str) -> None:
    with pytest.raises(ScaffoldError, match=re.escape(text)):
        request_(project)


def test_an_entry_of_that_name_is_refused(project: Project) -> None:
    (project.root / "launch/garden.yaml").write_text("components: {robot/tap: {use: other}}\n")
    with pytest.raises(ScaffoldError, match="components has 'robot/tap' already"):
        new_component(project, "tap")


def test_several_launch_files_need_a_choice(project: Project) -> None:
    write(new_launch(project, "trial", ["estimator"]))
    with pytest.raises(
        ScaffoldError, match=r"several launch files: garden\.yaml, trial\.yaml; choose one with --launch"
    ):
        new_component(project, "tap")
    write(new_component(project, "tap", launch="trial"))
    assert "robot/tap" in (project.root / "launch/trial.yaml").read_text()


def test_a_folder_without_project_is_named(tmp_path: Path) -> None:
    with pytest.raises(ScaffoldError, match="is not in a project: no folder 'launch' here or above"):
        project_at(tmp_path)


def test_files_that_exist_are_named_and_kept(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_text("mine")
    refuse_overwriting([Change(path, "mine"), Change(tmp_path / "b", "")])
    with pytest.raises(ScaffoldError, match="a: exists already; overwrite with --force"):
        refuse_overwriting([Change(path, "yours")])


def test_interface_is_added_to_its_file(project: Project) -> None:
    change = new_interface(project, "garden.water_t", ["litres:double", "n:int32_t", "xs:float[n][2]"], "request")
    assert change.before is not None
    assert change.after.removeprefix(change.before) == (
        "\nstruct water_t {\n"
        "  core.header_t  header;   // tick, sequence number, time and writer; written by the framework\n"
        "  core.command_t command;  // written by the framework, as the header is\n"
        "  double         litres;\n  int32_t        n;\n  float          xs[n][2];\n}\n"
    )


def test_commands_show_write_and_refuse(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def typed(line: str, code: int = 0) -> str:
        result = CliRunner().invoke(new, line.split())
        assert result.exit_code == code, result.output
        return result.output

    monkeypatch.chdir(tmp_path)
    assert "would be made: garden/launch/garden.yaml" in typed("project garden --dry-run")
    assert not (tmp_path / "garden").exists()
    assert "next: cd garden && fwk-launch garden.yaml" in typed("project garden")
    assert "nothing to do" in typed("project garden")
    monkeypatch.chdir(tmp_path / "garden/tests")
    assert "error: NAME is missing" in typed("component", 2)
    rows = json.loads(typed("component tap --json"))["files"]
    assert [row["change"] for row in rows] == ["made"] * 3 + ["changed"] * 2
    test = tmp_path / "garden/tests/test_tap.py"
    test.write_text("")
    assert "exists already; overwrite with --force" in typed("component tap", 2)
    assert "made: " in typed("component tap --force")
    assert test.read_text()
    assert "next: from lcmtypes.garden import rain_t" in typed("interface garden.rain mm:double")
    assert (tmp_path / "garden/lcmtypes/garden/rain_t.py").exists()
    assert "launch/trial.yaml" in typed("launch trial estimator")
