"""One run of fwk as users start it, watched from outside: python -m tools.bench.own_driver JSON; prints a result."""

import json
import os
import re
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from fwk.bus.sockets import multicast_receiver
from fwk.lcm import wire
from fwk.model.ports import Ports
from lcmtypes.core import status_t, tick_record_t
from tools.bench import accounting, fwk_launch_file, namespace
from tools.bench.driver import RunFailedError
from tools.bench.environments import CORE, REPOSITORY
from tools.bench.shape import Shape
from tools.bench.timing import now_us, sleep_s

_BUS_PORT = 17_700
PORTS = Ports(_BUS_PORT, 0, 0)
"""Ports of a launched run."""
_PATIENCE_S = 60.0
_LOOK_S = 0.2
_WARM_PERIODS = 20
_SETTLED_TICK = 20  # every component has run, so that its memory is complete


def main() -> None:
    """Performs the run that the JSON argument describes: an `OwnScenario`, seconds, namespace or not."""
    job = json.loads(sys.argv[1])
    try:
        if job["isolated"]:
            namespace.set_up(0.0)
        measure = {"jitter": jitter, "soak": jitter, "start": start}[job["kind"]]
        with TemporaryDirectory(prefix="bench-") as folder:
            result = measure(job, folder)
    except (RunFailedError, namespace.NoNamespaceError, OSError) as error:
        result = {"error": str(error)}
    print(json.dumps(result))


def jitter(job: dict[str, Any], folder: str) -> dict[str, Any]:
    """Measures in real time the deviation of each period of a component from the desired one: absolute errors in µs.

    It also counts missed ticks: periods that lasted two or more, and late iterations.

    Raises:
        RunFailedError: the run broke.
    """
    shape = Shape(job["components"], stages=job["stages"], folder=folder)
    file = fwk_launch_file.write(shape, shape.save(), wall_period_s=job["period_s"])
    with (
        _busy(os.cpu_count() or 1 if job["busy"] else 0),
        launched(folder, file, "--time", str(job["seconds"])) as run,
    ):
        try:
            run.wait(job["seconds"] + _PATIENCE_S)
        except subprocess.TimeoutExpired as error:
            raise RunFailedError(f"did not end; {_last_words(folder)}") from error
    probe = Path(folder, "probe.json")
    if run.returncode or not probe.exists():
        raise RunFailedError(f"exit code {run.returncode}; {_last_words(folder)}")
    began_us = json.loads(probe.read_text())[_WARM_PERIODS:]
    period_us = job["period_s"] * 1e6
    errors_us = [abs(after - before - period_us) for before, after in pairwise(began_us)]
    if not errors_us:
        raise RunFailedError("too few ticks")
    late = re.search(r"\blate (\d+)", Path(folder, "output").read_text(errors="replace"))
    if not late:
        raise RunFailedError(f"no count of late iterations; {_last_words(folder)}")
    return {"error_us": errors_us, "missed": sum(error >= period_us for error in errors_us) + int(late[1])}


def start(job: dict[str, Any], folder: str) -> dict[str, Any]:
    """Measures the time from command to first tick, the memory of all processes, and the restart of a component.

    Raises:
        RunFailedError: no first tick, or the killed component did not come back.
    """
    records, states = multicast_receiver(PORTS.record), multicast_receiver(PORTS.status)
    start_us = now_us()
    with launched(folder, job["file"], "--speed", "1") as run:

        def next_record() -> tick_record_t:
            return tick_record_t.decode(next_message(records, run, folder))

        record = next_record()
        first_us = now_us()
        while record.tick < _SETTLED_TICK:
            record = next_record()
        pids = [*accounting.descendants(run.pid), run.pid]
        held_mb = accounting.pss_mb(pids)
        victim = status_t.decode(next_message(states, run, folder)).hosts[-1]
        os.kill(victim.pid, signal.SIGKILL)
        killed_us = now_us()
        while not _has_started(next_record(), victim.host):
            continue
        restarted_us = now_us()
        run.send_signal(signal.SIGINT)
        run.wait(_PATIENCE_S)
    return {
        "first_tick_s": (first_us - start_us) / 1e6,
        "processes": len(pids),
        "pss_mb": held_mb,
        "restart_s": (restarted_us - killed_us) / 1e6,
    }


def next_message(source: socket.socket, run: "subprocess.Popen[bytes]", folder: str) -> bytes:
    """Returns the next message on a socket of the run.

    Raises:
        RunFailedError: the run ended instead, or no message came for long.
    """
    source.settimeout(_LOOK_S)
    end_us = now_us() + int(_PATIENCE_S * 1e6)
    while now_us() < end_us and run.poll() is None:
        try:
            datagram, (_, port) = source.recvfrom(wire.DATAGRAM_MAX)
        except TimeoutError:
            continue
        message = wire.Assembler().feed(datagram, port)
        if message:
            return message[1]
    raise RunFailedError(f"exit code {run.poll()}, or silence for {_PATIENCE_S:.0f} s; {_last_words(folder)}")


def _has_started(record: tick_record_t, host: int) -> bool:
    return host in record.events.started.host


@contextmanager
def launched(folder: str, file: str, *words: str) -> Iterator["subprocess.Popen[bytes]"]:
    """Runs `fwk-launch` with its run directory in `folder`; kills it if it still runs at the end."""
    command = [CORE.python, "-m", "fwk.cli.launch", file, "--plain", "--bus-port", str(_BUS_PORT), *words]
    variables = {**CORE.process_variables(), "HOME": folder}
    with open(f"{folder}/output", "wb") as output:
        run = subprocess.Popen(
            command, env=variables, cwd=REPOSITORY, stdin=subprocess.DEVNULL, stdout=output, stderr=output
        )
        try:
            yield run
        finally:
            run.kill()
            run.wait()


@contextmanager
def _busy(cores: int) -> Iterator[None]:
    """Keeps cores busy with processes that only compute."""
    burners = [subprocess.Popen([CORE.python, "-c", "while True: pass"]) for _ in range(cores)]
    try:
        sleep_s(0.1 if burners else 0.0)
        yield
    finally:
        for burner in burners:
            burner.kill()
            burner.wait()


def _last_words(folder: str) -> str:
    lines = Path(folder, "output").read_text(errors="replace").strip().splitlines()
    return " / ".join(lines[-4:]) or "it wrote nothing"


if __name__ == "__main__":
    main()
