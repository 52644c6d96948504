"""The incarnations of the components of a replay: their starts, ends, settings and failures."""

import json
import traceback
from bdb import BdbQuit
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext

from fwk.engine.assignment import Start
from fwk.engine.failures import ComponentFailedError
from fwk.engine.visibility import Visibility
from fwk.model.channel_table import facts_in
from fwk.model.plain_values import value_of
from fwk.model.plan import ComponentPlan
from fwk.recording.replay.frames import FrameSource, RecordedFrames, RingFrames, private_ring
from fwk.recording.replay.guard import Guard, ReachesOutsideError
from fwk.recording.replay.life import Life, blackboard_at, one_component_a_host
from fwk.recording.replay.recording import Recording, RecordingError
from fwk.recording.replay.selection import Choice, reaches_outside
from lcmtypes.core import channels_change_t, settings_change_t


class Lives:
    """Incarnations by the host that they had in the run, with the state that the next incarnation begins with.

    Args:
        recording: the recording.
        choice: components that run, and those that cannot.
        guard: keeps components from reaching outside.
        failure: returns the message about a component that fails at a moment.
    """

    def __init__(
        self,
        recording: Recording,
        choice: Choice,
        guard: Guard,
        failure: Callable[[ComponentPlan, str], str],
    ) -> None:
        self.run_plan = plan = recording.plan
        self.plan = one_component_a_host(plan)
        self.ledger = Visibility(self.plan)
        """The marks of the run."""
        self.chosen = choice.components
        self.left_out = {plan.components[index].name: reason for index, reason in choice.left_out.items()}
        """Components that are not run, with the reason."""
        self.running: dict[int, list[Life]] = {}
        self.leaving: dict[int, list[Life]] = {}
        """Incarnations that were asked to stop and have not finalized yet."""
        self.settings: dict[int, list[settings_change_t]] = {}
        """By component."""
        self.decided: list[channels_change_t] = []
        self.newest: dict[int, bytes] = {}
        """The newest visible message of each channel, by index."""
        self.recorded = {channel: RecordedFrames(recording.path, channel) for channel in plan.record.frames}
        self.rings = {channel.name: private_ring(channel.name) for channel in plan.channels if channel.images}
        live = {channel: RingFrames(ring) for channel, ring in self.rings.items()}
        self.frames: dict[str, FrameSource] = {**live, **self.recorded}
        self._guard = guard
        self._failure = failure

    def of(self, host: int) -> list[Life]:
        """Returns the lives of a host that run."""
        return self.running.get(host, [])

    def living(self, host: int) -> list[Life]:
        """Returns the lives of a host that run, and those that have not finalized yet."""
        return [*self.of(host), *self.leaving.get(host, [])]

    def all_running(self) -> list[Life]:
        """Returns the lives of all hosts that run."""
        return [life for lives in self.running.values() for life in lives]

    def start(self, host: int, incarnation: int, newest_change: int) -> None:
        """Starts the chosen components of a host as they were started after that change."""
        self.end(host)
        self.running[host] = []
        for index in self.run_plan.hosts[host].components:
            if index in self.chosen:
                self._begin(self.plan.components[index], host, incarnation, newest_change)

    def stop(self, host: int) -> None:
        """Asks the lives of a host to leave; they finalize later, unless the host finalized by itself before."""
        if host in self.running:
            self.leaving[host] = self.running.pop(host)
            for life in self.leaving[host]:
                life.hold_last_frames()

    def end(self, host: int) -> None:
        """Ends the lives of a host."""
        for life in self.living(host):
            life.host.close()
        self.running.pop(host, None)
        self.leaving.pop(host, None)

    def set(self, change: settings_change_t) -> None:
        """Gives a component new settings."""
        self.settings.setdefault(change.component, []).append(change)
        for life in self.of(self.run_plan.components[change.component].host):
            if life.plan.index == change.component:
                life.host.set(change)

    def decide(self, change: channels_change_t) -> None:
        """Tells the components that open channels what was decided about them."""
        self.decided.append(change)
        for life in self.all_running():
            if life.plan.opens:
                life.host.decide(change, self.newest)

    def see(self, channel: int, data: list[bytes]) -> None:
        """Shows messages that became visible to all components."""
        self.newest[channel] = data[-1]
        for life in self.all_running():
            for each in data:
                life.see(channel, each)

    def leave_out(self, component: ComponentPlan, reason: str) -> None:
        """Ends a component that a replay must not run; its recorded messages replace it."""
        self.left_out[component.name] = (
            f"{reason}, which reaches outside; 'reaches_outside = False' in {component.class_name} lets replays do that"
        )
        self.chosen.discard(component.index)
        for lives in (*self.running.values(), *self.leaving.values()):
            for life in [life for life in lives if life.plan.index == component.index]:
                life.host.close()
                lives.remove(life)

    @contextmanager
    def failing(self, component: ComponentPlan, moment: str) -> Iterator[None]:
        """Reports a failure of a component; leaves a component out that reaches outside.

        Raises:
            RecordingError: the component failed, unless its exception left the debugger.
        """
        watching = nullcontext() if reaches_outside(component) is False else self._guard.watching(component.name)
        try:
            with watching:
                yield
        except (BdbQuit, RecordingError):
            raise
        except ReachesOutsideError as error:
            self.leave_out(component, str(error))
        except Exception as error:
            if isinstance(error.__cause__, ReachesOutsideError):
                self.leave_out(component, str(error.__cause__))
                return
            cause = error.__cause__ if isinstance(error, ComponentFailedError) and error.__cause__ else error
            if isinstance(cause, RecordingError):  # a frame is not in the recording
                raise cause from error
            trace = "".join(traceback.format_exception(cause)).rstrip()
            raise RecordingError(f"{self._failure(component, moment)}\n{trace}") from cause

    def _begin(self, component: ComponentPlan, host: int, incarnation: int, newest_change: int) -> None:
        settings = self.settings.get(component.index, [])
        before = [each for each in settings if each.number <= newest_change]
        start = Start(
            incarnation,
            self.ledger.sequences(component.index),
            {component.name: json.dumps(value_of(before[-1].values))} if before else {},
            blackboard_at(self.run_plan, self.decided, newest_change) if component.opens else "[]",
            newest_change,
        )
        with self.failing(component, "its start"):
            beside = self.run_plan.hosts[host].components
            stages = sorted({stage for index in beside for stage in self.run_plan.components[index].stages})
            self.running[host].append(Life(self.plan, component, start, self.rings, self.frames, self.ledger, stages))
        if component.index not in self.chosen:  # it reached outside
            return
        life = self.running[host][-1]
        for change in settings:
            if change.number > newest_change:
                life.host.set(change)
        for decided in self.decided if component.opens else ():
            if decided.number > newest_change:
                life.host.decide(decided, self.newest)
        for channel, data in self.newest.items():
            life.see(channel, data)


def opened_in(change: channels_change_t) -> dict[int, str]:
    """Returns the names of the channels that a change opens, by index."""
    return {fact.channel.index: fact.channel.name for fact in facts_in(change) if fact.channel}
