"""A folder for the launch files, components and types of a test, from which nothing stays behind."""

from collections.abc import Callable
from pathlib import Path

import pytest

from fwk.model.plan import Plan
from fwk.plan.load import LaunchOptions, load_plan


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder that is the current one."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(Path(__file__).parent)  # launch files use the components of plan_parts
    return tmp_path


@pytest.fixture
def load(folder: Path) -> Callable[..., Plan]:
    """Returns the plan of a launch file with this text: `load("components: ...", sets=["..."])`."""

    def loaded(text: str, **options: object) -> Plan:
        (folder / "it.yaml").write_text(text)
        return load_plan("it.yaml", LaunchOptions(**options))  # type: ignore[arg-type]

    return loaded
