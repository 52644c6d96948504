"""Decides requests for dynamic channels at boundaries, in one order."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any, Literal

from fwk.lcm import messages
from fwk.model.channel_table import BlackboardEvent, ChannelTable, Fact, Instance, Opening
from fwk.model.plan import NOBODY, Plan


@dataclass(frozen=True)
class _Wish:
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
        self.instances = ChannelTable(plan)
        self._plan = plan
        self._last = len(plan.channels) + plan.spare_channels
        self._index = {component.name: component.index for component in plan.components}
        self._types = {channel.name: channel.type_name for channel in plan.channels}
        self._frames = {channel.name for channel in plan.channels if channel.images}
        self._wishes: list[tuple[tuple[int, int, int, int], _Wish]] = []
        self._patterns: list[_Wish] = []  # of components that want every channel that fits
        self._came: dict[int, int] = {}  # component to the number of the incarnation that came
        self._going: set[int] = set()
        self._there: dict[int, int] = {}

    @property
    def asked(self) -> bool:
        """Whether there are requests or changes of presence to decide."""
        return bool(self._wishes) or bool(self._going) or self._came != self._there

    def ask(self, tick: int, place: int, name: str, wishes: Sequence[Sequence[Any]]) -> None:
        """Takes the requests that a component made in its iteration at a step of a tick."""
        component = self._index[name]
        for order, wish in enumerate(wishes):
            self._wishes.append(((tick, place, component, order), _Wish(component, *wish)))

    def came(self, component: int, incarnation: int) -> None:
        """Notes that a component takes part from now on."""
        self._came[component] = incarnation

    def left(self, component: int) -> None:
        """Notes that a component takes no part any more, and drops its requests."""
        self._came.pop(component, None)
        self._going.add(component)
        self._wishes = [wish for wish in self._wishes if wish[1].component != component]

    def decide(self, busy: Callable[[int], bool] = lambda _: False) -> tuple[list[Fact], list[BlackboardEvent]]:
        """Decides at a boundary; returns the facts, and the blackboard events that follow from them.

        A component that is `busy` with an iteration of an earlier tick, or with finalizing, is served afterwards: what
        it writes meanwhile still counts.
        """
        self._facts: list[Fact] = []
        self._events: list[BlackboardEvent] = []
        self._going = {component for component in self._going if component in self._there}
        for component in sorted(self._going):
            if not busy(component):
                self._going.discard(component)
                self._patterns = [each for each in self._patterns if each.component != component]
                del self._there[component]
                self._state(Fact("go", component))
        for component in sorted(self._came.keys() - self._there.keys()):
            self._there[component] = self._came[component]
            self._state(Fact("come", component))
        later = []
        for key, wish in sorted(self._wishes, key=lambda pair: pair[0]):
            if busy(wish.component) or wish.component in self._going:
                later.append((key, wish))
            elif wish.component in self._there:
                self._grant(wish)
        self._wishes = later
        self._follow_patterns()
        return self._facts, self._events

    def _state(self, fact: Fact) -> None:
        self._facts.append(fact)
        self._events += self.instances.apply([fact])

    def _grant(self, wish: _Wish) -> None:
        if wish.what == "close":
            self._patterns = [
                each for each in self._patterns if (each.component, each.handle) != (wish.component, wish.handle)
            ]
            for fact in self.instances.opened_by(wish.component):
                if fact.handle == wish.handle:
                    self._state(fact)
        elif wish.what == "each":
            self._patterns.append(wish)
        else:
            reason = self._against(wish)
            if reason:
                self._state(Fact("refuse", wish.component, wish.handle, reason=reason))
            else:
                kind: Literal["read", "write"] = "write" if wish.what == "write" else "read"
                self._state(Fact(kind, wish.component, wish.handle, self._opening(wish)))

    def _opening(self, wish: _Wish) -> Opening:
        index = self.instances.index_of(wish.name, wish.fingerprint)
        number = self.instances.known if index is None else index
        return Opening(wish.component, wish.handle, number, wish.name, wish.type_name, wish.fingerprint)

    def _against(self, wish: _Wish) -> str:
        """Returns the reason for which a request is refused; empty: it is granted."""
        instance = self.instances.find(wish.name)
        asking = self._plan.components[wish.component].name
        if instance is None:
            if self.instances.index_of(wish.name, wish.fingerprint) is None and self.instances.known >= self._last:
                return (
                    f"{wish.name}: all {self._plan.spare_channels} spare channels are in use; "
                    "set 'spare_channels: N' in the launch file for more"
                )
            return ""
        if wish.name in self._frames:
            return f"{wish.name}: its frames are in shared memory; annotate with Image instead"
        if self._fingerprint(instance) != wish.fingerprint:
            whose = self._whose(instance)
            return (
                f"{wish.name}: {asking} wants it as {wish.type_name} ({wish.fingerprint}), but it is "
                f"{instance.type_name} ({self._fingerprint(instance)}){whose}"
            )
        if wish.what == "write":
            if instance.declared:
                writer = instance.declared_writer
                names = self.instances.names
                who = f"{names[writer]} is its writer" if writer != NOBODY else "programs outside write it"
                return f"{wish.name}: {who} by the plan; {asking} can only read it"
            if instance.writer:
                return f"{wish.name}: {self.instances.names[instance.writer[0]]} is its writer; {asking} has to wait"
        return ""

    def _fingerprint(self, instance: Instance) -> str:
        return instance.fingerprint or messages.fingerprint(messages.type_named(instance.type_name)).hex()

    def _whose(self, instance: Instance) -> str:
        """Returns which component has a channel open, as part of a sentence."""
        names = self.instances.names
        if instance.declared:
            owner = instance.declared_writer if instance.declared_writer != NOBODY else None
        else:
            owner = instance.writer[0] if instance.writer else instance.readers[0][0] if instance.readers else None
        return f" to {names[owner]}" if owner is not None else ""

    def _follow_patterns(self) -> None:
        """Opens channels that match the patterns of components, and closes those that only patterns keep open."""
        many = {(wish.component, wish.handle) for wish in self._patterns}
        for instance in self.instances.matching("*"):
            alone = not instance.declared and not instance.writer and not set(instance.readers) - many
            if alone:
                for component, handle in list(instance.readers):
                    closing = [each for each in self.instances.opened_by(component) if each.handle == handle]
                    for fact in closing:
                        if fact.opening and fact.opening.name == instance.name:
                            self._state(fact)
                continue
            for wish in self._patterns:
                key = (wish.component, wish.handle)
                fits = fnmatchcase(instance.name, wish.name) and key not in instance.readers
                if fits and self._fingerprint(instance) == wish.fingerprint and instance.name not in self._frames:
                    opening = Opening(*key, instance.index, instance.name, wish.type_name, wish.fingerprint)
                    self._state(Fact("read", *key, opening))
