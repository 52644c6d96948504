"""Evaluation of a match for `fwk eval`: plays a piece in memory, measures it, and reports all pieces together."""

import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from fwk.testing import launch_plan, system_of
from procs.evaluation.beliefs import Samples, believed
from procs.evaluation.claims import claims
from procs.evaluation.conduct import conducted
from procs.evaluation.delays import delays
from procs.evaluation.innovations import innovations
from procs.evaluation.piece import TRUTH, Piece, piece_of
from procs.evaluation.possession import possession
from procs.evaluation.report_files import write_report
from procs.evaluation.results import flaw_in, samples_in
from procs.evaluation.sightings import sightings
from procs.evaluation.table import as_text, rows_of
from procs.evaluation.team_ball import team_ball
from procs.model.robot import RobotModel

__all__ = ["flaw_in", "measured", "report", "samples_of"]


def measured(
    file: str, time_s: float, seed: int, sets: Sequence[str] = ()
) -> dict[str, list[float] | list[list[float]]]:
    """Plays one piece of `time_s`, with settings that are overridden, and returns the samples of all measures.

    Raises:
        ValueError: the piece would have no tick, or there is no truth to measure it by.
    """
    plan = launch_plan(file, tuple(sets))
    if not any(channel.name == TRUTH for channel in plan.channels):
        raise ValueError(f"no component writes {TRUTH}, which is what a match is measured by; include msl-field.yaml")
    period_s = plan.period_us / 1e6
    ticks = round(time_s / period_s)
    if not ticks:
        raise ValueError(f"--time {time_s:g} is shorter than a tick; it should be {period_s:g} s at least")
    system = system_of(file, seed=seed, sets=sets)
    system.tick(ticks)
    robot = _robot_of(each.config for each in plan.components if each.namespace == "world")
    piece = piece_of(system.sent, period_s, robot)
    return {name: samples.tolist() for name, samples in samples_of(piece).items()}


def _robot_of(settings: Iterable[Mapping[str, Any]]) -> RobotModel:
    """Returns the geometry of robots that one of the components' settings states; the usual one if none does."""
    return RobotModel(**next((each["robot"] for each in settings if "robot" in each), {}))


def samples_of(piece: Piece) -> Samples:
    """Returns the samples of every measure of a piece."""
    beliefs = believed(piece) | sightings(piece) | innovations(piece) | claims(piece) | team_ball(piece)
    return beliefs | delays(piece) | conducted(piece) | possession(piece)


def report(results: Sequence[Mapping[str, list[float] | list[list[float]]]], folder: Path) -> str:
    """Writes table.csv and table.json into the folder, and measures.png if matplotlib is there; returns the table.

    Measures without a value are left out: no match has all, and a result of former code may have others.
    """
    rows = [row for row in rows_of([samples_in(result) for result in results]) if not math.isnan(row.value)]
    return "\n".join(filter(None, (as_text(rows), write_report(rows, folder))))
