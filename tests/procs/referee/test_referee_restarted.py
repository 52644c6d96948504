"""The cases of the rules with a referee that is restarted in every tick: each ends as without a restart."""

from importlib import import_module
from types import FunctionType, ModuleType

import pytest

from procs.referee.memory import recall, written
from procs.referee.sight import Sight
from procs.referee.whistle import Whistle

_CASES = ("advantage", "by_hand", "bystanders", "fouls", "match", "mirrored", "set_pieces")
_MODULES = [import_module(f"tests.procs.referee.test_referee_{name}") for name in _CASES]


def cases_of(modules: list[ModuleType]) -> dict[str, FunctionType]:
    """Returns the cases of all modules by name; two of one name would hide each other here."""
    cases: dict[str, FunctionType] = {}
    for module in modules:
        for name, case in vars(module).items():
            if name.startswith("test_"):
                if name in cases:
                    raise ValueError(f"{name} is in {cases[name].__module__} and {module.__name__}; rename one")
                cases[name] = case
    return cases


globals().update(cases_of(_MODULES))


@pytest.fixture(autouse=True)
def restarted(monkeypatch: pytest.MonkeyPatch) -> None:
    step = Whistle.step

    def restart_and_step(whistle: Whistle, duration_s: float, sight: Sight) -> None:
        following = Whistle(whistle.rules)
        recall(following, written(whistle))
        vars(whistle).update(vars(following))
        step(whistle, duration_s, sight)

    monkeypatch.setattr(Whistle, "step", restart_and_step)


def test_cases_of_one_name_in_two_modules_are_named() -> None:
    other = ModuleType("other")
    other.test_case, other.helper = test_cases_of_one_name_in_two_modules_are_named, 1  # type: ignore[attr-defined]
    assert list(cases_of([other])) == ["test_case"]
    with pytest.raises(ValueError, match=rf"^test_case is in {__name__} and other; rename one$"):
        cases_of([other, other])
