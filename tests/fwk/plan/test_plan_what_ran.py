"""The plan names the modules and the BLAS kernel that a run depends on."""

import os
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from fwk import Component
from fwk.clock import wall_us
from fwk.model.plan import ModulePlan, Plan
from fwk.model.plan_document import document_of, plan_from
from fwk.plan import what_ran
from fwk.plan.what_ran import blas_kernel, changed_modules, imported_modules, other_kernel
from fwk.testing.plans import plan_of


class Part(Component):
    stage = "think"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a component's module and a module that it imports; both are imported."""
    (tmp_path / "steering_rules.py").write_text("GAIN = 1\n")
    (tmp_path / "steering.py").write_text("from steering_rules import GAIN\n")
    monkeypatch.syspath_prepend(tmp_path)
    import_module("steering")
    return tmp_path


def plan_with(folder: Path) -> Plan:
    return replace(plan_of({"a/part": Part}), modules=imported_modules(["steering:Helm"], [str(folder)]))


def test_plan_names_component_modules_and_their_imports(folder: Path) -> None:
    modules = plan_with(folder).modules
    assert list(modules) == ["steering", "steering_rules"]
    assert modules["steering"].file == str(folder / "steering.py")
    assert len({module.sha256 for module in modules.values()}) == 2


def test_modules_survive_the_plan_document(folder: Path) -> None:
    plan = replace(plan_with(folder), blas_kernel="Haswell")
    assert plan_from(document_of(plan)) == plan


def test_unchanged_modules_are_not_reported(folder: Path) -> None:
    assert changed_modules(plan_with(folder)) == {}


def test_changed_and_missing_modules_are_reported(folder: Path) -> None:
    plan = plan_with(folder)
    rules = folder / "steering_rules.py"
    rules.write_text("GAIN = 2\n")
    plan.modules["steering_wheel"] = ModulePlan("/app/steering_wheel.py", "0")
    assert changed_modules(plan) == {
        "steering_rules": f"{rules} was changed",
        "steering_wheel": "/app/steering_wheel.py is missing",
    }


def test_a_module_is_read_again_once_it_changes(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(what_ran, "wall_us", lambda: wall_us() + 2_000_000)  # the files are old
    plan = plan_with(folder)
    with monkeypatch.context() as patch:
        patch.setattr(what_ran, "_hash_of_content", {}.__getitem__)
        assert changed_modules(plan) == {}
    rules = folder / "steering_rules.py"
    rules.write_text("GAIN = 2\n")
    os.utime(rules, ns=(0, 0))
    assert changed_modules(plan) == {"steering_rules": f"{rules} was changed"}


def test_a_module_of_the_same_name_elsewhere_is_reported(folder: Path) -> None:
    plan = plan_with(folder)
    plan.modules["steering"] = ModulePlan("/app/steering.py", "0")
    assert changed_modules(plan) == {"steering": f"/app/steering.py ran; here it is {folder / 'steering.py'}"}


def test_moved_modules_with_the_same_content_are_the_same(folder: Path) -> None:
    plan = plan_with(folder)
    plan.modules["steering"] = replace(plan.modules["steering"], file="/app/steering.py")
    assert changed_modules(plan) == {}


def test_the_kernel_of_the_loaded_library_has_a_name() -> None:
    np.ones((2, 2)) @ np.ones((2, 2))
    assert blas_kernel().isidentifier()


@pytest.mark.parametrize(("here", "there"), [("", "Haswell"), ("Haswell", ""), ("Haswell", "Haswell")])
def test_equal_and_unknown_kernels_are_not_reported(here: str, there: str) -> None:
    assert other_kernel(("a.lcm", "b.lcm"), (here, there)) == ""


def test_different_kernels_are_reported_with_both_sides() -> None:
    text = other_kernel(("a.lcm", "b.lcm"), ("Haswell", "Zen"))
    assert text.startswith("a.lcm ran with the BLAS kernel Haswell, b.lcm with Zen: ")
