"""Locations of the peers' libraries and interpreters; every peer has an environment of its own."""

import os
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
PEERS = REPOSITORY / "build" / "bench-peers"
_DEBIAN_LIBRARIES = "usr/lib/x86_64-linux-gnu"


@dataclass(frozen=True)
class Environment:
    """One environment.

    `pip` packages go into a virtual environment of the Python that runs the benchmark; `debian` packages are unpacked,
    not installed, and that Python finds them (they need Debian 12's Python 3.11); with neither it is the core one.
    """

    name: str
    pip: tuple[str, ...] = ()
    debian: tuple[str, ...] = ()
    imports: tuple[str, ...] = ()
    variables: dict[str, str] = field(default_factory=dict)

    @property
    def folder(self) -> Path:
        """Folder of the installation."""
        return PEERS / self.name

    @property
    def python(self) -> str:
        """Path of the interpreter."""
        if self.pip:
            return str(self.folder / "bin" / "python")
        return sys.executable  # one build of Python for all: Debian's own runs the same code a third faster

    def process_variables(self) -> dict[str, str]:
        """Environment variables for every process of the peer."""
        path = [str(REPOSITORY)]
        made = {**os.environ, **self.variables, "PYTHONDONTWRITEBYTECODE": "1", "PYTHONUNBUFFERED": "1"}
        if self.debian:
            path.append(str(self.folder / "usr/lib/python3/dist-packages"))
            made["LD_LIBRARY_PATH"] = str(self.folder / _DEBIAN_LIBRARIES)
            made["PATH"] = f"{self.folder / 'usr/bin'}:{made.get('PATH', '')}"
        elif self.pip:
            made["PATH"] = f"{self.folder / 'bin'}:{made.get('PATH', '')}"
        made["PYTHONPATH"] = ":".join(path)
        return made

    def missing(self) -> str:
        """Returns why the environment cannot be used; empty if it can."""
        if not Path(self.python).exists():
            return "not installed; type: make bench-peers"
        if not self.imports:
            return ""
        command = [self.python, "-c", f"import {', '.join(self.imports)}"]
        result = subprocess.run(
            command, env=self.process_variables(), cwd=REPOSITORY, capture_output=True, text=True, check=False
        )
        if result.returncode == 0:
            return ""
        lines = result.stderr.strip().splitlines() or ["cannot be imported"]
        return f"{lines[-1]}; type: make bench-peers"


CORE = Environment("core", imports=("lcm",))
ZMQ = Environment("zmq", pip=("pyzmq==27.3.0",), imports=("zmq",))
ZENOH = Environment("zenoh", pip=("eclipse-zenoh==1.10.2",), imports=("zenoh",))
ECAL = Environment("ecal", pip=("eclipse-ecal==6.1.1",), imports=("ecal.nanobind_core",))
DORA = Environment("dora", pip=("dora-rs==1.1.0", "dora-rs-cli==1.1.0"), imports=("dora",))
ICE = Environment("ice", debian=("python3-zeroc-ice", "zeroc-ice-slice"), imports=("Ice",))
ROS = Environment(
    "ros",
    debian=("python3-rospy", "python3-rosmaster", "python3-genpy", "python3-gencpp", "libroscpp-dev"),
    imports=("rospy", "rosmaster", "genpy.dynamic"),
    variables={"ROS_MASTER_URI": "http://127.0.0.1:11311", "ROS_IP": "127.0.0.1"},
)
ALL = (CORE, ZMQ, ZENOH, ECAL, DORA, ICE, ROS)
