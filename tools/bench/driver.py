"""One run of one arrangement in a separate network namespace: python -m tools.bench.driver JSON; prints a result.

It starts the peer's processes, lets the supervisor warm up, and then sleeps while the ticks run. Its readings of
/proc before and after cover the whole tree below it: supervisor, components and any daemon, not itself.
"""

import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, TextIO

from tools.bench import accounting, namespace
from tools.bench.environments import REPOSITORY
from tools.bench.registry import PEERS, Peer
from tools.bench.shape import Shape
from tools.bench.timing import now_us, sleep_s

_FIRST_TICK_S = 90.0
_END_S = 5.0
_LOOK_S = 0.2

Started = list[subprocess.Popen[bytes]]


class RunFailedError(Exception):
    """The run gave no figures; the text gives the reason."""


def main() -> None:
    """Performs the run that the JSON argument describes: peer, shape, loss, ticks, seconds, namespace or not."""
    job = json.loads(sys.argv[1])
    try:
        if job["isolated"]:
            namespace.set_up(job["loss"])
        elif job["loss"]:
            raise RunFailedError("packet loss needs a network namespace")
        result = run(PEERS[job["peer"]], Shape(**job["shape"]), job["ticks"], job["seconds"])
    except (RunFailedError, namespace.NoNamespaceError) as error:
        result = {"error": str(error)}
    print(json.dumps(result))


def run(peer: Peer, shape: Shape, ticks: int, seconds: float) -> dict[str, Any]:
    """Measures up to `ticks` ticks in at most `seconds`; see `docs/numbers.md` for the fields.

    Raises:
        RunFailedError: no first tick, or a component fell silent.
    """
    with TemporaryDirectory(prefix="bench-") as folder:
        shape = replace(shape, folder=folder)
        path = shape.save()
        listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        listener.bind(f"{folder}/control")
        listener.listen(1)
        start_us = now_us()
        try:
            with _processes(peer, path, folder) as started:
                lines = _connect(listener, started)
                first = _read(lines)
                pids = accounting.descendants(os.getpid())
                before = accounting.usage(pids)
                lines.write(f"go {ticks} {seconds}\n")
                lines.flush()
                measured = _read(lines)
                used = accounting.usage(pids) - before
                memory_mb, threads = accounting.pss_mb(pids), accounting.threads(pids)
                lines.write("stop\n")
                lines.flush()
        except (OSError, ValueError, RunFailedError) as error:
            raise RunFailedError(f"{error}; {_complaints(folder)}") from error
        stale = _stale(shape)
    count = len(measured["tick_us"])
    wanted = shape.components * (2 + len(shape.sources(0)) * shape.fragments)  # a tick, a done, the inputs
    return {
        "tick_us": measured["tick_us"],
        "repeated": measured["repeated"],
        "cpu_us": used.cpu_us / count,
        "switches": used.switches / count,
        "for_nothing": used.datagrams_read / count - wanted if peer.udp else None,
        "dropped": used.datagrams_dropped,
        "stale": stale,
        "pss_mb": memory_mb,
        "threads": threads,
        "first_tick_s": (first["first_tick_us"] - start_us) / 1e6,
    }


@contextmanager
def _processes(peer: Peer, path: str, folder: str) -> Iterator[Started]:
    variables = peer.environment.process_variables()
    started: Started = []
    with open(f"{folder}/output", "wb") as output:
        try:
            for words in peer.commands(path):
                started.append(
                    subprocess.Popen(
                        words, env=variables, cwd=REPOSITORY, stdin=subprocess.DEVNULL, stdout=output, stderr=output
                    )
                )
            yield started
        finally:
            _end(started)


def _end(started: Started) -> None:
    """Gives components time to end by themselves, then ends daemons and all other processes."""
    deadline_us = now_us() + int(_END_S * 1e6)
    while any(process.poll() is None for process in started) and now_us() < deadline_us:
        sleep_s(0.02)
    for pid in accounting.descendants(os.getpid()):
        with suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)
    for process in started:
        process.wait()


def _connect(listener: socket.socket, started: Started) -> TextIO:
    """Waits for the supervisor, unless it has already ended."""
    listener.settimeout(_LOOK_S)
    end_us = now_us() + int(_FIRST_TICK_S * 1e6)
    while now_us() < end_us:
        try:
            connection, _ = listener.accept()
        except TimeoutError:
            if all(process.poll() is not None for process in started):
                raise RunFailedError("every process ended before the first tick") from None
            continue
        connection.settimeout(_FIRST_TICK_S)
        return connection.makefile("rw")
    raise RunFailedError(f"no supervisor within {_FIRST_TICK_S:.0f} s")


def _read(lines: TextIO) -> dict[str, Any]:
    answer: dict[str, Any] = json.loads(lines.readline() or '{"error": "the supervisor ended"}')
    if "error" in answer:
        raise RunFailedError(answer["error"])
    return answer


def _complaints(folder: str) -> str:
    """Returns the last line that any process wrote."""
    lines = Path(folder, "output").read_text(errors="replace").strip().splitlines()
    return lines[-1] if lines else "no process wrote anything"


def _stale(shape: Shape) -> int | None:
    """Returns the number of stale inputs of all components; None if a component did not report."""
    files = list(Path(shape.folder).glob("component*.json"))
    if len(files) < shape.components:
        return None
    return sum(int(json.loads(file.read_text())["stale"]) for file in files)


if __name__ == "__main__":
    main()
