"""Events of host processes, exchanged by the parts of a supervisor."""

from dataclasses import dataclass

from fwk.supervisor.host_process import HostProcess


@dataclass(frozen=True)
class HostReady:
    """All components of a host are initialised: it takes part in the loop from now on."""

    host: HostProcess


@dataclass(frozen=True)
class HostEnded:
    """The process of a host ended without a request."""

    host: HostProcess


@dataclass(frozen=True)
class HostLeaves:
    """A host leaves the loop on request; it finalizes its components and may still send a final done."""

    host: HostProcess
