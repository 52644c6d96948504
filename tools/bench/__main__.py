"""Command line of the benchmark: python -m tools.bench [--quick] [--peers unix,lcm] [--sizes 5,20] [--rounds 5]."""

import sys
from contextlib import suppress
from pathlib import Path
from typing import Annotated

import typer

from tools.bench import machine, program, report, rotation
from tools.bench.environments import REPOSITORY
from tools.bench.figures import Run, error_us, tick_us
from tools.bench.own import LONG
from tools.bench.record import Record
from tools.bench.registry import PEERS, Peer
from tools.bench.scenarios import SIZES

_PAGE = REPOSITORY / "docs" / "numbers.md"
_REAL_TIME_S = 2.0  # fewer give too few periods for a 99th percentile
_JSON = REPOSITORY / "build" / "bench" / "numbers.json"


def main(
    peers: Annotated[str, typer.Option(help="Names, separated by commas; empty: all")] = "",
    sizes: Annotated[str, typer.Option(help="Numbers of components")] = ",".join(map(str, SIZES)),
    varied: Annotated[str, typer.Option(help="Sizes of the runs with ten reads, 64 KiB, loss; empty: none")] = "20,80",
    own: Annotated[bool, typer.Option("--own/--no-own", help="Real time, start, memory, restart of fwk too")] = True,
    rounds: Annotated[int, typer.Option(min=1, help="Number of measurements of each arrangement")] = 3,
    seconds: Annotated[float, typer.Option(min=0.1, max=3600.0, help="Longest measurement of one run")] = 2.0,
    soak: Annotated[
        float, typer.Option(min=0.0, max=86400.0, help="Seconds of one long run at 100 Hz; 0: none")
    ] = 600.0,
    quick: Annotated[bool, typer.Option("--quick", help="Two rounds, 5 and 20 components, half a second")] = False,
    json_file: Annotated[Path, typer.Option("--json", help="File for all runs")] = _JSON,
    page: Annotated[Path, typer.Option(help="Page whose tables are replaced")] = _PAGE,
    no_page: Annotated[bool, typer.Option("--no-page", help="Print the tables, change no page")] = False,
    render: Annotated[bool, typer.Option("--render", help="Measure nothing: tables of the JSON file")] = False,
) -> None:
    """Measures a full tick of fwk and of its peers, in rotation, and writes docs/numbers.md.

    Ctrl-C ends the measurement; the results so far are written.
    """
    if quick:
        sizes, varied, rounds, seconds, soak = "5,20", "20", 2, 0.5, 0.0
    if render:
        record = _read(json_file)
    else:
        chosen, missing = _peers(peers)
        about = {"command": _command(), **machine.describe(), "isolation": _isolation(), "rounds": str(rounds)}
        names = [peer.name for peer in chosen]
        record = Record(about, missing, names, _numbers(sizes), _numbers(varied), own)
        measure(record, rounds, seconds, soak, json_file)
    tables = report.text(record)
    typer.echo(tables)
    if not no_page:
        report.insert(page, tables)


def _read(json_file: Path) -> Record:
    try:
        return Record.read(json_file)
    except OSError as error:
        raise typer.BadParameter(f"--json: {json_file}: {error.strerror}; run the benchmark first") from error
    except (ValueError, KeyError, TypeError) as error:
        raise typer.BadParameter(f"--json: {json_file} does not hold the runs of a benchmark: {error}") from error


def measure(record: Record, rounds: int, seconds: float, soak_s: float, json_file: Path) -> None:
    """Measures everything that a record asks for, and saves it after each run; Ctrl-C ends it early."""
    for name, reason in record.missing.items():
        typer.echo(f"{name}: left out: {reason}", err=True)

    def take(run: Run) -> None:
        record.runs.append(run)
        typer.echo(f"round {run.round + 1}  {run.scenario:<24} {run.peer:<12} {_figure(run)}", err=True)
        record.save(json_file)

    with suppress(KeyboardInterrupt):
        rotation.rotate(record.peers, record.scenarios, rounds, seconds, take)
        rotation.rotate_own(record.own, rounds, max(seconds, _REAL_TIME_S), take)
        if record.with_own and soak_s:
            rotation.rotate_own(LONG, 1, soak_s, take)


def _peers(names: str) -> tuple[list[Peer], dict[str, str]]:
    wanted = names.split(",") if names else list(PEERS)
    unknown = [name for name in wanted if name not in PEERS]
    if unknown:
        raise typer.BadParameter(f"no peer '{unknown[0]}'; there are {', '.join(PEERS)}")
    missing = {PEERS[name].title: reason for name in wanted if (reason := PEERS[name].missing())}
    return [PEERS[name] for name in wanted if PEERS[name].title not in missing], missing


def _numbers(words: str) -> tuple[int, ...]:
    try:
        numbers = tuple(int(word) for word in words.split(",") if word)
    except ValueError:
        numbers = (0,)
    if not all(number >= 1 for number in numbers):
        raise typer.BadParameter(f"'{words}': numbers from 1, separated by commas, for example 5,20,40")
    return numbers


def _figure(run: Run) -> str:
    if run.error:
        return run.error
    if "tick_us" in run.result:
        return f"{tick_us(run.result) / 1000:.2f} ms"
    if "error_us" in run.result:
        return f"p99 of the period's error {error_us(run.result, 0.99) / 1000:.2f} ms"
    return f"first tick after {run.result['first_tick_s']:.2f} s, {run.result['pss_mb']:.0f} MB"


def _isolation() -> str:
    if rotation.isolation():
        return "a network and process namespace a run"
    return "own ports a run; this machine allows no namespaces, so packet loss is not measured"


def _command() -> str:
    return " ".join(["python -m tools.bench", *sys.argv[1:]])


if __name__ == "__main__":
    program.run(main)
