"""The hosts that take part after a branch: as components request, and as the recording says."""

from collections.abc import Iterable
from typing import NamedTuple, cast

from fwk.control.requests import Action, RequestError
from fwk.model.plan import Plan
from fwk.model.requests import PLUGIN_ACTIONS
from fwk.model.tick_events import HostLost, HostStarted, HostStopped, TickEvent
from fwk.supervisor.lifecycle import Lifecycle
from lcmtypes.core import plugin_request_t

_RUNNING, _STOPPED = "running", "stopped"


class Turnover(NamedTuple):
    """Hosts that leave or come at a boundary."""

    stopped: list[int]
    """They finalize."""
    lost: list[int]
    """They end without finalizing."""
    coming: list[tuple[int, int]]
    """Each with its incarnation."""


class Participants:
    """Decides at boundaries which hosts leave and come."""

    def __init__(self, plan: Plan) -> None:
        self.refused: list[str] = []
        """Sentences about requests that were refused, as in a run."""
        self._components = plan.components
        self._table = [_Host(host.index, host.name) for host in plan.hosts]
        self._lifecycle = Lifecycle(plan, self._table)
        self._asked: list[tuple[tuple[int, int, str], plugin_request_t]] = []

    def ask(self, tick: int, step: int, request: plugin_request_t) -> None:
        """Takes the request that a component made at a step of a tick."""
        self._asked.append(((tick, step, self._components[request.component].name), request))

    def forget(self) -> None:
        """Drops the requests: the recording says what came of them."""
        self._asked = []

    def came(self, host: int, incarnation: int) -> None:
        """Notes that a host takes part from now on."""
        entry = self._table[host]
        entry.state, entry.wanted, entry.again, entry.incarnation = _RUNNING, True, False, incarnation

    def left(self, host: int) -> None:
        """Notes that a host takes no part any more."""
        self._table[host].state, self._table[host].wanted = _STOPPED, False

    def decide(self, recorded: Iterable[TickEvent]) -> Turnover:
        """Decides the requests since the last boundary, and what the recording says about hosts there."""
        for (_, _, sender), request in sorted(self._asked, key=lambda each: each[0]):
            self._grant(sender, request)
        self._asked = []
        lost = []
        for event in recorded:
            if isinstance(event, HostStopped | HostLost):
                if isinstance(event, HostLost) and self._table[event.host].stays:
                    lost.append(event.host)
                self._table[event.host].want_stop(0)
            elif isinstance(event, HostStarted):
                self._table[event.host].want_start(0)
        leaving = [entry.index for entry in self._table if entry.state == _RUNNING and not entry.stays]
        coming = [
            (entry.index, entry.incarnation + 1)
            for entry in self._table
            if entry.wanted and (entry.state != _RUNNING or entry.again)
        ]
        return Turnover([host for host in leaving if host not in lost], lost, coming)

    def _grant(self, sender: str, request: plugin_request_t) -> None:
        action = cast(Action, PLUGIN_ACTIONS[request.action])
        try:
            for entry in self._lifecycle.hosts(action, request.names):
                self._lifecycle.request(action, entry, 0)
        except RequestError as error:
            self.refused.append(f"{sender} wants to {action} {', '.join(request.names)}; refused: {error}")


class _Host:
    """A host as the lifecycle sees it."""

    def __init__(self, index: int, name: str) -> None:
        self.index, self.name = index, name
        self.state = _STOPPED
        self.wanted = self.again = self.fresh_code = False
        self.incarnation = 0

    @property
    def stays(self) -> bool:
        """Whether the host runs and neither stops nor restarts."""
        return self.state == _RUNNING and self.wanted and not self.again

    def want_stop(self, _now_us: int) -> None:
        self.wanted = self.again = False

    def want_start(self, _now_us: int) -> None:
        self.again = self.again or (self.state == _RUNNING and not self.wanted)
        self.wanted = True

    def want_restart(self, _now_us: int) -> None:
        self.wanted = self.again = True
