"""Gives components of a recorded plan other classes."""

from collections.abc import Mapping
from dataclasses import replace
from importlib import import_module

from fwk.component.component import Component
from fwk.component.declaration import declaration
from fwk.component.port import DeclarationError
from fwk.recording.replay.recording import Recording, RecordingError


def with_classes(recording: Recording, classes: Mapping[str, str]) -> None:
    """Gives components of a recorded plan other classes, as `module:Class` by component.

    Raises:
        RecordingError: no such component or class, or the class has other ports.
    """
    plan = recording.plan
    names = {component.name: component for component in plan.components}
    changed = list(plan.components)
    for name, word in classes.items():
        if name not in names:
            raise RecordingError(f"--with {name}: no such component in this run; there are: {', '.join(names)}")
        component = names[name]
        module, _, class_name = word.partition(":")
        try:
            kind = getattr(import_module(module), class_name)
            ports = {port.attribute for port in declaration(kind).ports}
        except (ImportError, AttributeError, ValueError, TypeError, DeclarationError) as error:
            raise RecordingError(f"--with {name}={word}: {type(error).__name__}: {error}") from error
        if not issubclass(kind, Component) or ports != set(component.channels):
            raise RecordingError(
                f"--with {name}={word}: its ports are {', '.join(sorted(ports)) or 'none'}, those of the run "
                f"{', '.join(sorted(component.channels)) or 'none'}; they have to be the same"
            )
        changed[component.index] = replace(component, module=module, class_name=class_name)
    recording.plan = replace(plan, components=tuple(changed))
