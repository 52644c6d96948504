"""Decisions of the main loop that a replay takes itself when it goes on live: schedule, channels, hosts, time."""

from collections.abc import Callable

from fwk.bus.sync import place_of
from fwk.engine.channel_grants import ChannelGrants
from fwk.engine.schedule import Schedule
from fwk.engine.visibility import Visibility
from fwk.model.channel_table import change_message, facts_in
from fwk.model.plan import Plan
from fwk.model.requests import channel_request_of
from fwk.recording.replay.participants import Participants
from lcmtypes.core import channels_change_t, done_t


class Decisions:
    """Follows the requests of the components through a recording, so that it can decide them afterwards.

    Args:
        plan: the plan of the run.
        ledger: the marks of the run.
        busy: returns whether a host is late or has not finalized yet.
    """

    def __init__(self, plan: Plan, ledger: Visibility, busy: Callable[[int], bool]) -> None:
        self.schedule = Schedule(plan)
        self.newest_change = 0
        """Number of the newest change of settings or channels."""
        self.wrong = ""
        """Why the decisions are not those of the run; empty: they are."""
        self.participants = Participants(plan)
        self._plan = plan
        self._ledger = ledger
        self._busy = busy
        self._grants = ChannelGrants(plan)
        self._opens = any(component.opens for component in plan.components)
        self._next_us = -1  # logical time of the next tick, as the time source set it
        self._crosses = False  # a boundary has taken the requests that it decides
        self._held: list[done_t] = []  # dones with requests for the boundary after that

    def heed(self, done: done_t) -> None:
        """Takes what a done requests, before or after the branch; a boundary that has begun does not decide it."""
        if done.next_time_us >= 0:
            self._next_us = done.next_time_us
        if self._crosses:
            self._held.append(done)
            return
        for request in done.main_loop:
            self.schedule.ask(done.tick, place_of(done), request)
        for asked in done.channels:
            name = self._plan.components[asked.component].name
            self._grants.ask(done.tick, place_of(done), name, [channel_request_of(asked)])
        for starts in done.plugins:
            self.participants.ask(done.tick, place_of(done), starts)

    def crosses(self) -> None:
        """Notes that a host leaves at a boundary: lockstep waits for it, with the requests that came before."""
        self._crosses = self._plan.clock == "simulated"

    def crossed(self) -> None:
        """Notes that a boundary has decided its requests; a run that is paused crosses another one before the tick."""
        held, self._held, self._crosses = self._held, [], False
        for done in held:
            self.heed(done)

    def came(self, host: int, incarnation: int) -> None:
        """Notes that a host takes part from now on."""
        self.participants.came(host, incarnation)
        for component in self._plan.hosts[host].components:
            self._grants.came(component, incarnation)

    def left(self, host: int) -> None:
        """Notes that a host takes no part any more."""
        self.participants.left(host)
        self._held = [done for done in self._held if done.host != host]
        components = self._plan.hosts[host].components
        self.schedule.left(components)
        for component in components:
            self._grants.left(component)

    def check_holder(self, holder: int, tick: int) -> None:
        """Decides about the main loop as the run did in a tick, and compares."""
        if self.schedule.asked:
            self.schedule.decide()
        if self.schedule.holder != holder and not self.wrong:
            self.wrong = f"in tick {tick} the main loop passes to a component that did not request it here"

    def check_channels(self, change: channels_change_t) -> None:
        """Decides about dynamic channels as the run did, and compares."""
        made = self.decide_channels()
        if (made is None or facts_in(made) != facts_in(change)) and not self.wrong:
            self.wrong = f"change {change.number} of the dynamic channels does not follow from requests made here"
        self.newest_change = change.number

    def decide_channels(self) -> channels_change_t | None:
        """Decides about dynamic channels at a boundary; None: nothing changes."""
        if not (self._opens and self._grants.asked):
            return None
        facts, _ = self._grants.decide(lambda component: self._busy(self._plan.components[component].host))
        if not facts:
            return None
        latest = self._ledger.latest
        numbered = [fact.numbered(latest(fact.channel.index)) if fact.channel else fact for fact in facts]
        self.newest_change += 1
        return change_message(self.newest_change, numbered)

    def advance(self, time_us: int) -> int:
        """Returns the logical time of the tick after one at `time_us`."""
        next_us, self._next_us = self._next_us, -1
        return next_us if next_us > time_us else time_us + self._plan.period_us
