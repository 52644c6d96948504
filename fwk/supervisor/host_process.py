"""The process table: every host, its state, and its restarts; knows no clock and no processes."""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum

from fwk.clock import US_PER_S
from fwk.host.debugger import LEFT
from fwk.model.channel_table import Fact
from fwk.model.plan import Plan
from fwk.model.sections import RestartPolicy
from lcmtypes.core import component_state_t, histogram_t, host_counters_t

REAL_TIME_STOP_US = 3 * US_PER_S
"""Default time to end in real time; in lockstep the loop waits as long as it takes."""
NOT_STARTED = "does not start with the run; 'fwk load' starts it"


class HostState(StrEnum):
    """State of a host process."""

    LOADED = "loaded"
    """In the plan, to be started with the run."""
    WAITING = "waiting"
    """Starts as soon as its time has come and the hosts that it needs run."""
    STARTING = "starting"
    """Has a process that initialises its components."""
    RUNNING = "running"
    STOPPING = "stopping"
    """Has left the loop; its process was asked to end."""
    STOPPED = "stopped"
    FAILED = "failed"
    """Ended, or cannot be started, and is not restarted automatically."""


IDLE = frozenset({HostState.LOADED, HostState.WAITING, HostState.STOPPED, HostState.FAILED})
"""States without a process."""
JOINING = frozenset({HostState.LOADED, HostState.WAITING, HostState.STARTING, HostState.RUNNING})
"""States of a host that takes part in the loop or will."""
UNSETTLED = frozenset({HostState.WAITING, HostState.STARTING, HostState.STOPPING})
"""States that can change by time alone."""
NEXT_STATES = {
    HostState.LOADED: IDLE | {HostState.STARTING},
    HostState.WAITING: IDLE | {HostState.STARTING},
    HostState.STARTING: frozenset(HostState) - {HostState.LOADED},
    HostState.RUNNING: frozenset(HostState) - {HostState.LOADED, HostState.STARTING},
    HostState.STOPPING: frozenset({HostState.WAITING, HostState.STOPPED}),
    HostState.STOPPED: frozenset({HostState.WAITING, HostState.STARTING}),
    HostState.FAILED: frozenset({HostState.WAITING, HostState.STARTING, HostState.STOPPED, HostState.FAILED}),
}
"""The states that may follow each state."""


class HostStateError(Exception):
    """A change of state that is not in the table of states."""


@dataclass(frozen=True)
class Change:
    """New settings of a component as JSON, or decisions about dynamic channels."""

    component: int
    number: int
    settings: str
    step: int
    """Step of the ledger from which on hosts receive it."""
    facts: Sequence[Fact] = ()
    """Decisions about channels; a change with decisions has neither component nor settings."""


