"""Plays pieces of a match as fast as possible and prints how well the robots saw, knew and played.

`python -m procs.evaluation soccer.yaml --seeds 7 8 9 --time 25`
"""

import argparse
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

from fwk.testing import launch_plan, system_of
from procs.evaluation.beliefs import Samples, believed
from procs.evaluation.conduct import conducted
from procs.evaluation.piece import piece_of
from procs.evaluation.table import as_json, as_text, rows_of


def played(file: str, time_s: float, seed: int) -> Samples:
    """Plays one piece of `time_s` and returns the samples of all measures."""
    period_s = launch_plan(file).period_us / 1e6
    system = system_of(file, seed=seed)
    system.tick(round(time_s / period_s))
    piece = piece_of(system.sent, period_s)
    return believed(piece) | conducted(piece)


def main() -> None:
    """Reads the command line, plays, prints the table."""
    parser = argparse.ArgumentParser(prog="python -m procs.evaluation", description=__doc__)
    parser.add_argument("file", nargs="?", default="soccer.yaml", help="launch file")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3], help="a piece is played with each seed")
    parser.add_argument("--time", type=float, default=25.0, help="logical seconds of each piece")
    parser.add_argument("--jobs", type=int, default=1, help="pieces that are played at the same time")
    parser.add_argument("--json", type=Path, help="file for the table as JSON")
    options = parser.parse_args()
    with ProcessPoolExecutor(options.jobs) as pool:
        pieces = list(pool.map(partial(played, options.file, options.time), options.seeds))
    rows = rows_of(pieces)
    print(as_text(rows))
    if options.json:
        options.json.write_text(as_json(rows))


if __name__ == "__main__":
    main()
