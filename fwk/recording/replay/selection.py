"""Selects the components of a replay: those asked for and their cameras, if they can be run again."""

from collections.abc import Container, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any

from pydantic import ValidationError

from fwk.component.declaration import Declaration, declaration
from fwk.lcm.envelope import fingerprint
from fwk.lcm.messages import MessageError, type_named
from fwk.model.plan import ComponentPlan
from fwk.model.selection import matches, nearest
from fwk.recording.replay.guard import Guard, ReachesOutsideError
from fwk.recording.replay.recording import Recording, RecordingError


@dataclass
class Choice:
    """Selected components of a recording, by index."""

    components: set[int] = field(default_factory=set)
    left_out: dict[int, str] = field(default_factory=dict)
    """Components that were asked for and cannot be run, each with the reason."""


def choose(recording: Recording, only: Sequence[str], guard: Guard) -> Choice:
    """Selects components by name or pattern, or all, and the cameras of frames that are not recorded.

    Their modules are imported while the guard watches.

    Raises:
        RecordingError: a pattern matches no component, or none that can be run again.
    """
    choosing = _Choosing(recording, guard)
    asked = [choosing.meant(pattern) for pattern in only] or [{each.index for each in recording.plan.components}]
    for found in asked:
        choosing.add(found)
    for pattern, found in zip(only, asked, strict=False):
        if found <= choosing.made.left_out.keys():
            reasons = "; ".join(choosing.said(index) for index in sorted(found))
            raise RecordingError(f"{recording.path}: '{pattern}' cannot be replayed: {reasons}")
    return choosing.made


def unrepeatable(component: ComponentPlan, settings: Any) -> str:
    """Returns why a component cannot be run again with these settings; empty: it can."""
    declared = _declaration(component)
    try:
        return declared.component.unrepeatable(declared.config.model_validate(settings))
    except ValidationError:  # its settings differ now, which its start reports
        return ""


def reaches_outside(component: ComponentPlan) -> bool | None:
    """Returns what the class of a component declares about reaching devices and other programs."""
    found: bool | None = _declaration(component).component.reaches_outside
    return found


def first_bytes(recording: Recording, chosen: Container[int]) -> dict[str, bytes]:
    """Returns the first bytes of messages, by channel, of all channels that the chosen components read or write.

    Raises:
        RecordingError: a type is not known.
    """
    concerned = [
        each for each in recording.plan.channels if any(map(chosen.__contains__, (each.writer, *each.readers)))
    ]
    try:
        return {channel.name: fingerprint(type_named(channel.type_name)) for channel in concerned}
    except MessageError as error:
        raise RecordingError(f"{recording.path}: {error}; the run directory keeps the types of the run") from error


class _Choosing:
    def __init__(self, recording: Recording, guard: Guard) -> None:
        self.made = Choice()
        self._guard = guard
        self._recording = recording
        self._components = recording.plan.components
        self._channels = {channel.name: channel for channel in recording.plan.channels}

    def meant(self, pattern: str) -> set[int]:
        found = {each.index for each in self._components if matches(each.name, pattern)}
        if not found:
            right = nearest(pattern, [each.name for each in self._components])
            raise RecordingError(f"{self._recording.path}: no component '{pattern}' in this run; {right}")
        return found

    def add(self, found: set[int]) -> None:
        for index in sorted(found):
            reason = self._reason(index)
            cameras = {} if reason else self._cameras(index)
            reason = reason or self._blind(cameras)
            if reason:
                self.made.left_out[index] = reason
            else:
                self.made.components |= {index, *cameras.values()}

    def said(self, index: int) -> str:
        return f"{self._components[index].name}: {self.made.left_out[index]}"

    def _blind(self, cameras: dict[str, int]) -> str:
        for channel, camera in cameras.items():
            if reason := self._reason(camera):
                return (
                    f"it reads {channel}, whose frames are not recorded ('record: {{frames: {channel}}}' in the "
                    f"launch file does), and {self._components[camera].name} cannot be run again: {reason}"
                )
        return ""

    def _reason(self, index: int) -> str:
        try:
            self._with_place(index, self._import)
        except ReachesOutsideError as error:
            module = self._components[index].module
            return (
                f"{module} cannot be imported in a replay: {error}; with 'reaches_outside = False' its init() may do so"
            )
        found: str = self._with_place(index, lambda component: unrepeatable(component, component.config))
        return found

    def _import(self, component: ComponentPlan) -> None:
        with self._guard.watching(component.name):
            import_module(component.module)

    def _cameras(self, index: int) -> dict[str, int]:
        """Returns the channels of unrecorded frames that a component reads, each with the index of its camera."""
        component = self._components[index]
        declared = self._with_place(index, _declaration)
        looks = [port.attribute for port in declared.ports if port.images and not port.writes]
        seen = [channel for attribute in looks for channel in component.channels.get(attribute, ())]
        recorded = self._recording.plan.record.frames
        return {channel: self._channels[channel].writer for channel in seen if channel not in recorded}

    def _with_place(self, index: int, find: Any) -> Any:
        component = self._components[index]
        try:
            return find(component)
        except Exception as error:
            raise RecordingError(
                f"{self._recording.path}: {component.name}: {component.module}:{component.class_name} cannot be "
                f"imported any more: {type(error).__name__}: {error}"
            ) from error


def _declaration(component: ComponentPlan) -> Declaration:
    return declaration(getattr(import_module(component.module), component.class_name))
