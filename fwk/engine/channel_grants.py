"""Decides requests for dynamic channels at boundaries, in one order."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any, Literal

from fwk.lcm import messages
from fwk.model.channel_table import BlackboardEvent, ChannelState, ChannelTable, Fact, OpenChannel
from fwk.model.plan import NOBODY, Plan


@dataclass(frozen=True)
class _Request:
    """Request of a component; `what` is read, write, each or close. A close has a handle only."""

    component: int
    what: str
    handle: int
    name: str = ""
    type_name: str = ""
    fingerprint: str = ""


class ChannelGrants:
    """Decides requests for dynamic channels; all processes that apply its facts have the same channel table."""

    def __init__(self, plan: Plan) -> None:
        self.table = ChannelTable(plan)
        self._plan = plan
        self._last = len(plan.channels) + plan.spare_channels
        self._index = {component.name: component.index for component in plan.components}
        self._types = {channel.name: channel.type_name for channel in plan.channels}
        self._frames = {channel.name for channel in plan.channels if channel.images}
        self._requests: list[tuple[tuple[int, int, int, int], _Request]] = []
        self._patterns: list[_Request] = []  # of components that want every channel that fits
        self._came: dict[int, int] = {}  # component to the number of the incarnation that came
        self._going: set[int] = set()
        self._there: dict[int, int] = {}

    @property
    def asked(self) -> bool:
        """Whether there are requests or changes of presence to decide."""
        return bool(self._requests) or bool(self._going) or self._came != self._there

    def ask(self, tick: int, place: int, name: str, requests: Sequence[Sequence[Any]]) -> None:
        """Takes the requests that a component made in its iteration at a step of a tick."""
        component = self._index[name]
        for order, request in enumerate(requests):
            self._requests.append(((tick, place, component, order), _Request(component, *request)))

    def came(self, component: int, incarnation: int) -> None:
        """Notes that a component takes part from now on."""
        self._came[component] = incarnation

    def left(self, component: int) -> None:
        """Notes that a component takes no part any more, and drops its requests."""
        self._came.pop(component, None)
        self._going.add(component)
        self._requests = [request for request in self._requests if request[1].component != component]

    def decide(self, busy: Callable[[int], bool] = lambda _: False) -> tuple[list[Fact], list[BlackboardEvent]]:
        """Decides at a boundary; returns the facts, and the blackboard events that follow from them.

        A component that is `busy` with an iteration of an earlier tick, or with finalizing, is served
        afterwards: its last messages still count.
        """
        self._facts: list[Fact] = []
        self._events: list[BlackboardEvent] = []
        self._going = {component for component in self._going if component in self._there}
        for component in sorted(self._going):
            if not busy(component):
                self._going.discard(component)
                self._patterns = [each for each in self._patterns if each.component != component]
                del self._there[component]
                self._add(Fact("go", component))
        for component in sorted(self._came.keys() - self._there.keys()):
            self._there[component] = self._came[component]
            self._add(Fact("come", component))
        later = []
        for key, request in sorted(self._requests, key=lambda pair: pair[0]):
            if busy(request.component) or request.component in self._going:
                later.append((key, request))
            elif request.component in self._there:
                self._grant(request)
        self._requests = later
        self._follow_patterns()
        return self._facts, self._events

    def _add(self, fact: Fact) -> None:
        self._facts.append(fact)
        self._events += self.table.apply([fact])

    def _grant(self, request: _Request) -> None:
        if request.what == "close":
            self._patterns = [
                each for each in self._patterns if (each.component, each.handle) != (request.component, request.handle)
            ]
            for fact in self.table.opened_by(request.component):
                if fact.handle == request.handle:
                    self._add(fact)
        elif request.what == "each":
            self._patterns.append(request)
        else:
            reason = self._against(request)
            if reason:
                self._add(Fact("refuse", request.component, request.handle, reason=reason))
            else:
                kind: Literal["read", "write"] = "write" if request.what == "write" else "read"
                self._add(Fact(kind, request.component, request.handle, self._open_channel(request)))

    def _open_channel(self, request: _Request) -> OpenChannel:
        index = self.table.index_of(request.name, request.fingerprint)
        number = self.table.known if index is None else index
        return OpenChannel(
            request.component, request.handle, number, request.name, request.type_name, request.fingerprint
        )

    def _against(self, request: _Request) -> str:
        """Returns the reason for which a request is refused; empty: it is granted."""
        state = self.table.find(request.name)
        asking = self._plan.components[request.component].name
        if state is None:
            if self.table.index_of(request.name, request.fingerprint) is None and self.table.known >= self._last:
                return (
                    f"{request.name}: all {self._plan.spare_channels} spare channels are in use; "
                    "set 'spare_channels: N' in the launch file for more"
                )
            return ""
        if request.name in self._frames:
            return f"{request.name}: its frames are in shared memory; annotate with Image instead"
        if self._fingerprint(state) != request.fingerprint:
            whose = self._whose(state)
            return (
                f"{request.name}: {asking} wants it as {request.type_name} ({request.fingerprint}), but it is "
                f"{state.type_name} ({self._fingerprint(state)}){whose}"
            )
        if request.what == "write":
            if state.declared:
                writer = state.declared_writer
                names = self.table.names
                who = f"{names[writer]} is its writer" if writer != NOBODY else "programs outside write it"
                return f"{request.name}: {who} by the plan; {asking} can only read it"
            if state.writer:
                return f"{request.name}: {self.table.names[state.writer[0]]} is its writer; {asking} has to wait"
        return ""

    def _fingerprint(self, state: ChannelState) -> str:
        return state.fingerprint or messages.fingerprint(messages.type_named(state.type_name)).hex()

    def _whose(self, state: ChannelState) -> str:
        """Returns which component has a channel open, as part of a sentence."""
        names = self.table.names
        if state.declared:
            owner = state.declared_writer if state.declared_writer != NOBODY else None
        else:
            owner = state.writer[0] if state.writer else state.readers[0][0] if state.readers else None
        return f" to {names[owner]}" if owner is not None else ""

    def _follow_patterns(self) -> None:
        """Opens channels that match the patterns of components, and closes those that only patterns keep open."""
        many = {(request.component, request.handle) for request in self._patterns}
        for state in self.table.matching("*"):
            alone = not state.declared and not state.writer and not set(state.readers) - many
            if alone:
                for component, handle in list(state.readers):
                    closing = [each for each in self.table.opened_by(component) if each.handle == handle]
                    for fact in closing:
                        if fact.channel and fact.channel.name == state.name:
                            self._add(fact)
                continue
            for request in self._patterns:
                key = (request.component, request.handle)
                fits = fnmatchcase(state.name, request.name) and key not in state.readers
                if fits and self._fingerprint(state) == request.fingerprint and state.name not in self._frames:
                    opened = OpenChannel(*key, state.index, state.name, request.type_name, request.fingerprint)
                    self._add(Fact("read", *key, opened))
