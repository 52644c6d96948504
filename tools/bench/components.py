"""CPU time of each component in a tick: python -m tools.bench.components soccer.yaml [--ticks 100].

All components of a launch file run in one host in memory, where the work of one does not slow down the next as
it does between processes. What is left of the whole is the framework's own: visibility, inputs, messages in memory.
"""

from collections import defaultdict
from collections.abc import Callable
from time import process_time
from typing import Annotated

import typer

from fwk.testing import MemorySystem, system_of
from tools.bench import program

_WARM_UP = 40
FRAMEWORK = "framework"


def cpu_ms(file: str, ticks: int, warm_up: int = _WARM_UP) -> dict[str, float]:
    """Returns CPU milliseconds a tick by the components' own names, and those of the framework, the largest first.

    Raises:
        PlanError: the launch file has mistakes.
    """
    system = system_of(file)
    system.tick(warm_up)
    spent_s = _measured(system)
    began_s = process_time()
    system.tick(ticks)
    spent_s[FRAMEWORK] = process_time() - began_s - sum(spent_s.values())
    largest_first = sorted(spent_s.items(), key=lambda each: -each[1])
    return {name: 1e3 * total_s / ticks for name, total_s in largest_first}


def _measured(system: MemorySystem) -> dict[str, float]:
    """Lets each iteration from now on add its CPU time to the seconds that are returned, by own names."""
    spent_s: defaultdict[str, float] = defaultdict(float)

    def measured(name: str, loop: Callable[[], None]) -> Callable[[], None]:
        def iterate() -> None:
            began_s = process_time()
            loop()
            spent_s[name] += process_time() - began_s

        return iterate

    for name, runner in system.runners.items():
        component = runner.component
        vars(component)["loop"] = measured(name.rpartition("/")[2], component.loop)
    return spent_s


def _main(
    launch: Annotated[str, typer.Argument(help="Launch file")] = "soccer.yaml",
    ticks: Annotated[int, typer.Option(min=1, help="Ticks that are measured")] = 100,
) -> None:
    """Prints the CPU time of each component in a tick; those of one name are added up."""
    found = cpu_ms(launch, ticks)
    for name, total_ms in [*found.items(), ("all", sum(found.values()))]:
        typer.echo(f"{name:20} {total_ms:8.2f} ms")


if __name__ == "__main__":
    program.run(_main)
