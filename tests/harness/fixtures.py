"""Fixtures for tests that start real runs; a conftest.py imports them by name."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from fwk.lcm.type_registry import use_types_of
from tests.harness.components import sources
from tests.harness.runs import Launched, PortBlock, write_files
from tests.programs.orchestra import orchestra

Launch = Callable[..., Launched]
GONE_S = 5.0


@pytest.fixture
def launch(tmp_path: Path, ports: PortBlock) -> Iterator[Launch]:
    """Starts runs, `launch("launch/x.yaml", "--ticks", "5", env={}, folder=...)`, and kills the rest at the end.

    Fails if a run that ended by itself, or was killed, has left processes behind.
    """
    launched: list[Launched] = []

    def start(
        *arguments: str, env: dict[str, str] | None = None, folder: Path = tmp_path, wrapper: tuple[str, ...] = ()
    ) -> Launched:
        launched.append(Launched(folder, ports, arguments, env or {}, wrapper))
        return launched[-1]

    yield start
    orphans = [
        each.processes() for each in launched if each.process.poll() is not None and not each.gone_within(GONE_S)
    ]
    for each in launched:
        each.end()
    assert orphans == []


@pytest.fixture
def folder(tmp_path: Path, ports: PortBlock) -> Path:
    """A user's folder with the orchestra."""
    write_files(tmp_path, orchestra(ports.public_url))
    return tmp_path


@pytest.fixture(scope="session", autouse=True)
def orchestra_types(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Makes the orchestra's types known to the test process, which reads recordings."""
    folder = tmp_path_factory.mktemp("types")
    write_files(folder, sources("lcmtypes/play.lcm"))
    use_types_of(folder)