@dataclass(eq=False)
class HostProcess:
    """One host process."""

    index: int
    name: str
    policy: RestartPolicy
    ready_timeout_us: int | None = None
    """Wall time within which it must become ready; None: no limit."""
    stop_timeout_us: int | None = None
    """Wall time within which it must end when asked to during the run; None: no limit."""
    needs: tuple[int, ...] = ()
    """Hosts that must be running before it is started."""
    continuous: bool = False
    """Whether its component is continuous; the loop never waits for it."""
    incarnation: int = 0
    pid: int = 0
    since_us: int = 0
    """Wall time of the last change of state."""
    restart_us: int = 0
    """Wall time from which it may be started, while waiting."""
    restarts: int = 0
    reason: str = ""
    answered_step: int = 0
    """Step of the ledger of the last tick that it answered; 0: none in this incarnation."""
    told_step: int = 0
    """Step of the ledger of the last tick that it was sent; its marks also hold for stages that it runs ahead."""
    ahead: tuple[int, int] = (0, -1)
    """Tick and last step that it runs on the marks of the last tick that it was sent."""
    early: int = 0
    """Number of its dones of stages that have not begun yet."""
    late_with: tuple[int, int] | None = None
    """Tick, and step of that tick, on which it still works after the end of the stage."""
    finalizing: bool = False
    """Whether it left the loop and its final done may still come."""
    components: list[component_state_t] = field(default_factory=list)
    times: list[histogram_t] = field(default_factory=list)
    """Durations of its components' iterations."""
    counters: host_counters_t = field(default_factory=host_counters_t)
    """Losses and refusals of all its processes."""
    wanted: bool = True
    """First half of the desired state: whether it should run."""
    desired_run: int = 1
    """Second half of the desired state: a number that increases with each requested restart."""
    actual_run: int = 0
    """The desired run number at its last start."""
    asked_us: int = 0
    """Wall time at which the desired state changed last."""
    fresh_code: bool = False
    """Whether its processes import the application's modules anew, because their files changed."""
    changes: list[Change] = field(default_factory=list)
    """Changes that it has not confirmed yet."""
    held: bool = False
    """Whether a debugger has its process: no time limit applies."""
    started_with: int = 0
    """Number of the newest change that it was started with."""

    def __post_init__(self) -> None:
        self.alive = False
        """Whether a process exists that takes part in the loop or will."""
        self.running = False
        """Whether it takes part in the loop."""
        self.unsettled = False
        """Whether time alone may change its state."""
        self._joins = True
        self._state = HostState.LOADED
        self._starts_us: deque[int] = deque()
        self._earlier_frames: dict[str, int] = {}  # losses of earlier incarnations, by component
        self._earlier_counters = host_counters_t()

    @property
    def state(self) -> HostState:
        """State of the process."""
        return self._state

    @property
    def failed(self) -> bool:
        """Whether it has failed and is not restarted."""
        return self._state is HostState.FAILED

    @property
    def stopping(self) -> bool:
        """Whether it has left the loop and its process was asked to end."""
        return self._state is HostState.STOPPING

    @property
    def coming(self) -> bool:
        """Whether it is to take part in the loop and does not yet."""
        return self._joins and self._state in (HostState.WAITING, HostState.STARTING)

    @property
    def expected(self) -> bool:
        """Whether it takes part in the loop now or will when it is ready."""
        return self._joins or (self.wanted and self._state is HostState.STOPPING)

    @property
    def settled(self) -> bool:
        """Whether it has the desired state, or failed in the attempt."""
        if not self.wanted:
            return self._state is HostState.STOPPED
        done = self._state in (HostState.RUNNING, HostState.FAILED, HostState.STOPPED)
        return done and self.actual_run == self.desired_run

    @property
    def must_leave(self) -> bool:
        """Whether its process has to end for the desired state."""
        return self.alive and (not self.wanted or self.actual_run != self.desired_run)

    @property
    def must_join(self) -> bool:
        """Whether a process has to be started for the desired state."""
        return self.wanted and self.actual_run != self.desired_run and self._state in IDLE

    def not_ready_in_time(self, now_us: int) -> bool:
        """Returns whether it has exceeded the time to become ready."""
        limit_us = self.ready_timeout_us
        starting = self._state is HostState.STARTING and not self.held
        return starting and limit_us is not None and now_us - self.since_us > limit_us

    def not_stopped_in_time(self, now_us: int) -> bool:
        """Returns whether it has exceeded the time to end."""
        limit_us = self.stop_timeout_us
        return self._state is HostState.STOPPING and limit_us is not None and now_us - self.since_us > limit_us

    def want_stop(self, now_us: int) -> None:
        """Sets the desired state to stopped; nothing waits for a process that has yet to be started."""
        self.wanted, self.asked_us = False, now_us
        self._joins = self._joins and self._state is not HostState.WAITING

    def want_start(self, now_us: int) -> None:
        """Sets the desired state to running; a host that waits for its restart is started at once."""
        self.restart_us = now_us
        if not self.wanted or self._state in (HostState.STOPPED, HostState.FAILED):
            self.want_restart(now_us)

    def want_restart(self, now_us: int) -> None:
        """Sets the desired state to running in a new process; earlier failures are forgotten."""
        self.wanted, self.asked_us, self.restart_us = True, now_us, now_us
        self._joins = self._state in JOINING
        self.desired_run += 1
        self._starts_us.clear()

    def wait_for_start(self, now_us: int) -> None:
        """Lets it start as soon as its needs run."""
        self._become(HostState.WAITING, now_us)
        self.restart_us = now_us

    def fail(self, reason: str) -> None:
        """Marks it as failed: it cannot be started, or not in time."""
        self._become(HostState.FAILED, self.since_us)
        self.reason, self.actual_run = reason, self.desired_run

    def stay_stopped(self) -> None:
        """Leaves it without a process."""
        self._become(HostState.STOPPED, self.since_us)
        self.reason = ""

    def begin_start(self, now_us: int) -> int:
        """Begins a new incarnation; returns its number."""
        self._become(HostState.STARTING, now_us)
        self._earlier_frames = {component.name: component.lost_frames for component in self.components}
        self._earlier_counters = self.counters
        self.incarnation += 1
        self.actual_run, self.changes = self.desired_run, []
        self.reason = ""
        self.answered_step, self.late_with, self.pid = 0, None, 0
        self.told_step, self.ahead, self.early = 0, (0, -1), 0
        self.held = self.finalizing = False
        self._starts_us.append(now_us)
        return self.incarnation

    def become_ready(self, now_us: int) -> None:
        """Lets it take part in the loop."""
        self._become(HostState.RUNNING, now_us)

    def begin_stop(self, now_us: int) -> None:
        """Takes it out of the loop; its process has been asked to end.

        A host that was not ready has taken no part: its messages from `finalize` are void.
        """
        self.changes, self.finalizing = [], self.running
        self._become(HostState.STOPPING, now_us)

    def drop_told_changes(self) -> None:
        """Drops the changes of the tick that it answered last."""
        self.changes = [change for change in self.changes if change.step > self.answered_step]

    def report(self, components: list[component_state_t], times: list[histogram_t], counters: host_counters_t) -> None:
        """Takes the states of its components; losses of earlier processes stay counted."""
        for component in components:
            component.lost_frames += self._earlier_frames.get(component.name, 0)
        earlier = self._earlier_counters
        counters.fetched += earlier.fetched
        counters.lost += earlier.lost
        counters.foreign += earlier.foreign
        self.components, self.times, self.counters = components, times, counters

    def ended(self, code: int, now_us: int, stopping: bool, core: bool = False, culprit: str = "") -> None:
        """Notes the end of its process and decides whether and when it is restarted.

        Args:
            code: exit code, or minus the signal that killed it.
            now_us: wall time.
            stopping: whether the whole run ends.
            core: whether it left a core dump.
            culprit: name of the component that caused the end, if it is known.
        """
        asked = self._state is HostState.STOPPING
        self.pid, self.late_with, self.held, self.finalizing, self.changes = 0, None, False, False, []
        if not asked:
            self._explain(code, stopping, core, culprit)
        self.restart_us = now_us
        self._become(self._after_end(code, now_us, stopping), now_us)

    def _explain(self, code: int, stopping: bool, core: bool, culprit: str) -> None:
        how = f"killed by signal {-code}{', core dumped' if core else ''}" if code < 0 else f"exit code {code}"
        if code == 0:
            how = "it left by itself (exit code 0) without having been asked to"
        if stopping and code == 0:
            return
        if not self.reason:
            self.reason = next((item.reason for item in self.components if item.reason), how)
        if culprit:
            self.reason = f"{culprit}: {self.reason}"

    def _after_end(self, code: int, now_us: int, stopping: bool) -> HostState:
        if self._state is HostState.STOPPING:
            return HostState.WAITING if self.wanted and not stopping else HostState.STOPPED
        if (stopping and code == 0) or not self.wanted:  # asked to stop, but ended before the boundary
            return HostState.STOPPED
        if code == LEFT and not stopping:  # returned by a debugger, which is not a failure
            self.reason = "given back"
            return HostState.WAITING
        if stopping or self.policy.when == "never":
            return HostState.FAILED
        while self._starts_us and self._starts_us[0] < now_us - self.policy.window_s * US_PER_S:
            self._starts_us.popleft()
        if len(self._starts_us) > self.policy.limit:
            times = "once" if len(self._starts_us) == 1 else f"{len(self._starts_us)} times"
            self.reason += f" (started {times} in {self.policy.window_s:g} s, not again)"
            return HostState.FAILED
        self.restarts += 1
        again = max(len(self._starts_us) - 1, 0)
        self.restart_us = now_us + round(self.policy.backoff_s * 2**again * US_PER_S)
        return HostState.WAITING

    def _become(self, state: HostState, now_us: int) -> None:
        if state not in NEXT_STATES[self._state]:
            raise HostStateError(f"{self.name} is {self._state} and cannot become {state}")
        self._state, self.since_us = state, now_us
        self.running = state is HostState.RUNNING
        self.alive = self.running or state is HostState.STARTING
        self.unsettled = state in UNSETTLED
        self._joins = state in JOINING


