"""Runs a launch file of the current folder as a system in memory and writes its messages to `memory.lcm`.

python -m tests.harness.in_memory FILE TICKS SEED
"""

import subprocess
import sys
from importlib import import_module
from pathlib import Path

from fwk.lcm.event_log import LogWriter
from fwk.plan.load import LaunchOptions, load_plan
from fwk.testing import MemorySystem

LOG = "memory.lcm"


def played_in_memory(folder: Path, file: str, ticks: int, seed: int) -> Path:
    """Runs a launch file of a user's folder in memory, in a separate process; returns the log of its messages."""
    command = [sys.executable, "-m", "tests.harness.in_memory", file, str(ticks), str(seed)]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=60)
    assert done.returncode == 0, done.stderr
    return folder / LOG


def main(file: str, ticks: int, seed: int) -> None:
    """Runs the launch file with the classes of its plan, each in the stages that the plan gives it."""
    plan = load_plan(file, LaunchOptions(seed=seed))
    parts = {}
    for each in plan.components:
        base = getattr(import_module(each.module), each.class_name)
        parts[each.name] = type(base.__name__, (base,), {"stage": tuple(plan.stages[stage] for stage in each.stages)})
    turns = {each.name: (each.every, each.offset) for each in plan.components}
    settings = {each.name: each.config for each in plan.components}
    system = MemorySystem(parts, settings, seed=seed, stages=plan.stages, turns=turns)
    system.tick(ticks)
    with LogWriter(Path(LOG), print) as log:
        for channel, sent in system.sent.items():
            for data in sent:
                log.append(channel, data, 0)


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
