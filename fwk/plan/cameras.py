"""Checks that the components of one camera agree about its geometry."""

from collections.abc import Iterator, Sequence

from pydantic import BaseModel

from fwk.component.config import Alike
from fwk.model.errors import Problems
from fwk.model.plan import NOBODY, ChannelPlan
from fwk.plan.alike import report_differences
from fwk.plan.resolve import Resolved


def check_cameras(components: Sequence[Resolved], channels: Sequence[ChannelPlan], problems: Problems) -> None:
    """Reports nested settings that a camera and the readers of its frames have in common, but with other values.

    Settings are in common if they have the same name and the same class, such as `mirror: MirrorConfig`. Those that
    all components have alike are checked before.
    """
    for channel in channels:
        if not channel.images:
            continue
        users = [components[index] for index in (channel.writer, *channel.readers) if index != NOBODY]
        right = f"; both use the frames of {channel.name}: set them alike, for example under 'shared:'"
        known: dict[str, Resolved] = {}
        for user in users:
            for name, kind in _groups(user):
                first = known.setdefault(name, user)
                if first is not user and _groups_of(first).get(name) is kind:
                    report_differences(name, first, user, right, problems)


def _groups_of(component: Resolved) -> dict[str, type[BaseModel]]:
    return dict(_groups(component))


def _groups(component: Resolved) -> Iterator[tuple[str, type[BaseModel]]]:
    for name, field in component.declaration.config.model_fields.items():
        if (
            Alike not in field.metadata
            and isinstance(field.annotation, type)
            and issubclass(field.annotation, BaseModel)
        ):
            yield name, field.annotation
