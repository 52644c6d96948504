"""Finds for each aspect that a component asks for the one component that provides it."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from fwk.model.errors import hint
from fwk.plan.wiring.component_spec import Report, Wish

Granted = tuple[dict[str, str], ...]
"""For each component: attribute of an aspect to the component that provides it."""


def with_providers(
    wishes: Sequence[Wish], report: Report, may_be_missing: Callable[[str], bool]
) -> tuple[list[Wish], Granted]:
    """The wishes with the channels of their aspects, and who provides these.

    A provider of the component's own namespace comes before others. `may_be_missing` says of a component that what it
    asks for is perhaps missing because of a mistake that is told already.
    """
    made, granted = [], []
    for wish in wishes:
        found = {}
        for attribute in wish.declaration.asks:
            provider = _provider(attribute, wish, wishes, report, may_be_missing)
            if provider:
                found[attribute] = provider
        for attribute in wish.providers:
            if attribute not in wish.declaration.asks:
                right = hint(attribute, wish.declaration.asks)
                report(wish.name, None, f"it asks for no aspect '{attribute}' that a component provides; {right}")
        made.append(replace(wish, channels={**_channels(wish, found), **wish.channels}))
        granted.append({attribute: provider.name for attribute, provider in found.items()})
    return made, tuple(granted)


def _provider(
    attribute: str,
    wish: Wish,
    wishes: Sequence[Wish],
    report: Report,
    may_be_missing: Callable[[str], bool],
) -> Wish | None:
    aspect = wish.declaration.asks[attribute]
    name = aspect.__name__
    every = [each for each in wishes if aspect in each.declaration.provides]
    names = [each.name for each in every]
    if attribute in wish.providers:
        said = wish.providers[attribute]
        full = said if "/" in said or not wish.namespace else f"{wish.namespace}/{said}"
        if full not in names and not may_be_missing(full):
            report(wish.name, None, f"'{full}' does not provide {name}, which it asks for as '{attribute}'; "
                   f"{hint(full, names)}")  # fmt: skip
        return next((each for each in every if each.name == full), None)
    near = [each for each in every if each.namespace == wish.namespace] or every
    if len(near) == 1:
        return near[0]
    asks = f"{name}, which {wish.name} asks for as '{attribute}'"
    if near:
        listed = " and ".join(each.name for each in near)
        right = f"keep one, or say 'providers: {{{attribute}: {near[0].name}}}'"
        report(wish.name, None, f"{len(near)} components provide {asks}: {listed}; {right}")
    elif not may_be_missing(wish.name):
        report(wish.name, None, f"nobody provides {asks}; add a component whose class says 'provides = {name}'")
    return None


def _channels(wish: Wish, found: dict[str, Wish]) -> dict[str, str]:
    """Ports of aspects that stand for what their provider writes, to its channels."""
    channels = {}
    for port in wish.declaration.ports:
        attribute, _, own = port.attribute.partition(".")
        if own and not port.each and attribute in found:
            provider = found[attribute]
            writer = next(each for each in provider.declaration.ports if each.attribute == own)
            channels[port.attribute] = provider.pattern(writer)
    return channels
