"""Changes of settings and dynamic channels: numbered, recorded, and sent to the hosts that they concern."""

from collections.abc import Iterable, Sequence

from fwk.control.settings import RunSettings
from fwk.model.channel_table import Fact
from fwk.model.plan import NOBODY
from fwk.supervisor.core import Core
from fwk.supervisor.host_process import Change, HostProcess
from fwk.supervisor.tick_log import TickLog


class Changes:
    """Makes a change part of the next tick; called at boundaries only."""

    def __init__(self, core: Core, tick_log: TickLog) -> None:
        self.newest = 0
        """Number of the newest change of the run."""
        self.settings = RunSettings(core.plan)
        self._core = core
        self._tick_log = tick_log
        self._channel_hosts = sorted({each.host for each in core.plan.components if each.opens})

    def change_settings(self, component: int, settings: str) -> Change:
        """Gives a component new settings, as JSON, from its next iteration on."""
        return self._make(component, settings, [self._core.host_of(component)])

    def change_channels(self, facts: Sequence[Fact]) -> Change:
        """Sends decisions about channels to all hosts that may open channels."""
        return self._make(NOBODY, "", [self._core.hosts[index] for index in self._channel_hosts], facts)

    def settings_of(self, host: HostProcess) -> dict[str, str]:
        """Returns the settings of a host's components that differ from the plan's: by name, as JSON."""
        return self.settings.changed(self._core.components_of(host))

    def _make(self, component: int, settings: str, hosts: Iterable[HostProcess], facts: Sequence[Fact] = ()) -> Change:
        self.newest += 1
        change = Change(component, self.newest, settings, self._core.ledger.step + 1, facts)
        self._tick_log.change(change)
        for host in hosts:
            if host.alive:
                host.changes.append(change)
        return change
