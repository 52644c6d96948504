"""The component counts in steps."""

from fwk.testing import Bench
from things.thing import Thing


def test_thing_counts_in_steps() -> None:
    bench = Bench(Thing, step=2.0)
    bench.iterate(3)
    assert [sent.value for sent in bench.thing.sent] == [2.0, 4.0, 6.0]
