"""What a plan says: components, channels, hosts, stages, time; plain data that can be written down and read back."""

import dataclasses
from dataclasses import dataclass, field
from typing import Any, Literal

from fwk.model.names import LINES

NOBODY = -1
"""As a channel's writer: no component of the plan."""

RestartWhen = Literal["never", "on-failure", "always"]


@dataclass(frozen=True)
class RestartPolicy:
    """When a component that ended is started again: at most `limit` times in `window_s`, waiting longer each time."""

    when: RestartWhen = "on-failure"
    backoff_s: float = 0.1
    limit: int = 5
    window_s: float = 60.0


@dataclass(frozen=True)
class ComponentPlan:
    """One component of the plan."""

    index: int
    name: str
    module: str
    class_name: str
    stages: tuple[int, ...]
    config: dict[str, Any]
    """Effective settings, every one."""
    origins: dict[str, str]
    """Setting, dotted, to where its value comes from: `launch/robot.yaml:41`, `default`, `--set`."""
    channels: dict[str, tuple[str, ...]]
    """Port attribute to channel names."""
    host: int
    restart: RestartPolicy = RestartPolicy()
    ready_timeout_s: float | None = None
    """Wall time in which its host has to become ready; None: no limit."""
    stop_timeout_s: float | None = None
    """Wall time in which its host has to end when it is stopped while the run goes on; None: no limit."""
    needs: tuple[int, ...] = ()
    """Indices of components that have to be ready before this one starts, whoever grants it an aspect among them."""
    rate_hz: float | None = None
    """Of a continuous component, which takes part in no stage; 0: as often as there is something newer."""
    start: bool = True
    """Whether it starts with the run; otherwise it waits until somebody asks for it."""
    memory_limit_mb: float | None = None
    """Memory that it may take beyond what its process begins with; None: as much as there is."""

    opens: bool = False
    """Whether it may open channels while it runs."""

    @property
    def namespace(self) -> str:
        """Everything before the last slash of the name."""
        return self.name.rpartition("/")[0]


@dataclass(frozen=True)
class ChannelPlan:
    """One channel: an instance of an interface."""

    index: int
    name: str
    type_name: str
    writer: int
    """Index of the component that writes it. `NOBODY`: programs outside write it, if it is one of `Plan.outside`;
    otherwise its writer was left out of the run, and its readers never see a value."""
    readers: tuple[int, ...]
    images: bool = False
    """Whether frames lie in a shared-memory ring beside it."""

    @property
    def of_tools(self) -> bool:
        """Whether it carries commands of tools, which `fwk call` sends."""
        return self.writer == NOBODY and self.name.endswith("@outside")


@dataclass(frozen=True)
class HostPlan:
    """One process and the components in it."""

    index: int
    name: str
    components: tuple[int, ...]


@dataclass(frozen=True)
class LogPlan:
    """Where lines of text go: each target with the lowest level that it takes, or `off`."""

    console: str = "info"
    file: str = "debug"
    json_lines: str = "debug"
    bus: str = "debug"
    recording: str = "debug"
    syslog: str = "off"
    syslog_to: str = "/dev/log"
    """Path of the daemon's socket, or `ADDRESS:PORT`."""
    file_mb: float = 16.0
    files: int = 4
    lines_per_s: int = 200


@dataclass(frozen=True)
class RunsPlan:
    """How many run directories stay when a run begins, and how large they may be together; 0: any."""

    keep: int = 100
    size_gb: float = 20.0


@dataclass(frozen=True)
class RecordPlan:
    """What the recording has besides all messages."""

    frames: tuple[str, ...] = ()
    """Channels of cameras whose frames are recorded."""


@dataclass(frozen=True)
class Plan:
    """Everything that processes of a run have to know."""

    name: str
    file: str
    folders: tuple[str, ...]
    """Where the components' modules and .lcm files are found, besides the installed ones."""
    stages: tuple[str, ...]
    period_us: int
    clock: Literal["simulated", "wall"]
    seed: int
    components: tuple[ComponentPlan, ...]
    channels: tuple[ChannelPlan, ...]
    hosts: tuple[HostPlan, ...]
    speed: float = 1.0
    """Logical seconds per wall second; 0: as fast as it goes."""
    stage_time_us: int = 0
    """How long a stage may take; 0: in real time the period, in lockstep as long as it takes."""
    loop_time_us: int = 0
    """Desired wall time of a tick; 0: the period at the run's speed."""
    loop_time_warnings: bool = True
    """Whether a tick that takes longer is said, and a component that takes longer than a stage may."""
    bus_port: int = 17700
    spare_channels: int = 0
    """How many channels can be opened while the run goes on, besides those of the plan."""
    public_url: str = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304"
    outside: dict[str, str] = field(default_factory=dict)
    """Channels that may be written on the public bus: name to type."""
    scoreboard: str = ""
    """`module:function` that makes the display's headline of the newest messages."""
    scoreboard_channels: tuple[str, ...] = ()
    """Channels whose newest messages the scoreboard gets: those that fit `CHANNELS` of its module."""
    video: str = ""
    """`module:function` that draws the top view of a recording."""
    log: LogPlan = LogPlan()
    runs: RunsPlan = RunsPlan()
    record: RecordPlan = RecordPlan()

    def writer_of(self, channel: ChannelPlan) -> str:
        """Who writes a channel, in a word; empty: nobody does."""
        if channel.writer != NOBODY:
            return self.components[channel.writer].name
        if channel.of_tools:
            return "fwk call"
        return "programs outside" if channel.name in self.outside else "gateway" if channel.name == LINES else ""

    def memory_limit_mb(self, host: int) -> float | None:
        """Memory that a process may take: what its components may together; None if one of them has no limit."""
        limits = [self.components[index].memory_limit_mb for index in self.hosts[host].components]
        return None if None in limits else sum(limit for limit in limits if limit)

    def to_json(self) -> dict[str, Any]:
        """Plain data for JSON."""
        return dataclasses.asdict(self)

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> "Plan":
        """Reads back what `to_json` gave."""
        components = tuple(
            ComponentPlan(
                **{
                    **item,
                    "stages": tuple(item["stages"]),
                    "channels": {port: tuple(names) for port, names in item["channels"].items()},
                    "restart": RestartPolicy(**item["restart"]),
                    "needs": tuple(item["needs"]),
                }
            )
            for item in data["components"]
        )
        channels = tuple(ChannelPlan(**{**item, "readers": tuple(item["readers"])}) for item in data["channels"])
        hosts = tuple(HostPlan(**{**item, "components": tuple(item["components"])}) for item in data["hosts"])
        simple = {
            "folders": tuple(data["folders"]),
            "stages": tuple(data["stages"]),
            "scoreboard_channels": tuple(data.get("scoreboard_channels", ())),
            "log": LogPlan(**data.get("log", {})),
            "runs": RunsPlan(**data.get("runs", {})),
            "record": RecordPlan(tuple(data.get("record", {}).get("frames", ()))),
        }
        return cls(**{**data, **simple, "components": components, "channels": channels, "hosts": hosts})
