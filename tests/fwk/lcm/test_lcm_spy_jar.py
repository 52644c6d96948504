"""The jar of types for lcm-spy: its contents, its rebuilds, and the messages when it cannot be built."""

import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from fwk.cli.look.spy import spy as command
from fwk.lcm import spy_jar as spy
from fwk.lcm.type_registry import by_fingerprint

Needs = Callable[..., None]


def folder(path: Path, package: str, member: str = "double x_m") -> Path:
    path.mkdir(parents=True)
    (path / f"{package}.lcm").write_text(f"package {package};\nstruct thing_t {{ {member}; }}\n")
    return path


@pytest.mark.slow
def test_the_jar_is_built_once_for_each_content(tmp_path: Path, needs: Needs, monkeypatch: pytest.MonkeyPatch) -> None:
    needs("javac")
    types, cache = folder(tmp_path / "types", "first"), tmp_path / "cache"
    built = spy.build_jar([types], cache)
    with monkeypatch.context() as patch:
        patch.setenv("PATH", "")
        assert spy.build_jar([types], cache) == built
    (types / "first.lcm").write_text("package first;\nstruct thing_t { double y_m; }\n")
    assert spy.build_jar([types], cache) != built


def test_of_two_definitions_the_first_folders_is_used(tmp_path: Path, needs: Needs) -> None:
    needs("javac")
    first, second = folder(tmp_path / "a", "same", "double aaa"), folder(tmp_path / "b", "same", "double bbb")
    with zipfile.ZipFile(spy.build_jar([first, second], tmp_path / "cache")) as jar:
        assert b"aaa" in jar.read("same/thing_t.class")


def test_errors_of_the_java_compiler_are_explained(tmp_path: Path, needs: Needs) -> None:
    needs("javac")
    with pytest.raises(spy.SpyError) as caught:
        spy.build_jar([folder(tmp_path / "types", "bad", "boolean final")], tmp_path / "cache")
    text = str(caught.value)
    assert text.startswith("javac reports:\nbad/thing_t.java:")
    assert text.endswith("a member whose name is a Java keyword is the usual cause")
    assert list((tmp_path / "cache").iterdir()) == []


def test_missing_programs_display_and_types_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(spy.SpyError, match=r"no \.lcm files in "):
        spy.build_jar([tmp_path], tmp_path)
    types = folder(tmp_path / "types", "one")
    monkeypatch.setenv("PATH", "")
    with pytest.raises(spy.SpyError, match=r"no 'javac' on the path; .* apt install default-jdk-headless"):
        spy.build_jar([types], tmp_path / "cache")
    with pytest.raises(spy.SpyError, match=r"no 'java' on the path; .* apt install default-jre"):
        spy.start(tmp_path / "jar", "udpm://")
    (tmp_path / "java").touch(mode=0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("DISPLAY", raising=False)
    with pytest.raises(spy.SpyError, match="no display"):
        spy.start(tmp_path / "jar", "udpm://")


@pytest.mark.slow
def test_the_command_prints_a_class_path_with_every_type(
    tmp_path: Path, needs: Needs, monkeypatch: pytest.MonkeyPatch
) -> None:
    needs("javac")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    app = typer.Typer()
    app.command()(command)
    result = CliRunner().invoke(app, ["--jar"])
    assert result.exit_code == 0
    jar, lcm_jar = map(Path, result.stdout.strip().split(":"))
    assert lcm_jar == spy.lcm_jar()
    assert list((tmp_path / "fwk").iterdir()) == [jar]
    classes = set(zipfile.ZipFile(jar).namelist())
    types = [kind for kinds in by_fingerprint().values() for kind in kinds]
    names = {f"{kind.__module__.split('.')[-2]}/{kind.__name__}.class" for kind in types}
    assert {"core/header_t.class", "soccer/world_model_t.class"} < names <= classes
