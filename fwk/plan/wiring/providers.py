"""Finds the provider of each aspect that a component declares."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from fwk.model.errors import hint
from fwk.plan.wiring.component_spec import ComponentSpec, Report

Granted = tuple[dict[str, str], ...]
"""For each component: attribute of an aspect to the component that provides it."""


def with_providers(
    specs: Sequence[ComponentSpec], report: Report, may_be_missing: Callable[[str], bool]
) -> tuple[list[ComponentSpec], Granted]:
    """Returns the components with the channels of their provided aspects, and the providers.

    A provider in the component's own namespace takes precedence. `may_be_missing` tells whether a component may lack a
    provider only because of a mistake that is already reported.
    """
    made, granted = [], []
    for spec in specs:
        found = {}
        for attribute in spec.declaration.asks:
            provider = _provider(attribute, spec, specs, report, may_be_missing)
            if provider:
                found[attribute] = provider
        for attribute in spec.providers:
            if attribute not in spec.declaration.asks:
                right = hint(attribute, spec.declaration.asks)
                report(spec.name, None, f"it declares no aspect '{attribute}' that a component provides; {right}")
        made.append(replace(spec, channels={**_channels(spec, found), **spec.channels}))
        granted.append({attribute: provider.name for attribute, provider in found.items()})
    return made, tuple(granted)


def _provider(
    attribute: str,
    spec: ComponentSpec,
    specs: Sequence[ComponentSpec],
    report: Report,
    may_be_missing: Callable[[str], bool],
) -> ComponentSpec | None:
    aspect = spec.declaration.asks[attribute]
    name = aspect.__name__
    every = [each for each in specs if aspect in each.declaration.provides]
    names = [each.name for each in every]
    if attribute in spec.providers:
        said = spec.providers[attribute]
        full = said if "/" in said or not spec.namespace else f"{spec.namespace}/{said}"
        if full not in names and not may_be_missing(full):
            report(spec.name, None, f"'{full}' does not provide {name}, which it asks for as '{attribute}'; "
                   f"{hint(full, names)}")  # fmt: skip
        return next((each for each in every if each.name == full), None)
    near = [each for each in every if each.namespace == spec.namespace] or every
    if len(near) == 1:
        return near[0]
    asks = f"{name}, which {spec.name} asks for as '{attribute}'"
    if near:
        listed = " and ".join(each.name for each in near)
        right = f"keep one, or set 'providers: {{{attribute}: {near[0].name}}}'"
        report(spec.name, None, f"{len(near)} components provide {asks}: {listed}; {right}")
    elif not may_be_missing(spec.name):
        report(spec.name, None, f"no component provides {asks}; add a component whose class has 'provides = {name}'")
    return None


def _channels(spec: ComponentSpec, found: dict[str, ComponentSpec]) -> dict[str, str]:
    """Returns the channels of the ports of aspects that their providers write."""
    channels = {}
    for port in spec.declaration.ports:
        attribute, _, own = port.attribute.partition(".")
        if own and not port.each and attribute in found:
            provider = found[attribute]
            writer = next(each for each in provider.declaration.ports if each.attribute == own)
            channels[port.attribute] = provider.pattern(writer)
    return channels
