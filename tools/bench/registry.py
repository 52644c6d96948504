"""The peers: names, environments, codecs, and the processes of each."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from tools.bench import dora_flow, ros_build
from tools.bench.environments import CORE, DORA, ECAL, ICE, ROS, ZENOH, ZMQ, Environment
from tools.bench.shape import Shape

Commands = Callable[[str], list[list[str]]]
"""Shape file to the command lines to start, in order."""

LCM_GEN = "lcm-gen, Python"


@dataclass(frozen=True)
class Peer:
    """An implementation of the work of `Shape`."""

    name: str
    title: str
    environment: Environment
    codec: str
    udp: bool = False
    """Whether it moves all data by UDP, so that wasted datagrams and packet loss are meaningful."""
    bare: bool = False
    """Whether it is only a transport: a part of fwk, not a rival."""
    start: Commands | None = None
    """Command lines, unless they are one Python process for the supervisor and each component."""

    program: Path | None = None
    """Compiled program that it needs."""

    def commands(self, shape_file: str) -> list[list[str]]:
        """Returns the command lines to start."""
        if self.start:
            return self.start(shape_file)
        return python_commands(self.environment.python, self.name, shape_file)

    def missing(self) -> str:
        """Returns why it cannot be measured here; empty if it can."""
        if self.program and not self.program.exists():
            return f"{self.program.name} not built; type: make bench-peers"
        return self.environment.missing()


def python_commands(python: str, module: str, shape_file: str) -> list[list[str]]:
    """Returns one process for each component and one for the supervisor."""
    components = Shape.read(shape_file).components
    made = [[python, "-m", "tools.bench.component", module, shape_file, str(index)] for index in range(components)]
    return [*made, [python, "-m", "tools.bench.supervise", module, shape_file]]


_ROS_MASTER = [ROS.python, str(ROS.folder / "usr/bin/rosmaster"), "--core", "-p", "11311"]


def rospy_commands(shape_file: str) -> list[list[str]]:
    """Returns the master, then the nodes, which wait for it by themselves."""
    return [_ROS_MASTER, *python_commands(ROS.python, "rospy", shape_file)]


def roscpp_commands(shape_file: str) -> list[list[str]]:
    """Returns the master, then the nodes, which wait for it by themselves."""
    return [_ROS_MASTER, *ros_build.commands(shape_file)]


def fwk_commands(*wishes: str) -> Commands:
    """Returns the supervisor alone, which forks all other processes."""
    return lambda shape_file: [[CORE.python, "-m", "tools.bench.fwk_supervise", shape_file, *wishes]]


_ALL = (
    Peer("fwk", "fwk", CORE, LCM_GEN, udp=True, start=fwk_commands()),
    Peer("fwk_grouped", "fwk, ten components a process", CORE, LCM_GEN, start=fwk_commands("grouped")),
    Peer("fwk_recorded", "fwk with recorder and gateway", CORE, LCM_GEN, start=fwk_commands("recorded")),
    Peer("unix", "Unix datagrams", CORE, LCM_GEN, bare=True),
    Peer("lcm", "bare LCM, a port a channel", CORE, LCM_GEN, udp=True, bare=True),
    Peer("lcm_wire", "LCM's format on plain sockets", CORE, LCM_GEN, udp=True, bare=True),
    Peer("lcm_groups", "bare LCM, a port for ten channels", CORE, LCM_GEN, udp=True, bare=True),
    Peer("lcm_mpudpm", "bare LCM, mpudpm", CORE, LCM_GEN, udp=True, bare=True),
    Peer("lcm_onebus", "bare LCM, one bus", CORE, LCM_GEN, udp=True, bare=True),
    Peer("zmq", "ZeroMQ, ipc", ZMQ, LCM_GEN),
    Peer("zenoh", "Zenoh, tcp star", ZENOH, LCM_GEN),
    Peer("ecal", "eCAL, shared memory", ECAL, LCM_GEN),
    Peer("dora", "dora", DORA, LCM_GEN, start=dora_flow.commands),
    Peer("ice", "Ice, AMI", ICE, "Slice, Python"),
    Peer("rospy", "ROS 1, rospy", ROS, "genpy, Python", start=rospy_commands),
    Peer("roscpp", "ROS 1, roscpp (C++)", ROS, "gencpp, C++", start=roscpp_commands, program=ros_build.PROGRAM),
)
PEERS = {peer.name: peer for peer in _ALL}
