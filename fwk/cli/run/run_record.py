"""Record of a run in its run directory: `run.json` from its start, `result.json` from its end."""

import contextlib
import json
import os
from dataclasses import dataclass
from pathlib import Path

from fwk.clock import US_PER_S, wall_us
from fwk.model.plan import Plan

RUN_FILE = "run.json"
RESULT_FILE = "result.json"


@dataclass(frozen=True)
class RunRecord:
    """Start and result of a run; None or empty text: unknown, as in run directories of older versions."""

    name: str = ""
    started_us: int | None = None
    """Wall time since the epoch in microseconds."""
    seed: int | None = None
    duration_s: float | None = None
    """Wall time of the run in seconds; None until it has ended."""
    ticks: int | None = None
    result: str = ""
    """Why the run ended, for people."""
    exit_code: int | None = None


def write_start(folder: Path, plan: Plan, name: str) -> None:
    """Writes the record of the start of a run."""
    about = {
        "name": name,
        "plan": plan.name,
        "file": plan.file,
        "seed": plan.seed,
        "bus_port": plan.bus_port,
        "pid": os.getpid(),
        "started_us": wall_us(),
    }
    (folder / RUN_FILE).write_text(json.dumps(about, indent=1) + "\n")


def write_result(folder: Path, exit_code: int, reason: str, ticks: int, wall_s: float) -> None:
    """Writes the result of a run; a run directory that was deleted during the run stays deleted."""
    result = {"exit_code": exit_code, "result": reason, "ticks": ticks, "duration_s": wall_s, "ended_us": wall_us()}
    with contextlib.suppress(OSError):
        (folder / RESULT_FILE).write_text(json.dumps(result, indent=1) + "\n")


def read_record(folder: Path) -> RunRecord:
    """Returns the record of a run; damaged files count as missing."""
    about, result = _read(folder / RUN_FILE), _read(folder / RESULT_FILE)
    exit_code = _number(result, "exit_code")
    return RunRecord(
        name=str(about.get("name", "")),
        started_us=_number(about, "started_us"),
        seed=_number(about, "seed"),
        duration_s=_seconds(result),
        ticks=_number(result, "ticks"),
        result=str(result.get("result", "")),
        exit_code=exit_code,
    )


def age_s(record: RunRecord) -> float | None:
    """Returns the wall time since the start of a run in seconds."""
    return None if record.started_us is None else (wall_us() - record.started_us) / US_PER_S


def _read(file: Path) -> dict[str, object]:
    try:
        found = json.loads(file.read_bytes())
    except (OSError, ValueError, RecursionError):
        return {}
    return found if isinstance(found, dict) else {}


def _number(found: dict[str, object], key: str) -> int | None:
    value = found.get(key)
    return value if isinstance(value, int) and abs(value) < 1 << 63 else None


def _seconds(found: dict[str, object]) -> float | None:
    value = found.get("duration_s")
    return float(value) if isinstance(value, int | float) and 0 <= value < 1e12 else None
