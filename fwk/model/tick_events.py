"""Tick events: the decisions of the main loop in one tick, as values and as members of a tick record."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any, NamedTuple

from lcmtypes.core import tick_events_t


class StageBegun(NamedTuple):
    """A stage of the plan begins, at this step of the tick."""

    stage: int
    step: int


class StageDone(NamedTuple):
    """A host's done of a stage is taken; the tick is an earlier one if the host was late."""

    host: int
    tick: int
    step: int


class IterationDone(NamedTuple):
    """A done of a continuous component is taken: of an iteration, numbered from 1, on the marks of a tick."""

    host: int
    tick: int
    iteration: int


class FinalDone(NamedTuple):
    """The final done of a leaving host is taken; the tick is the last one that the host answered."""

    host: int
    tick: int


class TickTold(NamedTuple):
    """Continuous components get the present marks."""


class OutsideTaken(NamedTuple):
    """Messages from outside become visible."""


class HostStarted(NamedTuple):
    """A host is ready; `change` is the newest change of settings or channels that it was started with."""

    host: int
    incarnation: int
    change: int


class HostLost(NamedTuple):
    """A host has ended."""

    host: int


class HostLate(NamedTuple):
    """A host is late for the running stage."""

    host: int


class HostStopped(NamedTuple):
    """A host leaves the run, as requested."""

    host: int


class MainLoopGiven(NamedTuple):
    """A component holds the main loop from this tick on; -1: no component any more."""

    component: int


class ChannelsChanged(NamedTuple):
    """The change of channels with this number takes effect."""

    change: int


class MessageLost(NamedTuple):
    """A host never got a message, according to its next done."""

    host: int
    channel: int
    sequence: int


class FrameLost(NamedTuple):
    """A component never got a camera frame, according to the next done."""

    component: int
    channel: int
    frame: int


TickEvent = (
    StageBegun
    | StageDone
    | IterationDone
    | FinalDone
    | TickTold
    | OutsideTaken
    | HostStarted
    | HostLost
    | HostLate
    | HostStopped
    | MainLoopGiven
    | ChannelsChanged
    | MessageLost
    | FrameLost
)

# Kind, class, list in tick_events_t. The members of a class are the columns of the list, in the same order.
_KINDS: list[tuple[int, type[Any], str]] = [
    (tick_events_t.STAGE, StageBegun, "stages"),
    (tick_events_t.STAGE_DONE, StageDone, "stage_dones"),
    (tick_events_t.ITERATION_DONE, IterationDone, "iteration_dones"),
    (tick_events_t.FINAL_DONE, FinalDone, "final_dones"),
    (tick_events_t.TICK_TOLD, TickTold, ""),
    (tick_events_t.OUTSIDE_TAKEN, OutsideTaken, ""),
    (tick_events_t.HOST_STARTED, HostStarted, "started"),
    (tick_events_t.HOST_LOST, HostLost, "lost"),
    (tick_events_t.HOST_LATE, HostLate, "late"),
    (tick_events_t.HOST_STOPPED, HostStopped, "stopped"),
    (tick_events_t.MAIN_LOOP_GIVEN, MainLoopGiven, "main_loop"),
    (tick_events_t.CHANNELS_CHANGED, ChannelsChanged, "channels"),
    (tick_events_t.MESSAGE_LOST, MessageLost, "lost_messages"),
    (tick_events_t.FRAME_LOST, FrameLost, "lost_frames"),
]
_KIND_OF = {made: kind for kind, made, _ in _KINDS}
_LISTS = [(kind, made._fields, name) for kind, made, name in _KINDS if name]
_CLASS_OF = {kind: made for kind, made, _ in _KINDS}


def events_message(events: Sequence[TickEvent]) -> tick_events_t:
    """Returns the events as a tick record holds them."""
    made = tick_events_t()
    made.kind = [_KIND_OF[type(event)] for event in events]
    made.n = len(events)
    present = set(made.kind)
    for kind, columns, name in _LISTS:
        if kind in present:
            rows = [event for its_kind, event in zip(made.kind, events, strict=True) if its_kind == kind]
            listed = getattr(made, name)
            listed.n = len(rows)
            for column, values in zip(columns, zip(*rows, strict=True), strict=True):
                setattr(listed, column, list(values))
    return made


def events_of(message: tick_events_t) -> list[TickEvent]:
    """Returns the events of a tick record in their order.

    Raises:
        ValueError: an unknown kind, or a list whose length does not agree with the kinds.
    """
    rows: dict[int, Iterator[tuple[int, ...]]] = {}
    for kind, columns, name in _LISTS:
        listed = getattr(message, name)
        rows[kind] = zip(*(getattr(listed, column) for column in columns), strict=True)
    found: list[TickEvent] = []
    for kind in message.kind:
        made = _CLASS_OF.get(kind)
        if made is None:
            raise ValueError(f"tick event of the unknown kind {kind}")
        row = next(rows[kind], None) if kind in rows else ()
        if row is None:
            raise ValueError(f"fewer {made.__name__} events than announced")
        found.append(made(*row))
    if any(_has_more(left) for left in rows.values()):
        raise ValueError("more events in the lists than announced")
    return found


def _has_more(rows: Iterable[tuple[int, ...]]) -> bool:
    return next(iter(rows), None) is not None
