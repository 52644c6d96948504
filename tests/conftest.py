"""What all tests share: a test that needs a program which is not here is left out by name, and the end says so."""

import shutil
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NoReturn

import pytest
from hypothesis import settings

settings.register_profile("suite", derandomize=True, deadline=None, max_examples=100)
settings.register_profile("long", deadline=None, max_examples=5000)
settings.load_profile("suite")  # the same examples each time; --hypothesis-profile=long looks for new ones

_LEFT_OUT = pytest.StashKey[dict[str, list[str]]]()

_PACKAGES = {
    "Xvfb": "xvfb",
    "cc": "gcc",
    "ip": "iproute2",
    "jar": "default-jdk-headless",
    "java": "default-jre",
    "javac": "default-jdk-headless",
    "mount": "mount",
    "umount": "mount",
    "unshare": "util-linux",
}
"""Program to Debian package, where the names differ."""


@pytest.fixture
def leave_out(request: pytest.FixtureRequest) -> Callable[[str], NoReturn]:
    """`leave_out("needs root")` skips the test; the reason is said at the end."""

    def skip(reason: str) -> NoReturn:
        request.config.stash.setdefault(_LEFT_OUT, {}).setdefault(reason, []).append(request.node.nodeid)
        pytest.skip(reason)

    return skip


@pytest.fixture
def needs(leave_out: Callable[[str], NoReturn]) -> Callable[..., None]:
    """`needs("Xvfb", "java")` skips the test if one of these programs is not on the path."""

    def check(*programs: str) -> None:
        missing = [program for program in programs if not shutil.which(program)]
        if missing:
            packages = " ".join(dict.fromkeys(_PACKAGES.get(program, program) for program in missing))
            leave_out(f"needs {', '.join(missing)}: apt install {packages}")

    return check


@pytest.fixture
def small_disk(
    tmp_path: Path, needs: Callable[..., None], leave_out: Callable[[str], NoReturn]
) -> Iterator[Callable[[int], Path]]:
    """`small_disk(8)` is a folder on a disk of its own of 8 MiB; only root can make one."""
    needs("mount", "umount")
    made: list[Path] = []

    def make(size_mib: int) -> Path:
        folder = tmp_path / f"disk{len(made)}"
        folder.mkdir()
        command = ["mount", "-t", "tmpfs", "-o", f"size={size_mib}m", "tmpfs", str(folder)]
        mounted = subprocess.run(command, capture_output=True, text=True, check=False)
        if mounted.returncode:
            leave_out("needs the right to mount a small disk: run the tests as root")
        made.append(folder)
        return folder

    yield make
    for folder in made:
        subprocess.run(["umount", "--lazy", str(folder)], check=True)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    """Lists what was left out and why, so that a green run does not hide it."""
    for reason, tests in sorted(config.stash.get(_LEFT_OUT, {}).items()):
        terminalreporter.section(f"left out, {reason}")
        for test in tests:
            terminalreporter.write_line(test)
