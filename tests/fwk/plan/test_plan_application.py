"""Source files of a component: its own, and the modules of the application that it imports."""

from collections.abc import Callable
from pathlib import Path

import pytest

from fwk.model.plan import Plan
from fwk.plan.files.source_files import Sources, mistakes
from tests.harness.runs import write_files

COMPONENT = """
{imports}
import numpy
from fwk import Component
class Some{name}(Component):
    stage = "think"
"""
FILES = {
    "one.py": COMPONENT.format(name="One", imports="import shape.round as r"),
    "two.py": COMPONENT.format(name="Two", imports="from shape import flat"),
    "three.py": COMPONENT.format(name="Three", imports="\nfrom fwk import clock"),
    "shape/__init__.py": "",
    "shape/round.py": "from .deep import well",
    "shape/flat.py": "def f():\n    from . import round",
    "shape/deep/__init__.py": "from ..edge import *",
    "shape/deep/well.py": "",
    "shape/edge.py": "",
    "unused.py": "",
}


@pytest.fixture
def plan(load: Callable[..., Plan], folder: Path) -> Plan:
    write_files(folder, FILES)
    return load("components: {r/one: {use: one}, r/two: {use: two}, r/three: {use: three}}")


def names(sources: Sources, plan: Plan, index: int, folder: Path) -> set[str]:
    return {str(file.relative_to(folder.resolve())) for file in sources.files(plan.components[index])}


def test_a_component_consists_of_its_imports_in_the_application(plan: Plan, folder: Path) -> None:
    sources = Sources(plan)
    around = {"shape/__init__.py", "shape/round.py", "shape/deep/__init__.py", "shape/deep/well.py", "shape/edge.py"}
    assert names(sources, plan, 0, folder) == {"one.py", *around}
    assert names(sources, plan, 1, folder) == {"two.py", "shape/flat.py", *around}
    assert names(sources, plan, 2, folder) == {"three.py"}


def test_changed_import_is_noticed_and_broken_file_keeps_imports(plan: Plan, folder: Path) -> None:
    sources = Sources(plan)
    names(sources, plan, 2, folder)
    (folder / "three.py").write_text("import added\n" + FILES["three.py"])
    (folder / "added.py").write_text("import unused")
    assert names(sources, plan, 2, folder) == {"three.py", "added.py", "unused.py"}
    (folder / "added.py").write_text("import unused\nx =")
    assert names(sources, plan, 2, folder) == {"three.py", "added.py", "unused.py"}
    assert mistakes(sources.files(plan.components[2])) == ["added.py:2: invalid syntax"]
    (folder / "added.py").write_bytes(b"\0")
    (folder / "unused.py").unlink()
    told = mistakes({folder / "added.py", folder / "unused.py"})
    assert told[0].startswith("added.py: ")
    assert told[1] == "unused.py: cannot be read: No such file or directory"


def test_installed_components_count_as_an_application(load: Callable[..., Plan]) -> None:
    plan = load("include: one-robot.yaml")
    ball = next(each for each in plan.components if each.name == "cyan1/omni_ball")
    found = {"/".join(file.parts[-2:]) for file in Sources(plan).files(ball)}
    assert {"vision/omni_ball.py", "vision/ball_finder.py", "vision/mirror.py"} <= found
    assert not any(name.startswith(("fwk/", "lcmtypes/")) for name in found)
    assert "behaviour/agent.py" not in found
