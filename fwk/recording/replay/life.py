"""One incarnation of a replayed component: its host, its unanswered ticks, and its view of frames."""

from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from fwk.component.images import Ring
from fwk.engine.assignment import Assignment, Start
from fwk.engine.catch_up import CatchUp
from fwk.engine.component_group import Written
from fwk.engine.visibility import Visibility
from fwk.host.memory_host import MemoryHost
from fwk.lcm.messages import decode
from fwk.model.channel_table import ChannelTable, facts_in, text_of
from fwk.model.plan import ComponentPlan, HostPlan, Plan
from fwk.recording.replay.frames import FrameSource, FrameView
from lcmtypes.core import channels_change_t, done_t, frame_t, tick_t

Newest = Mapping[int, bytes]
"""The newest visible message of each channel, by index."""


class Life:
    """A component from a start to its end, as the same `Host` that ran in the recorded run.

    Args:
        plan: the plan with a host for each component, of the same index.
        component: the component.
        start: state of the run at the start of this incarnation.
        rings: rings into which replayed cameras put their frames.
        frames: sources of the frames of each camera.
        ledger: the marks of the run.
        further_stages: stages in which other components of its host in the run took part.
    """

    def __init__(
        self,
        plan: Plan,
        component: ComponentPlan,
        start: Start,
        rings: Mapping[str, Ring],
        frames: Mapping[str, FrameSource],
        ledger: Visibility,
        further_stages: Sequence[int] = (),
    ) -> None:
        self.plan = component
        self._views = {channel: FrameView(source) for channel, source in frames.items()}
        self._channels = {channel.name: channel.index for channel in plan.channels}
        self._told: deque[tick_t] = deque()  # ticks that a continuous component has not iterated on
        self._catch_up = CatchUp(start.incarnation)
        self.done: done_t | None = None
        """The newest done: what the component requested, and the next logical time."""
        self.host = MemoryHost(
            Assignment(plan, component.index, 0, start, rings, frames=self._views, further_stages=further_stages),
            ledger,
        )
        self.host.init()

    @property
    def writes(self) -> list[str]:
        """Names of the channels that the component writes now."""
        return list(self.host.runners[self.plan.name].writers)

    def see(self, channel: int, data: bytes) -> None:
        """Takes a message that became visible."""
        self.host.put(channel, data)

    def miss_frame(self, channel: str, number: int) -> None:
        """Withholds a frame from the component that was overwritten before the component read it."""
        self._views[channel].miss(number)

    def hold_newest_frames(self, newest: Newest) -> None:
        """Holds the present frames: the next iteration is late and looks at them later."""
        for channel in self.host.runners[self.plan.name].images:
            data = newest.get(self._channels[channel])
            if data:
                self._hold(channel, decode(frame_t, data, channel))

    def hold_last_frames(self) -> None:
        """Holds the frames of the last iteration: `finalize` may look at them."""
        for channel, image in self.host.runners[self.plan.name].images.items():
            self._hold(channel, image.announcement.value)

    def _hold(self, channel: str, frame: frame_t) -> None:
        if frame.frame:
            self._views[channel].hold(frame.frame, frame.height_px * frame.width_px * frame.channels)

    def hears(self, tick: int, stage: int) -> bool:
        """Returns whether a tick that the component's host in the run answered in a stage concerns the component.

        A tick of a stage in which only other components took part does so before an iteration that catches up: the
        message that the host had then may have been the newest that it ever got.
        """
        return stage in self.plan.stages or self._catch_up.applies(tick) or self.host.has_changes

    def iterate(self, tick: tick_t, stage: int) -> Written:
        """Runs the component's iteration of a tick, if it takes part in the stage; returns what it wrote."""
        if stage in self.plan.stages:
            self._catch_up.took_part(tick.tick)
        return self._taken(*self.host.tick(tick, stage))

    def tell(self, tick: tick_t) -> None:
        """Gives a continuous component the marks of a tick."""
        self._told.append(tick)

    def iterate_on(self, tick: int) -> Written:
        """Runs the next iteration of a continuous component, on the marks of a tick; returns what it wrote."""
        while self._told and self._told[0].tick <= tick:
            self.host.tell(self._told.popleft())
        return self._taken(*self.host.iterate())

    def finalize(self) -> Written:
        """Finalizes the component; returns what it wrote."""
        return self._taken(*self.host.finalize())

    def _taken(self, written: Written, done: done_t) -> Written:
        self.done = done
        return written


@dataclass(frozen=True)
class Owed:
    """A tick that a component has not answered yet."""

    life: Life
    tick: tick_t
    stage: int


def one_component_a_host(plan: Plan) -> Plan:
    """Returns the plan with a host for each component, both with the same index."""
    components = tuple(replace(component, host=component.index) for component in plan.components)
    hosts = tuple(HostPlan(each.index, each.name, (each.index,)) for each in components)
    return replace(plan, components=components, hosts=hosts)


def blackboard_at(plan: Plan, changes: Iterable[channels_change_t], newest: int) -> str:
    """Returns the dynamic channels as they were after the change of number `newest`, as facts in JSON."""
    table = ChannelTable(plan)
    for change in changes:
        if change.number <= newest:
            table.apply(facts_in(change))
    return text_of(table.snapshot())
