"""`fwk bisect RUN`: finds the commit that changed what components write."""

import dataclasses
import json
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.recordings.find_log import failing, find_log
from fwk.cli.run_options import Json
from fwk.program import BAD_INPUT, FAILED
from fwk.recording.replay.recording import Recording, RecordingError
from fwk.testing.bisect import BisectError, Commit, Found, repository_of
from fwk.testing.bisect import bisect as search


def bisect(
    run: Annotated[Path, typer.Argument(metavar="RUN_OR_LOG", help="a run directory, its name, or its log")],
    good: Annotated[str, typer.Option(metavar="REV", help="commit where the condition does not hold")],
    bad: Annotated[str, typer.Option(metavar="REV", help="later commit where it holds")] = "HEAD",
    when: Annotated[
        str, typer.Option(metavar="EXPR", help="'differs', or a condition: 'cyan1.odometry.x_m > 3'")
    ] = "differs",
    only: Annotated[list[str] | None, typer.Option(metavar="NAME", help="only these components; repeatable")] = None,
    repo: Annotated[
        Path | None, typer.Option(metavar="FOLDER", help="git repository of the code; default: that of the run")
    ] = None,
    as_json: Json = False,
) -> None:
    """Finds the first commit with which the replayed components write what meets a condition.

    Every commit is tried in a temporary worktree, with the recorded inputs; a commit that cannot replay them is
    skipped.

    Exit codes: 0 found; 1 several commits are left, because those between cannot be replayed; 2 bad input.
    """
    with failing(BAD_INPUT):
        log = find_log(run).resolve()
        try:
            folders = [str(repo)] if repo else [*Recording(log).plan.folders, "."]
            found = search(log, repository_of(folders), good, bad, when, only or (), lambda tried: _say(tried, as_json))
        except (BisectError, RecordingError) as error:
            typer.echo(f"error: {error}", err=True)
            raise typer.Exit(BAD_INPUT) from error
    if as_json:
        typer.echo(json.dumps(dataclasses.asdict(found), indent=2))
    else:
        for line in _lines(found, when):
            typer.echo(line)
    raise typer.Exit(0 if len(found.commits) == 1 else FAILED)


def _say(commit: Commit, as_json: bool) -> None:
    typer.echo(str(commit), err=as_json)


def _lines(found: Found, when: str) -> list[str]:
    commit = found.commits[0]
    if len(found.commits) > 1:
        names = [f"  {each.revision} {each.subject}" for each in found.commits]
        return [f"one of these commits is the first one where '{when}' holds; the others cannot be replayed:", *names]
    difference = [f"  {commit.text}"] if commit.text else []
    return [
        f"the first commit where '{when}' holds, from tick {commit.tick} on:",
        f"  {commit.revision} {commit.subject}",
        *difference,
    ]
