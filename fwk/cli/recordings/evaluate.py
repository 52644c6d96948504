"""`fwk eval FILE`: plays a launch file with many seeds at the same time, and measures it."""

import hashlib
import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import AbstractContextManager, contextmanager, suppress
from importlib import import_module
from inspect import signature
from pathlib import Path
from typing import Annotated, Any, cast

import typer

from fwk.cli.arguments import seconds
from fwk.cli.plan_options import Sets
from fwk.cli.recordings.user_folders import use_folders
from fwk.component.child_process import find_words
from fwk.component.program import MODULE
from fwk.model.errors import PlanError
from fwk.model.plan import Plan
from fwk.plan.classes import find_object
from fwk.plan.files.launch_file import FOLDER, INSTALLED
from fwk.plan.load import LaunchOptions, load_plan
from fwk.plan.what_ran import hash_of, imported_modules
from fwk.program import BAD_INPUT, FAILED
from fwk.testing.campaign import Campaign, listed
from fwk.testing.differing import digest_of, digests_of
from fwk.testing.evaluation import Evaluation, failure_of
from fwk.testing.executors import CampaignError, executor_of
from fwk.testing.results import FolderError, cure_of
from fwk.testing.seeds import seeds_of

_RUN_S = 25.0


def _folder(text: str) -> Path:
    """Returns the path of a folder.

    Raises:
        BadParameter: the text is empty.
    """
    if not text.strip():
        raise typer.BadParameter(f"'{text}' names no folder; leave out --out, or use . for this folder")
    return Path(text)


def eval(  # noqa: A001 - the name of the command
    file: Annotated[str, typer.Argument(metavar="FILE", help="launch file that names an 'evaluation'")],
    seeds: Annotated[str, typer.Option(metavar="FIRST..LAST", help="a run is played with each seed")] = "1..4",
    time_s: Annotated[
        float | None,
        typer.Option(
            "--time", parser=seconds, metavar="SECONDS", help=f"logical time of each run; by default {_RUN_S:g}"
        ),
    ] = None,
    jobs: Annotated[int, typer.Option(min=0, help="runs at the same time on this machine; 0: one a processor")] = 0,
    limit_s: Annotated[
        float | None,
        typer.Option(
            "--limit", parser=seconds, metavar="SECONDS", help="wall time of a run; one that takes longer fails"
        ),
    ] = None,
    cluster: Annotated[str, typer.Option(metavar="ADDRESS", help="scheduler of a Dask cluster instead")] = "",
    sets: Sets = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", parser=_folder, metavar="FOLDER", help="results; by default eval-NAME"),
    ] = None,
) -> None:
    """Plays a launch file with many seeds and measures it; an interrupted evaluation goes on where it was.

    FOLDER gets the result of each seed, and what the launch file's evaluation makes of them: tables, pictures.
    A cluster needs: pip install 'fwk[eval]'; its workers need this project and the launch file at the same place.
    It plays a run for each thread of its workers, so --jobs is refused; once it has no workers for 30 s, its runs fail.

    Exit codes: 0 measured; 1 a run failed, or there is no cluster; 2 bad input, or a folder that cannot hold results.
    """
    if cluster and limit_s is not None:
        raise _bad_input("nothing ends runs on a cluster; leave out --limit, or --cluster")
    if cluster and jobs:
        raise _bad_input(
            "the workers of a cluster play as many runs as they have threads; leave out --jobs, or --cluster"
        )
    try:
        plan = load_plan(file, LaunchOptions(sets=sets or ()))
    except PlanError as error:
        typer.echo(str(error), err=True)
        raise typer.Exit(BAD_INPUT) from error
    if not plan.evaluation:
        raise _bad_input(f"{file} names no 'evaluation: module:function'")
    use_folders(plan.folders)
    numbers, folder, modules = _seeds(seeds), out or Path(f"eval-{plan.name}"), _modules(plan)
    if cause := _refusal(plan, sets or (), time_s):
        raise _bad_input(cause)
    time_s = _RUN_S if time_s is None else time_s
    digests = digests_of(plan)
    about = {"file": os.path.normpath(plan.file), "time_s": time_s, "by": plan.evaluation, **digests}
    work = Evaluation(plan.evaluation, plan.folders, tuple(sets or ()), modules if cluster else {}, digests["plan"])
    try:
        code = digest_of(sorted((modules | _programs(plan) | _inputs(plan)).items()))
        with _refused_by(folder):
            campaign = Campaign(folder, about | ({"sets": sets} if sets else {}), code, _flaw_in(plan))
            former = campaign.of_other_code(numbers)
        if former:
            typer.echo(f"note: {_formerly(former)}; remove their files from {folder} to play them again", err=True)

        def executor(runs: int) -> AbstractContextManager[Executor]:
            return executor_of(min(jobs or os.cpu_count() or 1, runs), cluster, limit_s)

        failure = _play(campaign, work, _file_for_runs(plan, cluster), time_s, numbers, executor)
        results, text = campaign.results(numbers), ""
        if results:
            report = _own(plan, "report", f"; the results of the runs stay in {folder}")
            named = {"seeds": results.seeds} if _takes(plan, "report", "seeds") else {}
            with _refused_by(folder):
                text = report(results, folder, **named)
    except CampaignError as error:
        typer.echo(f"error: {error}", err=True)
        raise typer.Exit(BAD_INPUT if isinstance(error, FolderError) else FAILED) from error
    if results:
        typer.echo(text)
    if failure:
        typer.echo(f"error: {failure}", err=True)
        raise typer.Exit(FAILED)


