"""Fixtures that all tests share: ports, and skips for programs and rights that the machine lacks."""

import gc
import itertools
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Generator, Iterator
from pathlib import Path
from typing import NoReturn

from fwk.model.linear_algebra import limit_threads

limit_threads()  # before numpy: components in the test process use the same BLAS kernel as in a run

import pytest  # noqa: E402
from hypothesis import settings  # noqa: E402
from hypothesis.internal.conjecture import providers  # noqa: E402
from hypothesis.internal.constants_ast import Constants  # noqa: E402

from tests.harness.runs import PortBlock  # noqa: E402

settings.register_profile("suite", derandomize=True, deadline=None, max_examples=100)
settings.register_profile("fast", derandomize=True, deadline=None, max_examples=20)
settings.register_profile("long", deadline=None, max_examples=5000)
settings.load_profile("suite")  # the same examples each time; --hypothesis-profile=long searches for new ones
# Constants of imported modules would make the examples depend on the tests that ran before in the same process.
providers._get_local_constants = Constants

_PACKAGES = {
    "Xvfb": "xvfb",
    "cc": "gcc",
    "ip": "iproute2",
    "java": "default-jre",
    "javac": "default-jdk-headless",
    "mount": "mount",
    "umount": "mount",
    "unshare": "util-linux",
}
"""Program to Debian package, where the names differ."""
_BROWSER_TESTS = "tests/system/web/"
"""Folder of the tests that share a run and a browser: each worker that executes some of them would start both."""
_OBJECTS = 20_000
"""New objects from which the garbage collector looks for rings of them; with the usual 700 it takes 6 % of the time."""


class _Imported:
    """Names of the imported modules, listed anew only once their number or the newest of them is another."""

    def __init__(self) -> None:
        self._mark = 0, ""
        self._names: frozenset[str] = frozenset()

    def names(self) -> frozenset[str]:
        """Returns the names; they are thousands, and most tests import nothing."""
        mark = len(sys.modules), next(reversed(sys.modules))
        if mark != self._mark:
            self._mark, self._names = mark, frozenset(sys.modules)
        return self._names


_IMPORTED = _Imported()
_FOLDERS = itertools.count()
"""Numbers of the folders of tests."""


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Puts the tests that share a browser first, for one worker; then files with slow tests, short tests at the end."""
    slow = {item.path for item in items if item.get_closest_marker("slow")}
    items.sort(key=lambda item: (not item.nodeid.startswith(_BROWSER_TESTS), item.path not in slow))


@pytest.fixture(autouse=True)
def _same_environment() -> Iterator[None]:
    """Fails a test that leaves variables behind: commands of later tests would start with them."""
    before = dict(os.environ)
    yield
    changed = {name for name, _ in before.items() ^ os.environ.items()}
    left = changed - {"PYTEST_CURRENT_TEST", "LD_LIBRARY_PATH"}  # OpenCV extends its path when it is first imported
    for name in left:
        os.environ.pop(name, None)
    os.environ.update({name: before[name] for name in changed & before.keys()})
    assert not left, f"the test changed variables of the environment: {', '.join(sorted(left))}"


@pytest.fixture(autouse=True)
def _own_modules(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Forgets the modules of a test's own folder: those of a later test may have the same names."""
    path, modules = list(sys.path), _IMPORTED.names()
    yield
    sys.path[:] = path
    base = str(tmp_path_factory.getbasetemp())
    for name in _IMPORTED.names() - modules:
        module = sys.modules[name]
        places = [getattr(module, "__file__", None) or "", *getattr(module, "__path__", [])]
        if any(place.startswith(base) for place in places):
            del sys.modules[name]


@pytest.fixture
def tmp_path(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An empty folder of the test, numbered without a look at all folders and a link to the newest, as pytest does."""
    name = re.sub(r"\W", "_", request.node.name)[:30]
    return tmp_path_factory.mktemp(f"{name}{next(_FOLDERS)}", numbered=False)


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Spares the garbage collector the imported modules and the collected tests, which all stay to the end."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.set_threshold(_OBJECTS)
        gc.enable()


@pytest.fixture
def ports() -> Iterator[PortBlock]:
    """Ports that no other test on this machine uses at the same time, in any suite or worker."""
    made = PortBlock()
    yield made
    made.release()


@pytest.fixture(scope="session")
def leave_out() -> Callable[[str], NoReturn]:
    """`leave_out("needs root")` skips the test; the end of the test run lists the reason.

    This is the only way to skip. A test is skipped only for something that the machine lacks, never because the
    test fails.
    """
    return pytest.skip


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
    """`small_disk(8)` is a folder on a separate disk of 8 MiB; only root can create one."""
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


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Lists the skipped tests with their reasons, so that a green run does not hide them.

    Uses the reports, which arrive from all workers.
    """
    left_out: dict[str, list[str]] = {}
    for report in terminalreporter.stats.get("skipped", []):
        left_out.setdefault(report.longrepr[2].removeprefix("Skipped: "), []).append(report.nodeid)
    for reason, tests in sorted(left_out.items()):
        terminalreporter.section(f"left out, {reason}")
        for test in sorted(tests):
            terminalreporter.write_line(test)
