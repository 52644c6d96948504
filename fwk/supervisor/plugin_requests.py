"""Requests of components to start and stop other components, granted at boundaries."""

from typing import cast

from fwk.control.requests import Action, RequestError
from fwk.model.requests import PLUGIN_ACTIONS
from fwk.supervisor.core import Core
from fwk.supervisor.lifecycle import Lifecycle
from fwk.supervisor.processes.hosts import Hosts
from lcmtypes.core import plugin_request_t


class PluginRequests:
    """Grants requests of the plugin-control aspect."""

    def __init__(self, core: Core, hosts: Hosts, lifecycle: Lifecycle) -> None:
        self._core = core
        self._hosts = hosts
        self._lifecycle = lifecycle

    def decide(self, request: plugin_request_t) -> None:
        """Sets the desired states that a component requests; a refused request is logged."""
        sender = self._core.plan.components[request.component].name
        action = cast(Action, PLUGIN_ACTIONS[request.action])
        try:
            hosts = self._lifecycle.hosts(action, request.names)
        except RequestError as error:
            self._core.log.warning(f"{sender} wants to {action} {', '.join(request.names)}; refused: {error}")
            return
        for host in hosts:
            self._lifecycle.request(action, host, self._core.now_us())
            self._hosts.request(host)
        self._core.log.info(f"{sender} asked to {action} {', '.join(host.name for host in hosts)}")