def _bad_input(cause: str) -> typer.Exit:
    typer.echo(f"error: {cause}", err=True)
    return typer.Exit(BAD_INPUT)


def _refusal(plan: Plan, sets: Sequence[str], time_s: float | None) -> str:
    """Returns why the plan's evaluation does not take the settings or the time that were typed, or an empty text."""
    work = cast(Callable[..., Any], find_object(plan.evaluation, plan.folders))
    module = plan.evaluation.partition(":")[0]
    if not callable(getattr(import_module(module), "report", None)):
        return f"{module} has no function 'report', which makes the table; give it 'def report(results, folder) -> str'"
    if any(text.partition("=")[0] == "seed" for text in sets):
        return "--set seed changes no run, because each has a seed of --seeds; leave it out"
    if sets and len(signature(work).parameters) < 4:
        cure = "leave out --set, or give it a fourth parameter, 'sets: Sequence[str]'"
        return f"{plan.evaluation} takes no settings; {cure}"
    if time_s is not None and getattr(import_module(module), "OWN_TIME", False):
        return f"{plan.evaluation} plays each run for a time of its own; leave out --time"
    return ""


def _play(
    campaign: Campaign,
    work: Evaluation,
    file: str,
    time_s: float,
    seeds: range,
    executor_for: Callable[[int], AbstractContextManager[Executor]],
) -> str:
    """Plays the runs that have no whole result yet; returns why runs have none, or an empty text.

    A terminal shows a bar; a file gets a line for each run.

    Raises:
        FolderError: a result cannot be read or written.
    """
    for damaged, flaw in campaign.damaged(seeds).items():
        typer.echo(f"note: {damaged} is damaged: {flaw}; its seed is played again", err=True)
    left = campaign.missing(seeds)
    if not left:
        return ""
    label, shown = f"playing {len(left)} of {len(seeds)} runs", sys.stderr.isatty()
    try:
        with (
            _signals_interrupt(),
            campaign.alone(),
            executor_for(len(left)) as executor,
            typer.progressbar(length=len(left), label=label, file=sys.stderr) as bar,
        ):
            for played, seed in enumerate(campaign.play(work, file, time_s, left, executor), 1):
                bar.update(1)
                if not shown:
                    typer.echo(f"{played} of {len(left)}: seed {seed}", err=True)
    except FolderError:
        raise
    except CampaignError as error:
        return str(error)
    except KeyboardInterrupt:
        kept = len(seeds) - len(campaign.missing(seeds))
        typer.echo(f"note: {kept} of {len(seeds)} runs have results; the same command plays the others", err=True)
        raise
    return ""


def _file_for_runs(plan: Plan, cluster: str) -> str:
    """Returns the launch file as processes in other folders find it; workers find one that comes with fwk by name."""
    path = Path(os.path.normpath(plan.file))
    return path.name if cluster and path.parent == INSTALLED / FOLDER else str(path)


