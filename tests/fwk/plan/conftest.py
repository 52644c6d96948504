"""A folder for the launch files, components and types of a test, from which nothing stays behind."""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from fwk.model.plan import Plan
from fwk.plan.load import LaunchOptions, load_plan


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """An empty folder that is the current one."""
    monkeypatch.chdir(tmp_path)
    path, modules = list(sys.path), set(sys.modules)
    sys.path.insert(0, str(Path(__file__).parent))  # launch files use the components of plan_parts
    yield tmp_path
    sys.path[:] = path
    for name in set(sys.modules) - modules:
        module = sys.modules[name]
        where = [getattr(module, "__file__", None) or "", *getattr(module, "__path__", [])]
        if any(each.startswith(str(tmp_path)) for each in where):
            del sys.modules[name]


@pytest.fixture
def load(folder: Path) -> Callable[..., Plan]:
    """Returns the plan of a launch file with this text: `load("components: ...", sets=["..."])`."""

    def loaded(text: str, **options: object) -> Plan:
        (folder / "it.yaml").write_text(text)
        return load_plan("it.yaml", LaunchOptions(**options))  # type: ignore[arg-type]

    return loaded
