"""The process table: every host, its state, and when it is started again. Knows no clock and no processes."""

from collections import deque
from dataclasses import dataclass, field

from fwk.clock import US_PER_S
from fwk.plan.model import Plan, RestartPolicy
from lcmtypes.core import component_state_t


@dataclass
class HostEntry:
    """One host process."""

    index: int
    name: str
    policy: RestartPolicy
    ready_timeout_us: int
    state: str = "loaded"
    """loaded, starting, running, waiting (to be started again), stopped, failed."""
    incarnation: int = 0
    pid: int = 0
    since_us: int = 0
    """Wall time of the last change of state."""
    restart_us: int = 0
    """Wall time at which it is started again, while waiting."""
    restarts: int = 0
    reason: str = ""
    seen: int = 0
    """Step of the last tick that it answered; 0: none since it was started."""
    busy: tuple[int, int] | None = None
    """(tick, stage) that it still works on, late."""
    components: list[component_state_t] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._starts_us: deque[int] = deque()

    @property
    def alive(self) -> bool:
        """Whether there is a process."""
        return self.state in ("starting", "running")

    @property
    def expected(self) -> bool:
        """Whether it takes part in the loop now or will when it is ready."""
        return self.state in ("loaded", "starting", "running", "waiting")

    def starting(self, now_us: int) -> int:
        """It is being started; returns its incarnation."""
        self.incarnation += 1
        self.state, self.since_us, self.reason = "starting", now_us, ""
        self.seen, self.busy, self.pid = 0, None, 0
        self._starts_us.append(now_us)
        return self.incarnation

    def ended(self, code: int, now_us: int, stopping: bool) -> None:
        """Its process ended; decides whether and when it is started again."""
        self.pid, self.busy, self.since_us = 0, None, now_us
        how = f"killed by signal {-code}" if code < 0 else f"exit code {code}"
        if stopping and code == 0:
            self.state = "stopped"
            return
        if not self.reason:
            self.reason = next((item.reason for item in self.components if item.reason), how)
        wanted = self.policy.when == "always" or (self.policy.when == "on-failure" and code != 0)
        if stopping or not wanted:
            self.state = "stopped" if code == 0 else "failed"
            return
        while self._starts_us and self._starts_us[0] < now_us - self.policy.window_s * US_PER_S:
            self._starts_us.popleft()
        if len(self._starts_us) > self.policy.limit:
            self.state = "failed"
            self.reason += f" (started {len(self._starts_us)} times in {self.policy.window_s:g} s, not again)"
            return
        self.state = "waiting"
        self.restarts += 1
        again = max(len(self._starts_us) - 1, 0)
        self.restart_us = now_us + round(self.policy.backoff_s * 2**again * US_PER_S)


def host_table(plan: Plan) -> list[HostEntry]:
    """The table of a plan; a group has the strictest of its components' restart limits and the longest time-out."""
    table = []
    for host in plan.hosts:
        members = [plan.components[index] for index in host.components]
        policy = min((member.restart for member in members), key=lambda item: (item.when != "never", item.limit))
        timeout_us = round(max(member.ready_timeout_s for member in members) * US_PER_S)
        table.append(HostEntry(host.index, host.name, policy, timeout_us))
    return table
