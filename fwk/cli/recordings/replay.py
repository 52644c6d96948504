"""`fwk replay`: feeds recorded inputs to real components and compares their outputs."""

import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.arguments import new_file
from fwk.cli.recordings.branch import BranchRequest, go_on_live
from fwk.cli.recordings.find_log import failing, find_log
from fwk.cli.recordings.user_folders import use_folders
from fwk.cli.run_options import Json
from fwk.engine.failures import ComponentFailedError
from fwk.model.errors import hint
from fwk.model.plan import Plan
from fwk.plan.what_ran import blas_kernel, changed_modules, other_kernel
from fwk.recording.differing import Differing, differing, lines_of
from fwk.recording.log_index import changed
from fwk.recording.replay.recording import Recording, RecordingError
from fwk.recording.replay.replay import Replay
from fwk.recording.travel.debugger import LEFT, Travel
from fwk.recording.travel.snapshots import Snapshots, run_session

DIFFERENT, UNUSABLE = 1, 2


def replay(
    run: Annotated[Path, typer.Argument(metavar="RUN_OR_LOG", help="a run directory, its name, or its log")],
    verify: Annotated[bool, typer.Option("--verify", help="compare every output; exit 1 at a difference")] = False,
    only: Annotated[list[str] | None, typer.Option(metavar="NAME", help="only these components; repeatable")] = None,
    from_tick: Annotated[
        int, typer.Option(min=1, metavar="N", help="compare outputs, or stop in the debugger, from this tick on")
    ] = 1,
    to_tick: Annotated[int | None, typer.Option(min=1, metavar="N", help="stop after this tick")] = None,
    debug: Annotated[
        str | None, typer.Option(metavar="NAME", help="under pdb, from this component's next iteration on")
    ] = None,
    then_live: Annotated[
        bool, typer.Option("--then-live", help="go on live after --to-tick, as a run with a recording of its own")
    ] = False,
    until_tick: Annotated[
        int | None,
        typer.Option(min=1, metavar="N", help="with --then-live: last live tick; default: the last recorded"),
    ] = None,
    sets: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="PATH=VALUE", help="with --then-live: a setting after --to-tick; repeatable"),
    ] = None,
    classes: Annotated[
        list[str] | None,
        typer.Option("--with", metavar="NAME=MODULE:CLASS", help="with --then-live: another class; repeatable"),
    ] = None,
    record: Annotated[
        Path | None,
        typer.Option(
            parser=new_file, metavar="FILE", help="with --then-live: the new log; default: in a run directory"
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    """Feeds recorded inputs to real components at the recorded iterations; --then-live goes on from there.

    Drivers of devices are left out, and so are components that see a device's frames, unless these are recorded too.

    Exit codes: 0 equal, or nothing compared; 1 an output differs from the recorded one, or a component fails after
    the branch; 2 the recording cannot be replayed.
    """
    with failing(UNUSABLE):
        log = find_log(run)
        asked = _branch(then_live, to_tick, until_tick, sets, classes, record, bool(only or debug or verify))
        try:
            if asked:
                go_on_live(_opened(log), asked, as_json)
                return
        except RecordingError as error:
            typer.echo(f"error: {error}", err=True)
            raise typer.Exit(UNUSABLE) from error
        work = partial(_replayed, log, only or ([debug] if debug else []), from_tick, verify, as_json)
        if not debug:
            raise typer.Exit(work(lambda made: made.run(to_tick)))
    raise typer.Exit(run_session(partial(_debugged, work, debug, from_tick, to_tick)))


def _replayed(
    log: Path,
    only: list[str],
    from_tick: int,
    verify: bool,
    as_json: bool,
    run: Callable[[Replay], None],
) -> int:
    """Replays a log with `run` and says what was found; returns the exit code."""
    try:
        recording = _opened(log)
        done = Replay(recording, only, from_tick)
        notes = list(_not_as_in_the_run(recording.plan))
        notes += [f"damaged: {part}" for part in changed(log)] if verify else ()
        for text in notes:
            typer.echo(f"{log}: {text}", err=True)
        run(done)
        if verify and from_tick > done.newest_tick:
            raise RecordingError(
                f"{log}: nothing was compared: no tick {from_tick}; the last one is {done.newest_tick}"
            )
    except RecordingError as error:
        typer.echo(f"error: {error}", err=True)
        return UNUSABLE
    found = done.differences
    if as_json:
        typer.echo(json.dumps({**_plain(done, verify), "notes": notes}, indent=2))
        return DIFFERENT if verify and found else 0
    typer.echo(f"{done.iterations} iterations replayed")
    for name, reason in done.left_out.items():
        typer.echo(f"not replayed: {name}: {reason}")
    if done.recording.skipped_bytes:
        typer.echo(f"{log}: cut off: its last {done.recording.skipped_bytes} bytes are not a whole message", err=True)
    if lost := {channel: numbers for channel, numbers in done.lost.items() if numbers}:
        which = ", ".join(f"{len(lost[channel])} of {channel} (the first is {min(lost[channel])})" for channel in lost)
        typer.echo(f"{log}: messages were lost in the run: {which}; their readers may differ", err=True)
    if not verify:
        return 0
    if not found and not done.compared:
        since = f" from tick {from_tick} on" if from_tick > 1 else ""
        typer.echo(f"nothing was compared: none of these components wrote a message{since}")
        return 0
    if not found:
        typer.echo(f"equal: {done.compared} messages are byte for byte what was recorded")
        return 0
    rows = _differing(done)
    typer.echo(f"different: {len(found)} of {done.compared} messages; the first is")
    typer.echo(f"  {rows[0].component}: {rows[0].first}")
    for line in lines_of(rows):
        typer.echo(line)
    return DIFFERENT


def _differing(done: Replay) -> list[Differing]:
    """Returns the components that write something else than in the run."""
    named = [replace(difference, names=("the recording", "the replay")) for difference in done.differences]
    return differing(named, done.recording.plan)


def _plain(done: Replay, verify: bool) -> dict[str, object]:
    lost = {channel: sorted(numbers) for channel, numbers in done.lost.items() if numbers}
    about = {"iterations": done.iterations, "left_out": done.left_out, "lost": lost, "verified": verify}
    if not verify:
        return about
    rows = [row.plain() for row in _differing(done)]
    first = {"component": rows[0]["component"], **rows[0]["first"]} if rows else None
    counts = {"equal": not done.differences, "compared": done.compared, "differences": len(done.differences)}
    return {**about, **counts, "first": first, "components": rows}


def _opened(log: Path) -> Recording:
    recording = Recording(log)
    use_folders(recording.plan.folders)
    return recording


def _branch(
    then_live: bool,
    to_tick: int | None,
    until_tick: int | None,
    sets: list[str] | None,
    classes: list[str] | None,
    record: Path | None,
    others: bool,
) -> BranchRequest | None:
    """Returns the branch that the options ask for; None: an ordinary replay."""
    if not then_live:
        if until_tick or sets or classes or record:
            raise typer.BadParameter("--until-tick, --set, --with and --record belong to --then-live")
        return None
    if to_tick is None:
        raise typer.BadParameter("--then-live needs --to-tick N, the last recorded tick that counts")
    if others:
        raise typer.BadParameter(
            "--then-live runs all components without a debugger; leave out --only, --debug, --verify"
        )
    return BranchRequest(to_tick, until_tick, sets or (), classes or (), record)


def _not_as_in_the_run(plan: Plan) -> Iterator[str]:
    """Yields what differs from the run before any component runs: its modules and the BLAS kernel."""
    for module, difference in changed_modules(plan).items():
        yield f"{module} is not the module that ran: {difference}"
    if text := other_kernel(("the run", "this replay"), (plan.blas_kernel, blas_kernel())):
        yield text


def _debugged(
    work: Callable[[Callable[[Replay], None]], int],
    name: str,
    from_tick: int,
    to_tick: int | None,
    snapshots: Snapshots,
) -> int:
    """Replays under pdb with time travel, in a process that may go back; returns the exit code."""
    try:
        with failing(UNUSABLE):
            return work(partial(_debug, snapshots, name, from_tick, to_tick))
    except typer.Exit as end:
        return end.exit_code


def _debug(snapshots: Snapshots, name: str, from_tick: int, to_tick: int | None, made: Replay) -> None:
    """Runs the replay under pdb; ends the command when the debugger is left."""
    components = {component.name: component for component in made.recording.plan.components}
    if name not in components:
        raise RecordingError(f"--debug: no component '{name}' in this run; {hint(name, components)}")
    travel = Travel(components[name], snapshots, from_tick)

    def work(begins: Callable[[int], None]) -> None:
        try:
            made.run(to_tick, begins)
        except RecordingError as error:
            raise ComponentFailedError(str(error)) from (error.__cause__ or error)

    if travel.run(work) == LEFT:
        typer.echo(f"left in tick {travel.tick}")
        raise typer.Exit(0)
