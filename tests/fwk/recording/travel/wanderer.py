"""Counts to 60 with a snapshot at each number, then goes back to the numbers given, each time after one step.

Prints where each front begins.

python -m tests.fwk.recording.travel.wanderer NUMBER...
"""

import os
import signal
import sys

from fwk.recording.travel.snapshots import Snapshots, run_session


def work(snapshots: Snapshots) -> int:
    """Returns the number from which the last front came, as exit code."""
    left = [int(word) for word in sys.argv[1:]]
    begun = number = 0
    while True:
        number += 1
        order = snapshots.take(number, number, float(number))
        if order is not None:
            left, begun = order, number
            print(f"from {number}", flush=True)
        if number == (begun + 1 if begun else 60):
            if not left:
                return begun
            if left[0] == 0:
                os.kill(os.getpid(), signal.SIGKILL)
            go_back(snapshots, left)


def go_back(snapshots: Snapshots, left: list[int]) -> None:
    """Goes back to the newest living snapshot at or before the first of the numbers."""
    while snapshot := snapshots.last_before(lambda each: each.tick <= left[0]):
        snapshots.go_back(snapshot, left[1:])


if __name__ == "__main__":
    sys.exit(run_session(work))
