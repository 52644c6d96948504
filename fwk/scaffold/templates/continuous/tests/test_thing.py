"""The component counts its iterations."""

from fwk.testing import Bench
from things.thing import Thing


def test_thing_counts_its_iterations() -> None:
    bench = Bench(Thing, scale=0.5)
    bench.iterate(2)
    assert [sent.value for sent in bench.thing.sent] == [0.5, 1.0]
