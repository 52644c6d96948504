"""Translates requests such as `restart cyan1/*` into desired states of host processes, or refuses them."""

from collections.abc import Mapping, Sequence
from typing import Any, Generic, Protocol, TypeVar, cast

from fwk.control.dependents import users_of, with_needs, with_users
from fwk.control.requests import Action, RequestError
from fwk.model.errors import some
from fwk.model.plan import NOBODY, Plan
from fwk.model.requests import PLUGIN_ACTIONS
from fwk.model.selection import matches, nearest
from fwk.plan.files.source_files import Sources, mistakes
from fwk.supervisor.core import Core
from fwk.supervisor.host_process import HostProcess
from fwk.supervisor.processes.hosts import Hosts
from lcmtypes.core import plugin_request_t

_NAMES_MAX = 5
"""Number of components that a refusal names."""
_STOPS = ("stop", "unload", "kill")
_STARTS_AGAIN = ("start", "restart", "reload")
_RUNNING = ("starting", "running", "waiting")
_LOADED = "; only components of the launch file can be loaded, also those with 'start: false'"


class Managed(Protocol):
    """A host with a desired state."""

    index: int
    wanted: bool
    fresh_code: bool

    @property
    def name(self) -> str:
        """Name for messages."""

    @property
    def state(self) -> str:
        """State of the host."""

    def want_stop(self, now_us: int) -> None:
        """Wants the host to stop."""

    def want_start(self, now_us: int) -> None:
        """Wants the host to run."""

    def want_restart(self, now_us: int) -> None:
        """Wants the host to start anew."""


H = TypeVar("H", bound=Managed)


class Lifecycle(Generic[H]):
    """Turns requests for components into desired states of their hosts."""

    def __init__(self, plan: Plan, table: Sequence[H]) -> None:
        self._plan = plan
        self._table = table
        self._sources = Sources(plan)

    def components(self, patterns: Sequence[str]) -> list[int]:
        """Returns the indices of the components that match patterns.

        Raises:
            RequestError: a pattern matches no component.
        """
        names = [component.name for component in self._plan.components]
        for pattern in patterns:
            if not any(matches(name, pattern) for name in names):
                raise RequestError(f"no component '{pattern}'; {nearest(pattern, names)}")
        return [index for index, name in enumerate(names) if any(matches(name, pattern) for pattern in patterns)]

    def component(self, name: str) -> int:
        """Returns the index of the component with exactly this name.

        Raises:
            RequestError: there is no such component.
        """
        names = [component.name for component in self._plan.components]
        if name not in names:
            raise RequestError(f"no component '{name}'; {nearest(name, names)}")
        return names.index(name)

    def hosts(self, action: Action, patterns: Sequence[str], force: bool = False) -> list[H]:
        """Returns the hosts concerned; with `force`, stopping and unloading include the components that need them.

        Raises:
            RequestError: the request cannot be granted; names the components that prevent it.
        """
        if not patterns:
            raise RequestError(f"{action}: no components given; name some, or patterns such as 'cyan1/*'")
        try:
            chosen, components = self.components(patterns), self._plan.components
        except RequestError as error:
            raise RequestError(f"{error}{_LOADED if action == 'load' else ''}") from error
        if action == "load":
            chosen = [index for index in with_needs(chosen, components) if index in chosen or not self._runs(index)]
        elif action in ("stop", "unload") and force:
            chosen = [index for index in with_users(chosen, components) if index in chosen or self._runs(index)]
        elif action == "unload":
            self._check_users(chosen)
        elif action in _STARTS_AGAIN:
            self.check_needs(chosen)
        if action == "reload":
            self._check_code(chosen)
        entries = {self._plan.components[index].host: self._entry(index) for index in chosen}
        self._check_whole(action, chosen, entries)
        return list(entries.values())

    def request(self, action: Action, entry: H, now_us: int) -> None:
        """Sets the desired state of a host."""
        if action in _STOPS:
            entry.want_stop(now_us)
        elif action in ("start", "load"):
            entry.want_start(now_us)
        else:
            entry.fresh_code = entry.fresh_code or action == "reload"
            entry.want_restart(now_us)

    def left_without(self, entries: Sequence[H]) -> list[dict[str, Any]]:
        """Returns the channels that lose their writer when these hosts end, each with its remaining readers."""
        hosts = {entry.index for entry in entries}
        found = []
        for channel in self._plan.channels:
            if channel.writer == NOBODY or self._plan.components[channel.writer].host not in hosts:
                continue
            readers = [
                index for index in channel.readers if self._entry(index).index not in hosts and self._runs(index)
            ]
            if readers:
                found.append({"channel": channel.name, "readers": [self._name(index) for index in readers]})
        return found

    def _entry(self, index: int) -> H:
        return self._table[self._plan.components[index].host]

    def _runs(self, index: int) -> bool:
        entry = self._entry(index)
        return entry.wanted and entry.state in _RUNNING

    def _name(self, index: int) -> str:
        return self._plan.components[index].name

    def check_needs(self, chosen: Sequence[int]) -> None:
        """Checks that all needs of these components run.

        Raises:
            RequestError: a needed component does not run; names the command that helps.
        """
        for index in chosen:
            missing = [
                each for each in self._plan.components[index].needs if each not in chosen and not self._runs(each)
            ]
            if missing:
                name, needed = self._name(index), ", ".join(map(self._name, missing))
                raise RequestError(f"{name} needs {needed}, which does not run; 'fwk load {name}' starts both")

    def _check_users(self, chosen: Sequence[int]) -> None:
        for index in chosen:
            users = [each for each in users_of(index, self._plan.components) if each not in chosen and self._runs(each)]
            if users:
                name, by = self._name(index), " ".join(map(self._name, users))
                more = f"fwk unload {name} {by}, or fwk unload --force {name}"
                raise RequestError(f"{name} is needed by {by}; unload them too: {more}")

    def _check_code(self, chosen: Sequence[int]) -> None:
        """Refuses files with syntax errors while the old code still runs."""
        files = {file for index in chosen for file in self._sources.files(self._plan.components[index])}
        if found := mistakes(files):
            names = ", ".join(self._name(index) for index in chosen)
            raise RequestError(f"{'; '.join(found)}; not reloaded, so the old code continues: {names}")

    def _check_whole(self, action: Action, chosen: Sequence[int], entries: Mapping[int, H]) -> None:
        """Refuses to start or stop a part of a process."""
        for host, entry in entries.items():
            others = [self._name(index) for index in self._plan.hosts[host].components if index not in chosen]
            if others:
                raise RequestError(
                    f"the process '{entry.name}' holds {some(others, _NAMES_MAX)} as well; {action} all of them, "
                    "or give each component its own process with --hosting process"
                )


class PluginRequests:
    """Grants requests of the plugin-control aspect."""

    def __init__(self, core: Core, hosts: Hosts, lifecycle: Lifecycle[HostProcess]) -> None:
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
