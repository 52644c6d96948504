"""`fwk-launch FILE`: checks a launch file, runs it and reports the result."""

import re
import shutil
import signal
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer

from fwk.bus.port_lock import PortLock
from fwk.cli.arguments import Hosting, SeveralNames, new_file, record_parts, seconds, video_file
from fwk.cli.arguments import speed as parse_speed
from fwk.cli.commands import VersionFlag
from fwk.cli.examples import epilog
from fwk.cli.plan_options import ProcessHosting, Sets
from fwk.cli.run.console import beside, check_library
from fwk.cli.run.detach import detach as detach_run
from fwk.cli.run.free_ports import on_free_ports
from fwk.cli.run.profile import write_profiles
from fwk.cli.run.run_directory import GB, RunDirError, make_run_dir, prune
from fwk.cli.run.run_files import write_run_files
from fwk.cli.run.run_record import write_result, write_start
from fwk.control.runs import look
from fwk.control.server import ControlNameError
from fwk.display.keys import restore, terminal_settings
from fwk.display.summary import introduction, summary
from fwk.launcher.machine import MachineError, advice, check_machine
from fwk.launcher.run import DebuggerMissingError, PortsInUseError, ProfilerMissingError, RunOptions, run
from fwk.lcm.log_file import LogError, check_compression
from fwk.model.errors import PlanError, hint
from fwk.model.plan import Plan
from fwk.model.ports import Ports
from fwk.model.signals import ignore
from fwk.plan.load import LaunchOptions, load_plan
from fwk.program import BAD_INPUT, imported, notice

RUN_BROKEN = 1
RECORDING = "log.lcm"
NOT_BEGUN = (ControlNameError, DebuggerMissingError, MachineError, PortsInUseError, ProfilerMissingError)
_RUN_NAME = re.compile(r"[A-Za-z][\w.-]{0,63}", re.ASCII)

app = typer.Typer(add_completion=False, pretty_exceptions_enable=False)


def _run_name(text: str) -> str:
    if not _RUN_NAME.fullmatch(text):
        raise typer.BadParameter(f"'{text}' is not a run name; use letters, digits, '.', '_', '-', a letter first")
    return text


