"""Gives components of a recorded plan other classes."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from importlib import import_module
from typing import NamedTuple, Self

from fwk.component.component import Component
from fwk.component.declaration import Declaration, declaration
from fwk.component.port import DeclarationError
from fwk.model.plan import ComponentPlan
from fwk.model.selection import nearest
from fwk.recording.replay.recording import Recording, RecordingError


def with_classes(recording: Recording, classes: Mapping[str, str]) -> None:
    """Gives components of a recorded plan other classes, as `module:Class` by component.

    What the run took from the former class, and not from its launch file, comes from the new one: `every`, `offset`
    and `rate_hz`. Stages stay, because the recorded ticks have them.

    Raises:
        RecordingError: no such component or class, or the class has other ports or iterates in other stages.
    """
    plan = recording.plan
    names = {component.name: component for component in plan.components}
    changed = list(plan.components)
    for name, word in classes.items():
        if name not in names:
            raise RecordingError(f"--with {name}: no such component in this run; {nearest(name, list(names))}")
        component = names[name]
        try:
            kind = _class(word)
            declared = declaration(kind)
            ports = {port.attribute for port in declared.ports}
        except (ImportError, AttributeError, ValueError, TypeError, DeclarationError) as error:
            raise RecordingError(f"--with {name}={word}: {type(error).__name__}: {error}") from error
        if not issubclass(kind, Component) or ports != set(component.channels):
            raise RecordingError(
                f"--with {name}={word}: its ports are {', '.join(sorted(ports)) or 'none'}, those of the run "
                f"{', '.join(sorted(component.channels)) or 'none'}; they have to be the same"
            )
        ran, new = _Turns.of_plan(component, plan.stages), _Turns.of_class(declared)
        former = _former(component) or ran
        if new.continuous != ran.continuous or (ran.stages == former.stages and ran.stages != new.stages):
            raise RecordingError(
                f"--with {name}={word}: it iterates {new}, the component of the run {ran}; give the class the stages "
                "of the run, or start the launch file with it"
            )
        module, _, class_name = word.partition(":")
        changed[component.index] = replace(
            component,
            module=module,
            class_name=class_name,
            rate_hz=new.rate_hz if ran.rate_hz == former.rate_hz else ran.rate_hz,
            every=new.every if ran.every == former.every else ran.every,
            offset=new.offset if ran.offset == former.offset else ran.offset,
        )
    recording.plan = replace(plan, components=tuple(changed))


class _Turns(NamedTuple):
    """When a component iterates."""

    stages: frozenset[str]
    rate_hz: float | None
    every: int
    offset: int

    @classmethod
    def of_plan(cls, plan: ComponentPlan, stages: Sequence[str]) -> Self:
        return cls(frozenset(stages[index] for index in plan.stages), plan.rate_hz, plan.every, plan.offset)

    @classmethod
    def of_class(cls, declared: Declaration) -> Self:
        return cls(frozenset(declared.stages), declared.rate_hz, declared.every, declared.offset)

    @property
    def continuous(self) -> bool:
        return self.rate_hz is not None

    def __str__(self) -> str:
        return "continuously" if self.continuous else f"in {' and '.join(sorted(self.stages))}"


def _class(word: str) -> type[Component]:
    module, _, class_name = word.partition(":")
    found: type[Component] = getattr(import_module(module), class_name)
    return found


def _former(component: ComponentPlan) -> _Turns | None:
    """Returns the turns that the class of the run declares; None if the class is gone."""
    try:
        return _Turns.of_class(declaration(_class(f"{component.module}:{component.class_name}")))
    except (ImportError, AttributeError, ValueError, TypeError, DeclarationError):
        return None
