"""What the system tests share: a launcher that cleans up."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from fwk.lcm.type_registry import use_types_of
from tests.system.system_orchestra import TYPES, orchestra
from tests.system.system_runs import Launched, PortBlock, write_files

Launch = Callable[..., Launched]
GONE_S = 5.0


@pytest.fixture
def launch(tmp_path: Path, ports: PortBlock) -> Iterator[Launch]:
    """`launch("launch/x.yaml", "--ticks", "5", env={}, folder=...)` starts a run; what still runs at the end is killed.

    A run that ended by itself, or was killed, has to have left no process, and with that no shared memory.
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
def _types(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Makes the orchestra's types known to this process, for looking into recordings."""
    folder = tmp_path_factory.mktemp("types")
    write_files(folder, {"lcmtypes/play.lcm": TYPES})
    use_types_of(folder)
