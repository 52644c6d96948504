"""The program in C counts in steps."""

import subprocess
from pathlib import Path

from fwk.testing import program_bench

NATIVE = Path(__file__).parents[1] / "native"
PROGRAM = str(NATIVE / "build/thing")
WRITES = {"thing": "thing.thing_t"}


def test_thing_counts_in_steps() -> None:
    subprocess.run(["make", "--silent", "-C", NATIVE], check=True)
    bench = program_bench([PROGRAM], writes=WRITES, coding="lcm")
    bench.iterate(3)
    bench.finalize()
    assert [sent.value for sent in bench.thing.sent] == [1.0, 2.0, 3.0]
