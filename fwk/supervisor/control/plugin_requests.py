"""What components ask to be done with other components: collected during a tick, granted between two."""

from collections.abc import Callable
from typing import cast

from fwk.bus.sync import place_of
from fwk.component.log import Logger
from fwk.control.requests import Action, RequestError
from fwk.model.plan import Plan
from fwk.model.requests import PLUGIN_ACTIONS
from fwk.supervisor.control.lifecycle import Steering
from fwk.supervisor.processes.hosts import Hosts
from lcmtypes.core import done_t

_Wish = tuple[tuple[int, int, str, int], Action, list[str]]
"""Tick, place in it, name of who asks, number; what; names."""


class Directing:
    """Grants wishes in one order, whichever came first: by tick, place in the tick, and name."""

    def __init__(self, plan: Plan, hosts: Hosts, steering: Steering, now_us: Callable[[], int], log: Logger) -> None:
        self._names = [component.name for component in plan.components]
        self._hosts = hosts
        self._steering = steering
        self._now_us = now_us
        self._log = log
        self._wishes: list[_Wish] = []

    def ask(self, done: done_t) -> None:
        """Takes the requests to start and stop components in a done."""
        for number, request in enumerate(done.plugins):
            name = self._names[request.component]
            key = (done.tick, place_of(done), name, number)
            self._wishes.append((key, cast(Action, PLUGIN_ACTIONS[request.action]), list(request.names)))

    def decide(self) -> None:
        """At a boundary: what can be granted is begun, the rest is refused in the log."""
        wishes, self._wishes = sorted(self._wishes), []
        for (_, _, name, _), action, names in wishes:
            try:
                entries = self._steering.hosts(action, names)
            except RequestError as error:
                self._log.warning(f"{name} wants to {action} {', '.join(names)}; refused: {error}")
                continue
            for entry in entries:
                self._steering.wish(action, entry, self._now_us())
                self._hosts.asked.add(entry.index)
            self._log.info(f"{name} asked to {action} {', '.join(entry.name for entry in entries)}")
