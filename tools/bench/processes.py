"""CPU time of each process in a tick: python -m tools.bench.processes soccer.yaml [--ticks 200] [--hosting robot].

The launch file runs as users start it, as fast as it can, with gateway and recording.
"""

import signal
from collections import defaultdict
from tempfile import TemporaryDirectory
from typing import Annotated, NamedTuple

import psutil
import typer

from fwk.bus.sockets import multicast_receiver
from fwk.cli.arguments import Hosting
from fwk.plan.load import load_plan
from lcmtypes.core import tick_record_t
from tools.bench import accounting, program
from tools.bench.own_driver import PORTS, launched, next_message
from tools.bench.timing import now_us

_WARM_UP = 50
_PATIENCE_S = 60.0


class Spent(NamedTuple):
    """CPU milliseconds of the processes whose roles end in the same name."""

    processes: int
    total_ms: float


def cpu_ms(file: str, ticks: int, hosting: str, warm_up: int = _WARM_UP) -> tuple[dict[str, Spent], float]:
    """Returns CPU time in a tick by the components' own names, the largest first, and wall time of a tick in ms.

    Raises:
        RunFailedError: the run ended before it was measured.
    """
    records = multicast_receiver(PORTS.record)
    words = ("--speed", "max", "--hosting", hosting)
    with TemporaryDirectory(prefix="bench-") as folder, launched(folder, file, *words) as run:

        def pass_tick(tick: int) -> None:
            while tick_record_t.decode(next_message(records, run, folder)).tick < tick:
                continue

        pass_tick(warm_up)
        before, began_us = _spent_ms(run.pid), now_us()
        pass_tick(warm_up + ticks)
        after, took_us = _spent_ms(run.pid), now_us() - began_us
        run.send_signal(signal.SIGINT)
        run.wait(_PATIENCE_S)
    records.close()
    by_name: defaultdict[str, list[float]] = defaultdict(list)
    for pid, (name, total_ms) in after.items():
        by_name[name].append((total_ms - before.get(pid, (name, 0.0))[1]) / ticks)
    spent = {name: Spent(len(each), sum(each)) for name, each in by_name.items()}
    return dict(sorted(spent.items(), key=lambda each: -each[1].total_ms)), took_us / 1e3 / ticks


def _spent_ms(launcher: int) -> dict[int, tuple[str, float]]:
    """Returns own name and CPU milliseconds of each process of a run so far, by process id."""
    found = {}
    for pid in [launcher, *accounting.descendants(launcher)]:
        try:
            title = psutil.Process(pid).cmdline()[0]
        except (psutil.NoSuchProcess, IndexError):  # it has ended
            continue
        name = title.split()[-1].rpartition("/")[2] if title.startswith("fwk: ") else "launcher"
        found[pid] = name, accounting.usage([pid]).cpu_us / 1e3
    return found


def _main(
    launch: Annotated[str, typer.Argument(help="Launch file")] = "soccer.yaml",
    ticks: Annotated[int, typer.Option(min=1, help="Ticks that are measured")] = 200,
    hosting: Annotated[Hosting, typer.Option(help="How components share processes")] = Hosting.PROCESS,
) -> None:
    """Prints the CPU time of the processes in a tick; those of one name are added up."""
    load_plan(launch)  # names the mistakes of the launch file
    spent, tick_ms = cpu_ms(launch, ticks, hosting)
    processes = sum(each.processes for each in spent.values())
    everything = Spent(processes, sum(each.total_ms for each in spent.values()))
    for name, each in [*spent.items(), ("all", everything)]:
        typer.echo(f"{name:20} {each.processes:4} processes {each.total_ms:8.2f} ms")
    typer.echo(f"a tick takes {tick_ms:.2f} ms of wall time")


if __name__ == "__main__":
    program.run(_main)
