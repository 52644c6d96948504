"""Runs many short systems with random faults and replays each; prints differences and keeps their folders.

python -m tests.faults.stress --seed 1 --runs 10 --load 2 --clock wall
"""

import argparse
import contextlib
import random
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from fwk.lcm.type_registry import use_types_of
from tests.harness.fate import Fate
from tests.harness.runs import Launched, PortBlock, pause, replayed, write_files
from tests.programs.control_system import Steered
from tests.programs.everything import everything
from tests.programs.together import FILE


def stressed(folder: Path, seed: int, *, real_time: bool, groups: bool, strikes: int, env: dict[str, str]) -> str:
    """Performs one run with its replay; returns a description of the failure, or nothing."""
    luck, ports = random.Random(seed), PortBlock()
    write_files(folder, everything(ports.public_url, real_time=real_time, groups=groups))
    use_types_of(folder)
    run = Launched(folder, ports, (FILE, "--record", "log.lcm", "--seed", str(seed)), env)
    try:
        fate = Fate(Steered(run, ports), ports, luck)
        for _ in range(strikes):
            fate.strike()
            pause(luck.random() * 0.2)
        run.signal(signal.SIGINT)
        code = run.wait()
        (folder / "struck.txt").write_text("\n".join(fate.done))
        if code:
            return f"exit code {code}\n{run.text}"
        replayed(folder)
    except (AssertionError, subprocess.TimeoutExpired) as error:
        return f"{type(error).__name__}: {error}"
    finally:
        run.end()
        ports.release()
    return ""


@contextlib.contextmanager
def busy(processes: int) -> Iterator[None]:
    """Processes that use all processor time they can get."""
    spinning = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(processes)]
    try:
        yield
    finally:
        for each in spinning:
            each.kill()
            each.wait()


def main() -> int:
    """Performs all runs; returns 1 if any of them failed."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--runs", type=int, default=10)
    parser.add_argument("--strikes", type=int, default=20)
    parser.add_argument("--load", type=int, default=0, help="processes that keep the machine busy")
    parser.add_argument("--loss", default="0", help="share of datagrams that get lost")
    parser.add_argument("--clock", choices=("wall", "simulated", "both"), default="both")
    asked = parser.parse_args()
    wrong = 0
    with busy(asked.load):
        for seed in range(asked.seed, asked.seed + asked.runs):
            folder = Path(tempfile.mkdtemp(prefix=f"fwk-stress-{seed}-"))
            real_time = asked.clock == "wall" or (asked.clock == "both" and seed % 2 == 0)
            env = {"FWK_TEST_LOSS": asked.loss}
            said = stressed(folder, seed, real_time=real_time, groups=seed % 4 > 1, strikes=asked.strikes, env=env)
            wrong += bool(said)
            print(f"seed {seed}: {'kept in ' + str(folder) if said else 'equal'}\n{said}".rstrip(), flush=True)
            if not said:
                subprocess.run(["rm", "-rf", str(folder)], check=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
