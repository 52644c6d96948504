"""The wheel in an empty environment far from any checkout: complete, and sufficient to run a user's systems."""

import email
import os
import shlex
import shutil
import subprocess
import sys
import venv
import zipfile
from collections.abc import Callable
from importlib.metadata import distribution
from pathlib import Path

import pytest
from packaging.requirements import Requirement

from tests.fwk.cli.cli_processes import PROCS, write_files
from tests.harness.pages import Page, shows
from tests.harness.runs import PortBlock

ROOT = Path(__file__).parents[2]
INSTALL_TIMEOUT_S = 280.0
LEFTOVER = "procs/left_over.py"
Run = Callable[..., "subprocess.CompletedProcess[str]"]

pytestmark = [pytest.mark.slow, pytest.mark.timeout(900)]  # generous for a busy machine


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel of a clean copy, without generated types, but with leftovers of an earlier build."""
    folder = tmp_path_factory.mktemp("wheel")
    copy = folder / "source"
    for name in ("fwk", "procs", "launch"):
        shutil.copytree(ROOT / name, copy / name, ignore=shutil.ignore_patterns("__pycache__"))
    for file in (*ROOT.glob("lcmtypes/*.lcm"), ROOT / "pyproject.toml", ROOT / "README.md", ROOT / "LICENSE"):
        write_files(copy, {str(file.relative_to(ROOT)): file.read_text()})
    write_files(copy, {f"build/lib/{LEFTOVER}": ""})
    build = [sys.executable, "-m", "pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", str(folder), str(copy)]
    subprocess.run(build, check=True, timeout=INSTALL_TIMEOUT_S)
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Run:
    """Runs commands of a fresh environment with the wheel, its dependencies, pytest and mypy, in a user's folder."""
    folder = tmp_path_factory.mktemp("installed")
    environment = folder / "env"
    venv.create(environment, symlinks=True)
    binaries = environment / "bin"
    pip = [sys.executable, "-m", "pip", "--python", str(binaries / "python"), "--disable-pip-version-check"]
    install = [*pip, "install", "--quiet", "--no-deps", "--no-compile", str(wheel)]
    subprocess.run(install, check=True, timeout=INSTALL_TIMEOUT_S)
    link_libraries(wheel, environment, "pytest", "mypy")
    user = folder / "user"
    write_files(user, PROCS)
    variables = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    variables |= {"HOME": str(user), "PATH": f"{binaries}{os.pathsep}/usr/bin:/bin"}

    def run(*command: str, cwd: Path = user) -> "subprocess.CompletedProcess[str]":
        return subprocess.run(
            [str(binaries / command[0]), *command[1:]],
            cwd=cwd,
            env=variables,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=INSTALL_TIMEOUT_S,
            check=False,
        )

    return run


def link_libraries(wheel: Path, environment: Path, *programs: str) -> None:
    """Links into an environment what the wheel's metadata and these programs require, and nothing else.

    They are the libraries of this environment, so pip need not install them anew.
    """
    (site,) = environment.glob("lib/python*/site-packages")
    name = next(name for name in zipfile.ZipFile(wheel).namelist() if name.endswith(".dist-info/METADATA"))
    metadata = email.message_from_bytes(zipfile.ZipFile(wheel).read(name))
    needed, known = [*metadata.get_all("Requires-Dist", []), *programs], set[str]()
    while needed:
        requirement = Requirement(needed.pop())
        if requirement.name in known or (requirement.marker and not requirement.marker.evaluate({"extra": ""})):
            continue
        known.add(requirement.name)
        library = distribution(requirement.name)
        assert requirement.specifier.contains(library.version), f"{requirement}, but there is {library.version}"
        needed += library.requires or []
        for top in {file.parts[0] for file in library.files or []} - {"..", "__pycache__"}:
            if not (site / top).exists():
                (site / top).symlink_to(str(library.locate_file(top)))
        for script in library.entry_points.select(group="console_scripts") if library.name in programs else ():
            program = environment / "bin" / script.name
            program.write_text(
                f"#!{environment}/bin/python\nfrom {script.module} import {script.attr}\n{script.attr}()\n"
            )
            program.chmod(0o755)


def test_the_wheel_holds_code_types_and_launch_files(wheel: Path) -> None:
    names = set(zipfile.ZipFile(wheel).namelist())
    wanted = {
        "fwk/py.typed",
        "fwk/cli/launch.py",
        "procs/simulation/simulator.py",
        "procs/simulation/physics/world.py",
        "lcmtypes/core.lcm",
        "lcmtypes/core/header_t.py",
        "lcmtypes/core/header_t.pyi",
        "lcmtypes/soccer/__init__.py",
        "launch/soccer.yaml",
        "fwk/scaffold/native/fwk.h",
        "fwk/scaffold/templates/c/native/Makefile",
        "fwk/scaffold/templates/project/gitignore",
        "fwk/scaffold/templates/stages/lcmtypes/thing.lcm",
        "fwk/scaffold/templates/stages/things/thing.py",
    }
    assert wanted <= names
    assert LEFTOVER not in names
    assert not [name for name in names if name.startswith(("tests/", "tools/", "docs/", "build/"))]
    assert not {"lcmtypes/__init__.py", "procs/__init__.py"} & names  # namespace packages: users' packages join them


@pytest.mark.parametrize("command", ["fwk", "fwk-launch"])
def test_the_commands_explain_themselves(installed: Run, command: str) -> None:
    result = installed(command, "--help")
    assert result.returncode == 0, result.stdout
    assert f"Usage: {command} " in result.stdout


def test_the_installed_launch_files_are_found(installed: Run) -> None:
    result = installed("fwk", "check", "soccer.yaml")
    assert result.returncode == 0, result.stdout
    assert "components" in result.stdout


def test_user_components_and_types_join_the_installed_ones(installed: Run, ports: PortBlock) -> None:
    arguments = ["--ticks", "20", "--speed", "max", "--bus-port", str(ports.bus)]
    result = installed("fwk-launch", "cards.yaml", "--record", "mine.log", *arguments)
    assert result.returncode == 0, result.stdout
    assert "20 ticks done" in result.stdout
    info = installed("fwk", "log-info", "mine.log")
    assert "cards.count_t" in info.stdout, info.stdout


def test_the_installed_robots_play(installed: Run, ports: PortBlock) -> None:
    result = installed(
        "fwk-launch", "one-robot.yaml", "--ticks", "5", "--speed", "max", "--bus-port", str(ports.bus), "--no-record"
    )
    assert result.returncode == 0, result.stdout
    assert "CYAN 0 : 0 MAGENTA" in result.stdout
    assert "one-robot: 5 ticks done" in result.stdout


def test_the_tutorial_works_word_for_word(installed: Run, ports: PortBlock, tmp_path: Path) -> None:
    page = Page("first-component.md")
    assert (len(page.files), len(page.steps)) == (5, 8)
    write_files(tmp_path, page.files)
    for command, lines in page.steps:
        words = shlex.split(command)
        if words[0] == "fwk-launch":  # the only word added, because other runs use this machine
            words += ["--bus-port", str(ports.bus)]
        result = installed(*words, cwd=tmp_path)
        assert result.returncode == 0, f"{command}\n{result.stdout}"
        for line in lines:
            assert shows(result.stdout, line), f"{command}\ndoes not show: {line}\nbut: {result.stdout}"