@contextmanager
def _signals_interrupt() -> Iterator[None]:
    """Makes SIGTERM and SIGHUP end the command as Ctrl-C does; one that is ignored, as under nohup, stays ignored."""
    before = {number: signal.getsignal(number) for number in (signal.SIGTERM, signal.SIGHUP)}
    for number, handler in before.items():
        if handler is not signal.SIG_IGN:
            signal.signal(number, signal.default_int_handler)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _modules(plan: Plan) -> dict[str, str]:
    """Returns the hashes of the modules of a plan's components and its evaluation, as far as they are imported."""
    used = [plan.evaluation, *(each.module for each in plan.components)]
    with suppress(ImportError):  # the runs say so
        import_module(plan.evaluation.partition(":")[0])
    return {name: module.sha256 for name, module in imported_modules(used, plan.folders).items()}


def _programs(plan: Plan) -> dict[str, str]:
    """Returns the hashes of the files that the commands of the plan's components name, such as `./adder.py`."""
    commands = [each.config["command"] for each in plan.components if each.module == MODULE]
    words = sorted({word for command in commands for word in command if "/" in word})
    return {word: hash_of(file) for word, file in zip(words, find_words(words, plan.folders), strict=True)}


def _inputs(plan: Plan) -> dict[str, str]:
    """Returns the hashes of the files that the module of the evaluation names in `INPUTS`.

    Raises:
        Exit: one of them cannot be read, or is a pipe or another place that may never end.
    """
    name = plan.evaluation.partition(":")[0]
    files: Sequence[Path | str] = getattr(sys.modules.get(name), "INPUTS", ())
    for file in files:
        if Path(file).exists() and not Path(file).is_file():
            raise _bad_input(f"{file}, one of the INPUTS of {name}, is no ordinary file")
    try:
        return {str(file): hashlib.sha256(Path(file).read_bytes()).hexdigest() for file in files}
    except OSError as error:
        raise _bad_input(f"{error.filename}, one of the INPUTS of {name}: {error.strerror}") from error


def _flaw_in(plan: Plan) -> Callable[[Any], str]:
    """Returns `flaw_in` of the module of the evaluation; without one each result is accepted."""
    module = sys.modules.get(plan.evaluation.partition(":")[0])
    return _own(plan, "flaw_in") if hasattr(module, "flaw_in") else lambda _: ""


def _takes(plan: Plan, name: str, parameter: str) -> bool:
    """Returns whether a function of the evaluation's module has a parameter of that name."""
    function = getattr(import_module(plan.evaluation.partition(":")[0]), name)
    return parameter in signature(function).parameters


def _own(plan: Plan, name: str, cure: str = "") -> Callable[..., str]:
    """Returns a function of the evaluation's module; its errors, except `OSError`, become a `CampaignError`."""
    module = plan.evaluation.partition(":")[0]

    def called(*words: Any, **named: Any) -> str:
        try:
            answer: str = getattr(import_module(module), name)(*words, **named)
        except OSError:  # of the folder
            raise
        except Exception as error:
            raise CampaignError(f"{module}.{name} failed: {failure_of(error)}{cure}") from error
        return answer

    return called


def _formerly(seeds: Sequence[int]) -> str:
    """Says which results are of other code: `the result of seed 3 is of former code`."""
    if len(seeds) == 1:
        return f"the result of seed {seeds[0]} is of former code"
    return f"{len(seeds)} results are of former code, those of seeds {listed(seeds)}"


@contextmanager
def _refused_by(folder: Path) -> Iterator[None]:
    """Names what cannot be read or written in the folder of the results.

    Raises:
        FolderError: something cannot be.
    """
    try:
        yield
    except OSError as error:
        is_file = isinstance(error, (FileExistsError, NotADirectoryError))
        reason = "it is not a folder; name one for the results" if is_file else f"{error.strerror or error}"
        cure = "" if ";" in reason else f"; {cure_of(error)}"
        raise FolderError(f"--out {error.filename or folder}: {reason}{cure}") from error


def _seeds(text: str) -> range:
    """Returns the seeds `1..4`, or the one `7`.

    Raises:
        BadParameter: the text is neither.
    """
    try:
        return seeds_of(text)
    except ValueError as error:
        raise typer.BadParameter(f"--seeds: {error}") from error
