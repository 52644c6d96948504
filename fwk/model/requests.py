"""Boundary requests and loss reports in a done."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from fwk.model.channel_table import fingerprint_number, fingerprint_text
from lcmtypes.core import channel_request_t, done_t, lost_frame_t, lost_message_t, main_loop_request_t, plugin_request_t

PLUGIN_ACTIONS: Mapping[int, str] = {
    plugin_request_t.START: "start",
    plugin_request_t.STOP: "stop",
    plugin_request_t.RESTART: "restart",
    plugin_request_t.RELOAD: "reload",
    plugin_request_t.LOAD: "load",
    plugin_request_t.UNLOAD: "unload",
}
_ACTION_NUMBERS = {action: number for number, action in PLUGIN_ACTIONS.items()}
_CHANNEL_KINDS = {
    channel_request_t.READ: "read",
    channel_request_t.WRITE: "write",
    channel_request_t.READ_EACH: "each",
    channel_request_t.CLOSE: "close",
}
_CHANNEL_KIND_NUMBERS = {kind: number for number, kind in _CHANNEL_KINDS.items()}


def clear_requests(done: done_t) -> None:
    """Empties the lists of requests and losses of a done that is sent again with other content."""
    done.main_loop, done.plugins, done.channels, done.lost, done.lost_frames = [], [], [], [], []


def has_requests(done: done_t) -> bool:
    """Returns whether a done has requests or losses; most have none."""
    return bool(done.main_loop or done.plugins or done.channels or done.lost or done.lost_frames)


def main_loop_request(component: int, schedule: Sequence[int]) -> main_loop_request_t:
    """Returns the request of a component for the main loop; the schedule holds indices of stages."""
    made = main_loop_request_t()
    made.component, made.schedule = component, list(schedule)
    return made


def plugin_request(component: int, action: str, names: Iterable[str]) -> plugin_request_t:
    """Returns the request of a component to start or stop others."""
    made = plugin_request_t()
    made.component, made.action, made.names = component, _ACTION_NUMBERS[action], list(names)
    return made


def channel_request(component: int, request: Sequence[Any]) -> channel_request_t:
    """Returns the request of a component for a dynamic channel, from what `Blackboard._take` returns."""
    kind, handle, *rest = request
    made = channel_request_t()
    made.component, made.kind, made.handle = component, _CHANNEL_KIND_NUMBERS[kind], handle
    if rest:
        made.name, made.type_name, fingerprint = rest
        made.fingerprint = fingerprint_number(fingerprint)
    return made


def channel_request_of(message: channel_request_t) -> list[Any]:
    """Returns the request as `Blackboard._take` returned it."""
    kind = _CHANNEL_KINDS[message.kind]
    if message.kind == channel_request_t.CLOSE:
        return [kind, message.handle]
    return [kind, message.handle, message.name, message.type_name, fingerprint_text(message.fingerprint)]


def lost_message(channel: int, sequence: int) -> lost_message_t:
    """Returns the report that a message never arrived."""
    made = lost_message_t()
    made.channel, made.sequence = channel, sequence
    return made


def lost_frame(component: int, channel: int, frame: int) -> lost_frame_t:
    """Returns the report that a component never got a frame of a camera."""
    made = lost_frame_t()
    made.component, made.channel, made.frame = component, channel, frame
    return made


def mistake_in(done: done_t, components: int, channels: int, stages: int) -> str:
    """Returns the impossible part of a done's requests and reports in a plan of that size; empty if there is none."""
    asking = [each.component for each in done.main_loop] + [each.component for each in done.plugins]
    asking += [each.component for each in done.channels] + [each.component for each in done.lost_frames]
    if any(not 0 <= component < components for component in asking):
        return "a request of a component that the plan does not have"
    if any(not 0 <= stage < stages for each in done.main_loop for stage in each.schedule):
        return "a schedule with a stage that the plan does not have"
    if any(each.action not in PLUGIN_ACTIONS for each in done.plugins):
        return "a plugin request of an unknown kind"
    if any(each.kind not in _CHANNEL_KINDS for each in done.channels):
        return "a channel request of an unknown kind"
    if any(not 0 <= channel < channels for channel in [*done.channel, *(each.channel for each in done.lost)]):
        return "a channel that the plan does not have"
    if any(not 0 <= each.channel < channels for each in done.lost_frames):
        return "a camera that the plan does not have"
    return (
        "" if done.kind in (done_t.STAGE, done_t.ITERATION, done_t.FINAL) else f"a done of the unknown kind {done.kind}"
    )
