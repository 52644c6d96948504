"""`fwk-launch FILE`: checks a launch file, runs it in the foreground, says how it went."""

import shutil
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.arguments import Hosting, SeveralNames, new_file, seconds, video_file
from fwk.cli.arguments import speed as parse_speed
from fwk.cli.recordings.runs import GB
from fwk.cli.run.profile import write_profiles
from fwk.cli.run.run_directory import RunDirError, make_run_dir, prune
from fwk.cli.run.run_files import write_run_files
from fwk.display.summary import introduction, summary
from fwk.launcher.run import DebuggerMissing, PortsInUse, ProfilerMissing, RunOptions, run
from fwk.lcm.event_log import LogError
from fwk.model.errors import PlanError, hint
from fwk.model.plan import Plan
from fwk.plan.load import LaunchOptions, load_plan

RUN_BROKEN = 1
BAD_INPUT = 2
RECORDING = "log.lcm"
NOT_BEGUN = (DebuggerMissing, PortsInUse, ProfilerMissing)

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


@app.command(cls=SeveralNames)
def launch(
    file: Annotated[str, typer.Argument(metavar="FILE", help="launch file, looked for as given, then in launch/")],
    ticks: Annotated[int | None, typer.Option(min=1, metavar="N", help="stop after N ticks")] = None,
    time: Annotated[
        float | None, typer.Option(parser=seconds, metavar="SECONDS", help="stop after this much logical time")
    ] = None,
    speed: Annotated[
        float | None,
        typer.Option(parser=parse_speed, metavar="F|max", help="pace of simulated time; max: as fast as it goes"),
    ] = None,
    seed: Annotated[int | None, typer.Option(min=0, metavar="N", help="seed of the run")] = None,
    record: Annotated[
        Path | None,
        typer.Option(parser=new_file, metavar="FILE", help="where the LCM log goes; default: in the run directory"),
    ] = None,
    no_record: Annotated[bool, typer.Option("--no-record", help="keep no LCM log")] = False,
    sets: Annotated[
        list[str] | None, typer.Option("--set", metavar="PATH=VALUE", help="override a setting; repeatable")
    ] = None,
    hosting: Annotated[
        Hosting, typer.Option(help="one process a component, one a namespace, or one for all")
    ] = Hosting.PROCESS,
    only: Annotated[
        list[str] | None, typer.Option(metavar="NAME...", help="only these components; several names or repeated")
    ] = None,
    without: Annotated[
        list[str] | None, typer.Option(metavar="NAME...", help="all but these components; several names or repeated")
    ] = None,
    debug: Annotated[
        str | None, typer.Option(metavar="NAME", help="run this component under pdb in this terminal")
    ] = None,
    debugpy: Annotated[
        int | None,
        typer.Option(min=1, max=65535, metavar="PORT", help="with --debug: wait for debugpy at this port, not for pdb"),
    ] = None,
    profile: Annotated[
        str | None, typer.Option(metavar="NAME", help="find out where this component's iterations take their time")
    ] = None,
    bus_port: Annotated[
        int | None, typer.Option(min=1024, max=65535, metavar="N", help="first port of the inner buses")
    ] = None,
    video: Annotated[
        Path | None,
        typer.Option(parser=video_file, metavar="FILE.mp4", help="draw the run into a video when it has ended"),
    ] = None,
    watch: Annotated[
        bool, typer.Option("--watch", help="reload components whose source files change, as soon as they do")
    ] = False,
    plain: Annotated[bool, typer.Option("--plain", help="lines of text instead of the live display")] = False,
) -> None:
    """Runs a launch file in the foreground; Ctrl-C stops everything.

    Exit codes: 0 all went well, 1 a component failed or the run broke, 2 bad input. Ctrl-C is no failure.
    """
    if record and no_record:
        raise typer.BadParameter("--record and --no-record exclude each other; keep one")
    if video and no_record:
        raise typer.BadParameter("--video is made from the recording; leave out --no-record")
    if debugpy and not debug:
        raise typer.BadParameter("--debugpy belongs to --debug NAME; say which component")
    wishes = LaunchOptions(
        sets=tuple(sets or ()),
        hosting=hosting.value,
        only=tuple(only or ()),
        without=tuple(without or ()),
        seed=seed,
        speed=speed,
        bus_port=bus_port,
    )
    with _ending():
        plan = load_plan(file, wishes)
        _check_names(plan, {"--debug": debug, "--profile": profile})
        _check_video(plan, video)
        run_dir = make_run_dir(plan.name)
        write_run_files(run_dir, plan)
        options = RunOptions(
            run_dir,
            ticks=ticks,
            time_s=time,
            speed=plan.speed,
            record=None if no_record else record or run_dir / RECORDING,
            video=video,
            debug=debug,
            debugpy_port=debugpy or 0,
            profile=profile,
            watch=watch,
            plain=plain or debug is not None,
        )
        for line in introduction(plan):
            typer.echo(line)
        removed = prune(run_dir.parent, plan.runs.keep, round(plan.runs.size_gb * GB))
        if removed:
            typer.echo(f"removed the {len(removed)} oldest run directories; 'fwk runs keep RUN' would keep one")
        try:
            outcome = run(plan, options)
        except NOT_BEGUN:
            shutil.rmtree(run_dir, ignore_errors=True)  # of no run; 'fwk log' would take it for the newest
            raise
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # who keeps Ctrl-C pressed means the run, which has ended
    for line in summary(plan, options, outcome):
        typer.echo(line)
    if profile or video:
        signal.signal(signal.SIGINT, signal.default_int_handler)  # what may take long can be ended
    if profile:
        for line in write_profiles(run_dir):
            typer.echo(line)
    if options.record and options.video:
        _draw(plan, options.record, options.video)
    raise typer.Exit(outcome.exit_code)


@contextmanager
def _ending() -> Iterator[None]:
    """Turns what keeps a run from starting into a sentence and an exit code."""
    try:
        yield
    except (*NOT_BEGUN, PlanError, RunDirError) as error:
        typer.echo(error, err=True)
        raise typer.Exit(BAD_INPUT) from error
    except KeyboardInterrupt as interrupt:
        typer.echo("interrupted before the start", err=True)
        raise typer.Exit(0) from interrupt


def _check_names(plan: Plan, named: dict[str, str | None]) -> None:
    names = [component.name for component in plan.components]
    for option, name in named.items():
        if name and name not in names:
            raise typer.BadParameter(f"{option}: no component '{name}' in {plan.file}; {hint(name, names)}")


def _check_video(plan: Plan, video: Path | None) -> None:
    if video and not plan.video:
        raise typer.BadParameter(f"--video: {plan.file} names no drawing; add a line 'video: module:function'")


def _draw(plan: Plan, record: Path, video: Path) -> None:
    from fwk.recording.video import VideoError, drawing, render_video  # OpenCV, for those who ask for it

    try:
        video.parent.mkdir(parents=True, exist_ok=True)
        pictures = render_video(record, video, drawing(plan.video))
    except (VideoError, LogError, OSError) as error:
        typer.echo(f"no video: {error}", err=True)
        raise typer.Exit(RUN_BROKEN) from error
    typer.echo(f"video: {video}, {pictures} pictures")


def main() -> None:
    """Runs the command line."""
    app(prog_name="fwk-launch")


if __name__ == "__main__":
    main()
