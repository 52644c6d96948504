"""Names the components that the run waits for: to tools at once, in the log after a second and repeatedly."""

from collections.abc import Callable, Iterable, Sequence

from fwk.clock import US_PER_S
from fwk.component.log import Logger
from fwk.model.errors import some
from fwk.supervisor.host_process import HostProcess

SHORT_US = 200_000
"""A shorter wait is not reported."""
FIRST_LINE_US = US_PER_S
LONGEST_PAUSE_US = 10 * US_PER_S
"""Longest time between two lines about the same wait."""
_NAMES_MAX = 5


class WaitReport:
    """The present wait, if it is a long one; `component_of` names the component that a host executes."""

    def __init__(self, now_us: Callable[[], int], component_of: Callable[[HostProcess], str], log: Logger) -> None:
        self._now_us = now_us
        self._component_of = component_of
        self._log = log
        self._began_us = 0
        self._hosts: Sequence[HostProcess] = ()
        self._line_us = 0  # wall time of the next line about it

    @property
    def hosts(self) -> list[HostProcess]:
        """Hosts that have been waited for longer than a moment."""
        return list(self._hosts) if self._now_us() >= self._began_us + SHORT_US else []

    @property
    def components(self) -> list[str]:
        """Names of the components that those hosts execute."""
        return [self._component_of(host) for host in self.hosts]

    def waiting(self, began_us: int, hosts: Iterable[HostProcess], subject: str) -> None:
        """Notes that `subject`, such as "tick 7", waits for hosts since the wall time `began_us`."""
        now_us = self._now_us()
        if began_us != self._began_us:
            self._began_us, self._line_us = began_us, began_us + FIRST_LINE_US
        self._hosts = tuple(hosts)
        if now_us >= self._line_us and self._hosts:
            waited_us = now_us - began_us
            self._log.warning(f"{subject} has waited {waited_us / US_PER_S:.0f} s for {self._names()}")
            self._line_us = now_us + min(waited_us, LONGEST_PAUSE_US)

    def ended(self) -> None:
        """Notes the end of the wait."""
        self._hosts = ()

    def _names(self) -> str:
        return some([self._component_of(host) for host in self._hosts], _NAMES_MAX)
