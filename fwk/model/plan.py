"""The plan: components, channels, hosts, stages and time as plain data."""

from dataclasses import dataclass, field
from typing import Any, Literal

from fwk.model.names import LINES
from fwk.model.sections import LogPlan, RecordPlan, RestartPolicy, RunsPlan
from fwk.model.service_channels import OUTSIDE, client_of

NOBODY = -1
"""As a channel's writer: no component of the plan."""


@dataclass(frozen=True)
class ComponentPlan:
    """A component of the plan."""

    index: int
    name: str
    module: str
    class_name: str
    stages: tuple[int, ...]
    config: dict[str, Any]
    """Effective values of all settings."""
    origins: dict[str, str]
    """Dotted name of a setting to the origin of its value: `launch/robot.yaml:41`, `default`, `--set`."""
    channels: dict[str, tuple[str, ...]]
    """Port attribute to channel names."""
    host: int
    restart: RestartPolicy = field(default_factory=RestartPolicy)
    ready_timeout_s: float | None = None
    """Wall time within which its host must become ready; None: no limit."""
    stop_timeout_s: float | None = None
    """Wall time within which its host must end when it is stopped during the run; None: no limit."""
    needs: tuple[int, ...] = ()
    """Indices of components that must be ready before this one starts, including providers of its aspects."""
    rate_hz: float | None = None
    """Rate of a continuous component; 0: one iteration for each newer input. None: it iterates in stages."""
    every: int = 1
    """The component iterates in the ticks with `tick % every == offset % every`."""
    offset: int = 0
    start: bool = True
    """Whether it starts with the run; otherwise it is started by request."""
    memory_limit_mb: float | None = None
    """Memory that it may use beyond that of its process at the start; None: no limit."""
    opens: bool = False
    """Whether it may open channels during the run."""

    def due(self, tick: int) -> bool:
        """Returns whether it iterates in a tick."""
        return self.every == 1 or tick % self.every == self.offset % self.every

    @property
    def namespace(self) -> str:
        """Part of the name before the last slash."""
        return self.name.rpartition("/")[0]


@dataclass(frozen=True)
class ChannelPlan:
    """A channel of the plan."""

    index: int
    name: str
    type_name: str
    writer: int
    """Index of the component that writes it. `NOBODY`: a channel of `Plan.outside` is written by programs outside; the
    writer of any other channel was left out of the run, and its readers never see a value."""
    readers: tuple[int, ...]
    images: bool = False
    """Whether its frames are in a shared-memory ring."""

    @property
    def of_tools(self) -> bool:
        """Whether it carries requests of tools, sent by `fwk call`."""
        return self.writer == NOBODY and client_of(self.name) == OUTSIDE


@dataclass(frozen=True)
class HostPlan:
    """A host process and its components."""

    index: int
    name: str
    components: tuple[int, ...]


@dataclass(frozen=True)
class ModulePlan:
    """A module of the application as it was when the plan was made."""

    file: str
    sha256: str
    """First 16 hexadecimal digits of the hash of its file."""


@dataclass(frozen=True)
class Plan:
    """Everything that the processes of a run need to know."""

    name: str
    file: str
    folders: tuple[str, ...]
    """Folders of the components' modules and .lcm files, besides the installed ones."""
    stages: tuple[str, ...]
    period_us: int
    clock: Literal["simulated", "wall"]
    seed: int
    components: tuple[ComponentPlan, ...]
    channels: tuple[ChannelPlan, ...]
    hosts: tuple[HostPlan, ...]
    speed: float = 1.0
    """Logical seconds per wall second; 0: as fast as possible."""
    stage_time_us: int = 0
    """Longest duration of a stage; 0: the period in real time, no limit in lockstep."""
    loop_time_us: int = 0
    """Desired wall time of a tick; 0: the period at the run's speed."""
    loop_time_warnings: bool = True
    """Whether the log names ticks and iterations that take too long."""
    bus_port: int = 17700
    spare_channels: int = 0
    """Number of channels that can be opened during the run, besides those of the plan."""
    public_url: str = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304"
    outside: dict[str, str] = field(default_factory=dict)
    """Channels that programs outside may write on the public bus: name to type."""
    cores: Literal["any", "namespace"] = "any"
    """Processors of the hosts: any, or one for each namespace, in turn."""
    scoreboard: str = ""
    """`module:function` that makes the display's headline from the newest messages."""
    scoreboard_channels: tuple[str, ...] = ()
    """Channels whose newest messages the scoreboard gets: those that match `CHANNELS` of its module."""
    video: str = ""
    """`module:function` that draws the top view of a recording."""
    evaluation: str = ""
    """`module:function` that plays the launch file and measures it; its module has `report`."""
    log: LogPlan = field(default_factory=LogPlan)
    runs: RunsPlan = field(default_factory=RunsPlan)
    record: RecordPlan = field(default_factory=RecordPlan)
    modules: dict[str, ModulePlan] = field(default_factory=dict)
    """Modules of the components, and those of the application that they import, by name."""
    blas_kernel: str = ""
    """Name of the processor-specific kernel of OpenBLAS; empty: none was loaded."""

    def writer_of(self, channel: ChannelPlan) -> str:
        """Returns the name of a channel's writer as it is shown; empty if there is none."""
        if channel.writer != NOBODY:
            return self.components[channel.writer].name
        if channel.of_tools:
            return "fwk call"
        return "programs outside" if channel.name in self.outside else "gateway" if channel.name == LINES else ""

    def memory_limit_mb(self, host: int) -> float | None:
        """Returns the memory limit of a host: the sum of its components' limits; None if one of them has no limit."""
        limits = [self.components[index].memory_limit_mb for index in self.hosts[host].components]
        return None if None in limits else sum(limit for limit in limits if limit)
