"""The process table: every host, its state, and when it is started again. Knows no clock and no processes."""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field

from fwk.clock import US_PER_S
from fwk.host.debugger import LEFT
from fwk.model.channel_table import Fact
from fwk.model.plan import Plan, RestartPolicy
from lcmtypes.core import component_state_t, histogram_t

NOT_STARTED = "does not start with the run"


@dataclass(frozen=True)
class Change:
    """New settings of a component: all of them, as JSON; or decisions about channels."""

    component: int
    number: int
    settings: str
    step: int
    """Step of the main loop from which on they are told."""
    facts: Sequence[Fact] = ()
    """Decisions about channels; then there is no component and there are no settings."""


@dataclass
class HostEntry:
    """One host process."""

    index: int
    name: str
    policy: RestartPolicy
    ready_timeout_us: int
    needs: tuple[int, ...] = ()
    """Hosts that have to be running before it is started."""
    state: str = "loaded"
    """loaded, starting, running, stopping, waiting (for its time and for what it needs), stopped, failed."""
    incarnation: int = 0
    pid: int = 0
    since_us: int = 0
    """Wall time of the last change of state."""
    restart_us: int = 0
    """Wall time at which it may be started, while waiting."""
    restarts: int = 0
    reason: str = ""
    seen: int = 0
    """Step of the last tick that it answered; 0: none since it was started."""
    busy: tuple[int, int] | None = None
    """Tick, and place in its order of stages, that it still works on, late."""
    components: list[component_state_t] = field(default_factory=list)
    times: list[histogram_t] = field(default_factory=list)
    """How long the iterations of its components took."""
    wanted: bool = True
    """Whether it should run: the one half of the desired state."""
    desired_run: int = 1
    """The other half: a number that goes up with each wish to start it again."""
    actual_run: int = 0
    """The desired run number at its last start."""
    asked_us: int = 0
    """Wall time at which the desired state changed last."""
    fresh_code: bool = False
    """Whether its processes import the application's modules anew, because their files changed."""
    changes: list[Change] = field(default_factory=list)
    """Settings that it has not taken over yet."""
    held: bool = False
    """Whether a debugger has its process: nobody hurries it."""
    started_with: int = 0
    """Number of the newest change of settings that it was started with."""

    def __post_init__(self) -> None:
        self._starts_us: deque[int] = deque()
        self._earlier: dict[str, component_state_t] = {}  # what the processes before this one said last

    @property
    def alive(self) -> bool:
        """Whether there is a process."""
        return self.state in ("starting", "running")

    def overdue(self, now_us: int) -> bool:
        """Whether it should have become ready by now."""
        return self.state == "starting" and not self.held and now_us - self.since_us > self.ready_timeout_us

    @property
    def expected(self) -> bool:
        """Whether it takes part in the loop now or will when it is ready."""
        return self.state in ("loaded", "starting", "running", "waiting") or (self.wanted and self.state == "stopping")

    @property
    def settled(self) -> bool:
        """Whether it is as desired, or failed in trying."""
        if not self.wanted:
            return self.state == "stopped"
        return self.state in ("running", "failed", "stopped") and self.actual_run == self.desired_run

    @property
    def leaves(self) -> bool:
        """Whether its process has to end for what is desired."""
        return self.alive and (not self.wanted or self.actual_run != self.desired_run)

    @property
    def joins(self) -> bool:
        """Whether a process has to be started for what is desired."""
        idle = self.state in ("loaded", "waiting", "stopped", "failed")
        return self.wanted and self.actual_run != self.desired_run and idle

    def want_stop(self, now_us: int) -> None:
        """It shall not run any more."""
        self.wanted, self.asked_us = False, now_us

    def want_start(self, now_us: int) -> None:
        """It shall run, if it does not yet."""
        if not self.wanted or self.state in ("stopped", "failed"):
            self.want_restart(now_us)

    def want_restart(self, now_us: int) -> None:
        """It shall run, in a new process; earlier failures are forgotten."""
        self.wanted, self.asked_us = True, now_us
        self.desired_run += 1
        self._starts_us.clear()

    def waits(self, now_us: int) -> None:
        """It is to be started as soon as what it needs runs."""
        self.state, self.since_us, self.restart_us = "waiting", now_us, now_us

    def give_up(self, reason: str) -> None:
        """It cannot be started."""
        self.state, self.reason, self.actual_run = "failed", reason, self.desired_run

    def leaving(self, now_us: int) -> None:
        """It leaves the loop; its process has been asked to end."""
        self.state, self.since_us, self.changes = "stopping", now_us, []

    def told(self) -> None:
        """It has answered the newest tick, and with that taken over the changes that the tick told."""
        self.changes = [change for change in self.changes if change.step > self.seen]

    def heard(self, components: list[component_state_t], times: list[histogram_t]) -> None:
        """What it says of its components; what was lost stays lost when a process ends."""
        for component in components:
            earlier = self._earlier.get(component.name)
            if earlier:
                component.lost += earlier.lost
                component.fetched += earlier.fetched
                component.strangers += earlier.strangers
        self.components, self.times = components, times

    def starting(self, now_us: int) -> int:
        """It is being started; returns its incarnation."""
        self._earlier = {component.name: component for component in self.components}
        self.incarnation += 1
        self.actual_run, self.changes = self.desired_run, []
        self.state, self.since_us, self.reason = "starting", now_us, ""
        self.seen, self.busy, self.pid, self.held = 0, None, 0, False
        self._starts_us.append(now_us)
        return self.incarnation

    def ended(self, code: int, now_us: int, stopping: bool, core: bool = False, culprit: str = "") -> None:
        """Its process ended, because of one of its components if it is known; decides whether and when it is started
        again.
        """
        self.pid, self.busy, self.held, self.since_us, self.changes = 0, None, False, now_us, []
        if self.state == "stopping":
            self.state, self.restart_us = ("waiting" if self.wanted and not stopping else "stopped"), now_us
            return
        how = f"killed by signal {-code}{', core dumped' if core else ''}" if code < 0 else f"exit code {code}"
        if code == 0:
            how = "it left by itself (exit code 0), which nobody had asked it to"
        if stopping and code == 0:
            self.state = "stopped"
            return
        if not self.reason:
            self.reason = next((item.reason for item in self.components if item.reason), how)
        if culprit:
            self.reason = f"{culprit}: {self.reason}"
        if not self.wanted:  # asked to stop, but ended before the loop came to it
            self.state = "stopped"
            return
        if code == LEFT and not stopping:  # on with it, and nobody counts it as a failure
            self.state, self.restart_us, self.reason = "waiting", now_us, "given back"
            return
        if stopping or self.policy.when == "never":
            self.state = "failed"
            return
        while self._starts_us and self._starts_us[0] < now_us - self.policy.window_s * US_PER_S:
            self._starts_us.popleft()
        if len(self._starts_us) > self.policy.limit:
            self.state = "failed"
            times = "once" if len(self._starts_us) == 1 else f"{len(self._starts_us)} times"
            self.reason += f" (started {times} in {self.policy.window_s:g} s, not again)"
            return
        self.state = "waiting"
        self.restarts += 1
        again = max(len(self._starts_us) - 1, 0)
        self.restart_us = now_us + round(self.policy.backoff_s * 2**again * US_PER_S)


def host_table(plan: Plan) -> list[HostEntry]:
    """The table of a plan; a group has the strictest of its components' restart limits and the longest time-out."""
    table = []
    host_of = {component.index: component.host for component in plan.components}
    for host in plan.hosts:
        members = [plan.components[index] for index in host.components]
        policy = min((member.restart for member in members), key=lambda item: (item.when != "never", item.limit))
        timeout_us = round(max(member.ready_timeout_s for member in members) * US_PER_S)
        needs = {host_of[needed] for member in members for needed in member.needs} - {host.index}
        entry = HostEntry(host.index, host.name, policy, timeout_us, tuple(sorted(needs)))
        if not all(member.start for member in members):
            entry.wanted, entry.state, entry.reason = False, "stopped", NOT_STARTED
        table.append(entry)
    return table
