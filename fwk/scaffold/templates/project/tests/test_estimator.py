"""The estimator smooths readings and warns once."""

from fwk.testing import Bench
from things.estimator import Estimator


def test_the_estimate_moves_half_way_to_the_reading() -> None:
    bench = Bench(Estimator, gain=0.5)
    for range_m in (8.0, 4.0):
        bench.reading.put(range_m=range_m)
        bench.iterate()
    assert [sent.range_m for sent in bench.distance.sent] == [8.0, 6.0]


def test_a_near_object_is_logged_once() -> None:
    bench = Bench(Estimator, near_m=1.0)
    for _ in range(3):
        bench.reading.put(range_m=0.5)
        bench.iterate()
    assert [line.text for line in bench.logged] == ["the object is 0.50 m away"]
