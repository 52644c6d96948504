"""`fwk replay RUN --to-tick N --then-live`: goes on live from a tick of a recording."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import typer

from fwk.cli.run.run_directory import make_run_dir
from fwk.cli.run.run_files import write_run_files
from fwk.program import FAILED, notice
from fwk.recording.difference import Difference
from fwk.recording.differing import differing, lines_of
from fwk.recording.replay.branch import Branch
from fwk.recording.replay.branch_log import begun_log, last_tick
from fwk.recording.replay.other_classes import with_classes
from fwk.recording.replay.recording import Recording, RecordingError

LOG = "log.lcm"


@dataclass(frozen=True)
class BranchRequest:
    """Options of a branch."""

    to_tick: int
    """Last recorded tick that counts."""
    until_tick: int | None
    """Last live tick; None: the last one of the recording."""
    sets: Sequence[str] = ()
    """New settings after the branch, as `NAME.SETTING=VALUE`."""
    classes: Sequence[str] = ()
    """Other classes of components, as `NAME=module:Class`."""
    record: Path | None = None
    """The new recording; None: in a new run directory."""


def go_on_live(recording: Recording, asked: BranchRequest, as_json: bool) -> None:
    """Replays a recording up to a tick, goes on live, and says where the new recording is.

    Raises:
        RecordingError: the recording cannot be branched there, or a component fails.
    """
    until_tick = _last_live_tick(recording, asked)
    classes = dict(_pair(text) for text in asked.classes)
    with_classes(recording, classes)
    branch = Branch(recording, classes)
    settings = branch.check(asked.sets, asked.to_tick)  # a mistake is named before the replay, which takes long
    branch.run(asked.to_tick)
    branch.check_state()
    log_path = asked.record or _new_log(recording)
    sink = begun_log(
        log_path, recording, asked.to_tick, branch.cameras_again, branch.in_envelopes, lambda text: notice(text)
    )
    try:
        branch.go_on(until_tick, sink, settings)
    except RecordingError as error:
        typer.echo(f"error: {error}\n{log_path}: holds the branch until then", err=True)
        raise typer.Exit(FAILED) from error
    finally:
        sink.close()
    differences = branch.differences
    if as_json:
        rows = [row.plain() for row in differing(differences, recording.plan)]
        said: dict[str, Any] = {"log": str(log_path), "branch_tick": asked.to_tick, "last_tick": until_tick}
        said |= {"absent": branch.absent, "refused": branch.decisions.participants.refused, "differing_before": rows}
        typer.echo(json.dumps(said, indent=2))
        return
    for line in _notes(branch, differences, recording, asked.to_tick):
        typer.echo(line, err=True)
    typer.echo(f"live from tick {asked.to_tick + 1} to tick {until_tick}: {log_path}")


def _last_live_tick(recording: Recording, asked: BranchRequest) -> int:
    recorded = last_tick(recording.path)
    if asked.to_tick > recorded:
        raise RecordingError(f"{recording.path}: no tick {asked.to_tick}; the last one is {recorded}")
    until_tick = recorded if asked.until_tick is None else asked.until_tick
    if until_tick <= asked.to_tick:
        raise RecordingError(
            f"{recording.path}: no live tick after tick {asked.to_tick}; choose a later end with --until-tick"
        )
    return until_tick


def _notes(branch: Branch, differences: Sequence[Difference], recording: Recording, to_tick: int) -> list[str]:
    said = [f"not in the branch: {name}: {reason}" for name, reason in branch.absent.items()]
    said += branch.decisions.participants.refused
    if differences:
        rows = differing(differences, recording.plan)
        names = ", ".join(row.component for row in rows)
        said.append(f"up to tick {to_tick} these write something else than in the run, so their state differs: {names}")
        said += lines_of(rows)
    return said


def _new_log(recording: Recording) -> Path:
    run_dir = make_run_dir(f"{recording.plan.name}-branch")
    write_run_files(run_dir, recording.plan)
    return run_dir / LOG


def _pair(text: str) -> tuple[str, str]:
    name, equals, word = text.partition("=")
    if not (name and equals and ":" in word):
        raise RecordingError(f"--with {text}: write NAME=module:Class")
    return name, word
