"""State of the display: newest messages, rates and log lines of the run; selection and filters of the user."""

from collections import deque
from typing import Any

from fwk.clock import US_PER_S, monotonic_us
from fwk.display.cores import usable_cores
from fwk.display.cpu import CpuMeter
from fwk.display.figures import LoopTime, loop_times, slowest
from fwk.display.floods import LineGroup, LineGroups
from fwk.display.plan_overview import counted, fewer_processes
from fwk.display.scoreboard import Drawing, Scoreboard
from fwk.lcm import envelope, messages
from fwk.model.errors import some
from fwk.model.plan import Plan
from lcmtypes.core import log_t, status_t

STATUS_CHANNEL = "fwk/status"
LOG_CHANNEL = "fwk/log"
LEVELS = (log_t.DEBUG, log_t.INFO, log_t.WARNING, log_t.ERROR)
_KEPT_LINES = 200
_RATE_STATUSES = 5  # loop times are means over as many statuses: about two seconds
_STANDING_US = US_PER_S
_SLOW_STATUSES = 8  # as many slow ones in a row: about four seconds
_SLOW = 0.9


class View:
    """Takes packets (channel, zero byte, encoded message) of a run and answers questions about it."""

    def __init__(self, plan: Plan) -> None:
        self.plan = plan
        self.lines = LineGroups(_KEPT_LINES)
        self.cpu = CpuMeter()
        self.waits_for: list[str] = []
        """Components that the main loop waits for, if it stands still."""
        self.selected = ""
        """Component or namespace of which lines are shown; empty: of all."""
        self.level = 0
        """Index in `LEVELS` of the least level that is shown."""
        self.message = ""
        """Answer to the last key."""
        self._statuses: deque[status_t] = deque(maxlen=_RATE_STATUSES)
        self._types = {channel.name: channel.type_name for channel in plan.channels}
        self._raw: dict[str, bytes] = {}
        self._scoreboard = Scoreboard(plan.scoreboard)
        self._tick, self._tick_us = -1, monotonic_us()
        self._slow = 0

    def take(self, packet: bytes) -> log_t | None:
        """Takes one packet; returns the log line if it was one.

        Raises:
            MessageError: a status or log line does not decode.
        """
        name, _, data = packet.partition(b"\0")
        channel = name.decode("utf-8", "replace")
        if channel == STATUS_CHANNEL:
            self._take_status(messages.decode(status_t, data, channel))
        elif channel == LOG_CHANNEL:
            line: log_t = messages.decode(log_t, data, channel)
            self.lines.add(line)
            return line
        else:
            self._raw[channel] = data  # decoded only if the scoreboard asks
        return None

    def _take_status(self, status: status_t) -> None:
        self._statuses.append(status)
        self.cpu.measure(host.pid for host in status.hosts)
        if status.tick != self._tick or status.paused:
            self._tick, self._tick_us = status.tick, monotonic_us()
            self.waits_for = []
        wanted = self.plan.speed
        slow = bool(wanted) and self.plan.clock == "simulated" and not status.paused and status.speed < _SLOW * wanted
        self._slow = self._slow + 1 if slow else 0

    @property
    def status(self) -> status_t | None:
        """Returns the newest status."""
        return self._statuses[-1] if self._statuses else None

    @property
    def standing_s(self) -> float:
        """Returns how long the tick has not advanced, in seconds of wall time; 0 below one second, or when paused."""
        standing_us = monotonic_us() - self._tick_us
        status = self.status
        return standing_us / US_PER_S if status and not status.paused and standing_us >= _STANDING_US else 0.0

    @property
    def waiting(self) -> str:
        """Returns the components that the main loop waits for, and for how long; empty while the tick advances."""
        if not self.standing_s:
            return ""
        return f"waits for {some(self.waits_for, 3) or 'the end of the tick'}, {self.standing_s:.0f} s"

    @property
    def slowness(self) -> str:
        """Returns why a run has been slower than asked for some seconds, and what helps; empty for all others."""
        if self._slow < _SLOW_STATUSES or self.standing_s:
            return ""
        period_ms = self.plan.period_us / 1000 / (self.plan.speed or 1)
        busiest = slowest(self.loop_times, 1)
        if busiest and busiest[0].mean_ms > period_ms:
            takes = f"{busiest[0].name} takes {busiest[0].mean_ms:.0f} ms"
            return f"slower than asked; {takes}, but a tick has only {period_ms:g} ms"
        hosts, cores = len(self.plan.hosts), usable_cores()
        if hosts <= cores:
            return "slower than asked; 'fwk top' shows where the time goes"
        shared = f"{hosts} processes share {counted(cores, 'core')}"
        return f"slower than asked; {shared}: start it with {fewer_processes(self.plan)}"

    @property
    def loop_times(self) -> dict[str, LoopTime]:
        """Returns the loop time of each component in the last two seconds."""
        return loop_times(self._statuses[-1], self._statuses[0]) if self._statuses else {}

    @property
    def headline(self) -> str:
        """Returns the scoreboard's line."""
        return self._scoreboard.headline(self.newest)

    def drawing(self, columns: int, rows: int) -> Drawing:
        """Returns the scoreboard's drawing for that much room; empty if it draws nothing."""
        return self._scoreboard.drawing(self.newest, columns, rows)

    def newest(self, channel: str) -> Any:
        """Returns the newest message of a channel, decoded, or None."""
        data = self._raw.get(channel)
        if data is None or channel not in self._types:
            return None
        return envelope.decode(messages.type_named(self._types[channel]), data, channel)

    def shown_lines(self) -> list[LineGroup]:
        """Returns the groups of log lines that match selection and level."""
        least = LEVELS[self.level]
        return [group for group in self.lines if group.line.level >= least and self._is_selected(group.line.component)]

    def select(self, step: int) -> None:
        """Selects the next or previous namespace or component; after the last one, all."""
        names = [""]
        for host in self.status.hosts if self.status else ():
            for component in host.components:
                namespace = component.name.rpartition("/")[0]
                names += [each for each in (namespace, component.name) if each and each not in names]
        names = [names[0], *sorted(names[1:])]
        at = names.index(self.selected) if self.selected in names else 0
        self.selected = names[(at + step) % len(names)]

    def _is_selected(self, name: str) -> bool:
        return not self.selected or name == self.selected or name.startswith(f"{self.selected}/")
