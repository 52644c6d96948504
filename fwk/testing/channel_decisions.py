"""Dynamic channels on the test bench: requests are decided between two ticks, as in a run."""

from collections.abc import Iterator, Mapping, Sequence

from fwk.engine.channel_grants import ChannelGrants
from fwk.engine.runner import Runner
from fwk.lcm import messages
from fwk.model.channel_table import ChannelTable, Fact
from fwk.model.plan import Plan


class ChannelDecisions:
    """Decides the requests of the components of a plan; `sent` has every message so far, by channel."""

    def __init__(self, plan: Plan, runners: Mapping[str, Runner], sent: dict[str, list[bytes]]) -> None:
        self._runners = {each.index: runners[each.name] for each in plan.components if each.opens}
        self._sent = sent
        self._grants = ChannelGrants(plan)
        self._table = ChannelTable(plan)
        self.types: dict[str, type[messages.Message]] = {}
        """Types of the opened channels, by name."""
        for component in plan.components:
            self._grants.came(component.index, 1)
        for runner in self._runners.values():
            runner.blackboard._first(self._table)

    def ask(self, tick: int, place: int, runner: Runner) -> None:
        """Takes the requests of an iteration."""
        requests = runner.blackboard._take()
        if requests:
            self._grants.ask(tick, place, runner.name, requests)

    def decide(self) -> Iterator[tuple[str, str, int]]:
        """Decides between two ticks; yields component, channel, index of its first message; -1: it ceases to read."""
        if not self._grants.asked:
            return
        facts, _ = self._grants.decide()
        for fact in map(self._numbered, facts):
            events = self._table.apply([fact])
            for index, runner in self._runners.items():
                done = runner.blackboard._take_over(self._table, index, fact, events)
                if done and fact.channel:
                    sent, begins = self._sent[fact.channel.name], fact.channel.begins
                    alike = [place for place, data in enumerate(sent) if data.startswith(begins)]
                    yield runner.name, fact.channel.name, [len(sent), *alike][-1] if done == "opened" else -1

    def _numbered(self, fact: Fact) -> Fact:
        if not fact.channel:
            return fact
        name, begins = fact.channel.name, fact.channel.begins
        self._sent.setdefault(name, [])
        self.types[name] = messages.type_named(fact.channel.type_name)
        return fact.numbered(_newest_of(begins, self._sent[name]))


def _newest_of(begins: bytes, sent: Sequence[bytes]) -> int:
    """Returns the sequence number of the newest message of a type."""
    return next((messages.sequence_of(data) for data in reversed(sent) if data.startswith(begins)), 0)
