"""Lines printed before a run, and at its end: result, pace, losses, failures, recording."""

from pathlib import Path

from fwk.display import figures
from fwk.display.lines import losses
from fwk.display.plan_overview import overview
from fwk.display.scoreboard import Scoreboard
from fwk.lcm.log_file import LogError
from fwk.lcm.log_parts import exists, parts_of
from fwk.model.plan import Plan
from fwk.model.sections import choice_in_words
from fwk.supervisor.options import Outcome, RunOptions

_SLOWEST = 3


def introduction(plan: Plan) -> list[str]:
    """Returns the first lines of a run: its parts, and how to look at its messages."""
    lines = overview(plan)
    if not plan.record.has_all_channels:
        lines.append(f"recorded, without a replay: {choice_in_words(plan.record)}")
    if plan.public_url:
        url = "" if plan.public_url == Plan.public_url else f" --url '{plan.public_url}'"
        lines.append(f'to see its messages: fwk spy{url}; for LCM programs in Java: CLASSPATH="$(fwk spy --jar)"')
    return lines


def summary(plan: Plan, options: RunOptions, outcome: Outcome) -> list[str]:
    """Returns the closing lines of a run, those of the application first."""
    status = outcome.status
    rate = outcome.ticks / outcome.wall_s if outcome.wall_s else 0.0
    pace = outcome.logical_s / outcome.wall_s if outcome.wall_s else 0.0
    lines = [
        *Scoreboard(plan.scoreboard).summary(outcome.newest.get),
        f"{plan.name}: {outcome.reason}",
        *(_advice() if "not ready after" in outcome.reason else ()),
        f"{outcome.ticks} ticks, {outcome.logical_s:.2f} s of logical time in {outcome.wall_s:.2f} s: "
        f"{rate:.1f} ticks/s, {pace:.2f} times real time",
    ]
    slowest = figures.slowest(figures.loop_times(status), _SLOWEST)
    if slowest:
        named = ", ".join(f"{time.name} {time.mean_ms:.2f} ms (worst {time.worst_ms:.1f})" for time in slowest)
        lines += [f"slowest: {named}", f"messages and ticks: {losses(status)}"]
    lines += [
        f"{component.name} {component.state}: {component.reason or 'no reason given'}"
        for component in figures.components(status)
        if component.state not in figures.WELL
    ]
    if options.record and (not outcome.deleted or exists(options.record)):
        lacks = f"; {outcome.unrecorded} messages are missing in it" if outcome.unrecorded else ""
        lines.append(f"recording: {_files(options.record)}{lacks}")
    if not outcome.deleted or options.run_dir.exists():
        lines.append(f"run directory: {options.run_dir}")
    return lines


def _files(log: Path) -> str:
    """Returns the files of a recording as they are now: compressed ones have other names than the log."""
    try:
        files = parts_of(log)
    except LogError:
        return str(log)
    return str(files[0]) if len(files) == 1 else f"{files[0]} to {files[-1].name}, {len(files)} files"


def _advice() -> list[str]:
    """Returns advice for processes that are not ready in time."""
    return ["a busy machine starts many processes slowly; --hosting robot or --hosting single starts fewer"]