def host_processes(plan: Plan) -> list[HostProcess]:
    """Makes the table of a plan's hosts.

    A host has the strictest of its components' restart limits and the longest of their time-outs.
    """
    table = []
    host_of = {component.index: component.host for component in plan.components}
    usual_stop_us = REAL_TIME_STOP_US if plan.clock == "wall" else None
    for planned in plan.hosts:
        members = [plan.components[index] for index in planned.components]
        policy = min((member.restart for member in members), key=lambda item: (item.when != "never", item.limit))
        needs = {host_of[needed] for member in members for needed in member.needs} - {planned.index}
        host = HostProcess(
            planned.index,
            planned.name,
            policy,
            _longest_us([member.ready_timeout_s for member in members]),
            _longest_us([member.stop_timeout_s for member in members]) or usual_stop_us,
            tuple(sorted(needs)),
            members[0].rate_hz is not None,
        )
        if not all(member.start for member in members):
            host.stay_stopped()
            host.wanted, host.reason = False, NOT_STARTED
        table.append(host)
    return table


def _longest_us(timeouts_s: list[float | None]) -> int | None:
    """Returns the longest of some time-outs; None: one of them has no limit."""
    limits = [each for each in timeouts_s if each is not None]
    return round(max(limits) * US_PER_S) if len(limits) == len(timeouts_s) else None
