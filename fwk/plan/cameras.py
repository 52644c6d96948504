"""Checks that the components of one camera agree about its geometry."""

from collections.abc import Iterator, Sequence
from typing import Any

from pydantic import BaseModel

from fwk.model.errors import Problems
from fwk.model.plan import NOBODY, ChannelPlan
from fwk.plan.files.settings import DEFAULT
from fwk.plan.resolve import Resolved


def check_cameras(components: Sequence[Resolved], channels: Sequence[ChannelPlan], problems: Problems) -> None:
    """Reports nested settings that a camera and the readers of its frames have in common, but with other values.

    Settings are in common if they have the same name and the same class, such as `mirror: MirrorConfig`.
    """
    for channel in channels:
        if not channel.images:
            continue
        users = [components[index] for index in (channel.writer, *channel.readers) if index != NOBODY]
        known: dict[str, Resolved] = {}
        for user in users:
            for name, kind in _groups(user):
                first = known.setdefault(name, user)
                if first is not user and _groups_of(first).get(name) is kind:
                    _compare(name, first, user, channel.name, problems)


def _compare(group: str, first: Resolved, second: Resolved, camera: str, problems: Problems) -> None:
    ours, theirs = (dict(_flat(group, each.config.get(group))) for each in (second, first))
    for key in [key for key in ours if key in theirs and ours[key] != theirs[key]]:
        place, who = next(
            (
                (each.origins[key], each.asked.name)
                for each in (second, first)
                if each.origins.get(key, DEFAULT) != DEFAULT
            ),
            (second.asked.node.place, second.asked.name),
        )
        problems.add(
            place,
            who,
            f"'{key}' is {ours[key]} in {second.asked.name}, but {theirs[key]} in {first.asked.name}; both use the "
            f"frames of {camera}: set them alike, for example under 'shared:'",
        )


def _groups_of(component: Resolved) -> dict[str, type[BaseModel]]:
    return dict(_groups(component))


def _groups(component: Resolved) -> Iterator[tuple[str, type[BaseModel]]]:
    for name, field in component.declaration.config.model_fields.items():
        if isinstance(field.annotation, type) and issubclass(field.annotation, BaseModel):
            yield name, field.annotation


def _flat(path: str, value: Any) -> Iterator[tuple[str, Any]]:
    if not isinstance(value, dict):
        yield path, value
        return
    for name, below in value.items():
        yield from _flat(f"{path}.{name}", below)
