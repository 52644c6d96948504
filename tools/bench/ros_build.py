"""Builds the C++ side of the ROS peers: messages with gencpp, one program with g++."""

import subprocess
from pathlib import Path

from tools.bench.environments import ROS
from tools.bench.shape import LAST_WARM_UP_TICK, Shape

_SOURCE = Path(__file__).resolve().parent / "peers" / "ros"
_BUILD = ROS.folder / "bench"
PROGRAM = _BUILD / "node"
_LIBRARIES = ("roscpp", "roscpp_serialization", "rosconsole", "rostime", "xmlrpcpp", "boost_thread", "boost_system")


def build() -> None:
    """Builds `PROGRAM`.

    Raises:
        CalledProcessError: the generator or the compiler refused; its output is in `stderr`.
    """
    headers = _BUILD / "include" / "bench"
    headers.mkdir(parents=True, exist_ok=True)
    generator = ROS.folder / "usr/lib/gencpp/gen_cpp.py"
    templates = ROS.folder / "usr/share/gencpp"
    for message in sorted(_SOURCE.glob("*.msg")):
        words = [str(message), "-p", "bench", "-I", f"bench:{_SOURCE}", "-o", str(headers), "-e", str(templates)]
        _run([ROS.python, str(generator), *words])
    prefix = ROS.folder / "usr"
    libraries = prefix / "lib/x86_64-linux-gnu"
    command = ["g++", "-O2", "-std=c++17", str(_SOURCE / "node.cpp"), "-o", str(PROGRAM)]
    command += [f"-I{_BUILD / 'include'}", f"-I{prefix / 'include'}", f"-L{libraries}", f"-Wl,-rpath-link,{libraries}"]
    _run([*command, *(f"-l{name}" for name in _LIBRARIES)])


def commands(shape_file: str) -> list[list[str]]:
    """Returns the nodes; the master comes before them."""
    shape = Shape.read(shape_file)
    words = [shape.components, shape.stages, shape.reads, shape.padding_bytes, LAST_WARM_UP_TICK, shape.folder]
    arguments = [str(word) for word in words]
    return [[str(PROGRAM), str(index), *arguments] for index in [*range(shape.components), -1]]


def _run(command: list[str]) -> None:
    subprocess.run(command, env=ROS.process_variables(), capture_output=True, text=True, check=True)