@app.command(cls=SeveralNames, epilog=epilog("fwk-launch"))
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
    record_channels: Annotated[
        list[str] | None,
        typer.Option(
            metavar="PATTERN", help="record only these channels, such as 'cyan1/*', without a replay; repeatable"
        ),
    ] = None,
    record_exclude: Annotated[
        list[str] | None,
        typer.Option(metavar="PATTERN", help="record all but these channels, without a replay; repeatable"),
    ] = None,
    record_split: Annotated[
        Any,
        typer.Option(
            parser=record_parts, metavar="SIZE|TIME", help="record in parts of this size (200MB) or time (60s)"
        ),
    ] = None,
    record_compress: Annotated[
        bool, typer.Option("--record-compress", help="compress finished parts, and the rest at the end")
    ] = False,
    sets: Sets = None,
    hosting: ProcessHosting = Hosting.PROCESS,
    only: Annotated[
        list[str] | None, typer.Option(metavar="NAME...", help="only these components; several names or repeated")
    ] = None,
    without: Annotated[
        list[str] | None, typer.Option(metavar="NAME...", help="all but these components; several names or repeated")
    ] = None,
    outside: Annotated[
        list[str] | None,
        typer.Option(
            metavar="CHANNEL",
            help="with --without: programs outside and fwk send write this channel, or pattern; repeatable",
        ),
    ] = None,
    run_name: Annotated[
        str | None,
        typer.Option(
            "--run",
            parser=_run_name,
            metavar="NAME",
            help="name of the run, beside others on ports of its own; default: the plan's name",
        ),
    ] = None,
    detach: Annotated[bool, typer.Option("--detach", help="run in the background; return at the first tick")] = False,
    debug: Annotated[
        str | None, typer.Option(metavar="NAME", help="run this component under pdb in this terminal")
    ] = None,
    debugpy: Annotated[
        int | None,
        typer.Option(min=1, max=65535, metavar="PORT", help="with --debug: wait for debugpy at this port, not for pdb"),
    ] = None,
    profile: Annotated[
        str | None, typer.Option(metavar="NAME", help="measure where this component's iterations spend their time")
    ] = None,
    bus_port: Annotated[
        int | None, typer.Option(min=1024, max=65535, metavar="N", help="first port of the inner buses")
    ] = None,
    video: Annotated[
        Path | None,
        typer.Option(parser=video_file, metavar="FILE.mp4", help="draw the run into a video when it has ended"),
    ] = None,
    watch: Annotated[bool, typer.Option("--watch", help="reload components when their source files change")] = False,
    web: Annotated[bool, typer.Option("--web", help="serve the console for this run, as 'fwk web' does")] = False,
    plain: Annotated[bool, typer.Option("--plain", help="lines of text instead of the live display")] = False,
    _version: VersionFlag = False,
) -> None:
    """Runs a launch file, in the foreground unless --detach is given; Ctrl-C stops everything.

    Exit codes: 0 success, also after Ctrl-C; 1 a component failed or the run broke; 2 bad input.
    """
    if record and no_record:
        raise typer.BadParameter("--record and --no-record exclude each other; keep one")
    if video and no_record:
        raise typer.BadParameter("--video is made from the recording; leave out --no-record")
    if no_record and (record_split or record_compress):
        raise typer.BadParameter("--record-split and --record-compress need a recording; leave out --no-record")
    if web:
        check_library()
    if debugpy and not debug:
        raise typer.BadParameter("--debugpy belongs to --debug NAME; name a component")
    if detach and debug and not debugpy:
        raise typer.BadParameter("--detach leaves pdb without a terminal; add --debugpy PORT, or leave out --detach")
    launch_options = LaunchOptions(
        sets=tuple(sets or ()),
        hosting=hosting.value,
        only=tuple(only or ()),
        without=tuple(without or ()),
        outside=tuple(outside or ()),
        seed=seed,
        speed=speed,
        bus_port=bus_port,
        record_channels=tuple(record_channels or ()),
        record_exclude=tuple(record_exclude or ()),
        record_parts={**(record_split or {}), **({"compress": True} if record_compress else {})},
        run_only=video is None,
    )
    with _ending(), ExitStack() as held:
        plan = load_plan(file, launch_options, notice)
        _check_names(plan, {"--debug": debug, "--profile": profile})
        _check_video(plan, video)
        if plan.record.compress and not no_record:
            check_compression()
        name = _checked_name(run_name, plan)
        if run_name and bus_port is None:
            plan, lock = on_free_ports(plan)
        else:
            lock = PortLock(Ports.of(plan), plan.file or plan.name, plan.public_url)
        held.callback(lock.release)
        check_machine(plan)
        run_dir = make_run_dir(name)
        if detach:
            detach_run(run_dir, plan.bus_port, name)
            lock.belong_to_this_process()
        write_run_files(run_dir, plan)
        write_start(run_dir, plan, name)
        options = RunOptions(
            run_dir,
            name=name,
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
        for line in (*introduction(plan), *advice(plan)):
            typer.echo(line)
        if web:
            typer.echo(f"console: {beside(name, run_dir)}")
        removed = prune(run_dir.parent, plan.runs.keep, round(plan.runs.size_gb * GB))
        if removed:
            which = f"{len(removed)} oldest run directories" if len(removed) > 1 else "oldest run directory"
            typer.echo(f"removed the {which}; 'fwk runs keep RUN' keeps one")
        terminal = terminal_settings()
        try:
            outcome = run(plan, options, lock)
        except NOT_BEGUN:
            shutil.rmtree(run_dir, ignore_errors=True)  # of no run; 'fwk log' would take it for the newest
            raise
        finally:
            restore(0, terminal)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        ignore(number)  # repeated signals are meant for the run, which has ended
    write_result(run_dir, outcome.exit_code, outcome.reason, outcome.ticks, outcome.wall_s)
    for line in summary(plan, options, outcome):
        typer.echo(line)
    if profile or video:
        signal.signal(signal.SIGINT, signal.default_int_handler)  # profile and video may take long
    if profile:
        for line in write_profiles(run_dir):
            typer.echo(line)
    if options.record and options.video:
        _draw(plan, options.record, options.video)
    raise typer.Exit(outcome.exit_code)


@contextmanager
def _ending() -> Iterator[None]:
    """Turns errors before the start of a run into a sentence and an exit code."""
    imported()
    try:
        yield
    except (*NOT_BEGUN, PlanError, RunDirError, LogError) as error:
        typer.echo(error, err=True)
        raise typer.Exit(BAD_INPUT) from error
    except KeyboardInterrupt as interrupt:
        typer.echo("interrupted before the start", err=True)
        raise typer.Exit(0) from interrupt


def _checked_name(wanted: str | None, plan: Plan) -> str:
    if wanted and any(run.get("name") == wanted for run in look().values()):
        raise typer.BadParameter(f"--run: a run is called '{wanted}' already; choose another name, or end that run")
    return wanted or plan.name


def _check_names(plan: Plan, named: dict[str, str | None]) -> None:
    names = [component.name for component in plan.components]
    for option, name in named.items():
        if name and name not in names:
            raise typer.BadParameter(f"{option}: no component '{name}' in {plan.file}; {hint(name, names)}")


def _check_video(plan: Plan, video: Path | None) -> None:
    if video and not plan.video:
        raise typer.BadParameter(f"--video: {plan.file} names no drawing; add a line 'video: module:function'")


def _draw(plan: Plan, record: Path, video: Path) -> None:
    from fwk.cli.run.rendering import render, report  # imports OpenCV, only with --video
    from fwk.recording.video import VideoError, drawing

    try:
        video.parent.mkdir(parents=True, exist_ok=True)
        first, *others = report(video, render(record, video, drawing(plan.video)))
    except (VideoError, LogError, OSError) as error:
        typer.echo(f"no video: {error}", err=True)
        raise typer.Exit(RUN_BROKEN) from error
    except KeyboardInterrupt:
        return
    for line in (f"video: {first}", *others):
        typer.echo(line)
