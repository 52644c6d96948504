"""The service answers each request."""

from fwk.testing import Bench
from lcmtypes.core import answer_t
from things.thing import Thing


def test_thing_replies_with_the_sum_or_a_reason() -> None:
    bench = Bench(Thing, largest=10.0)
    bench.thing.put(a=1.0, b=2.0)
    bench.thing.put(a=10.0, b=2.0)
    bench.iterate()
    done, rejected = bench.thing.sent
    assert (done.answer.state, done.sum) == (answer_t.DONE, 3.0)
    assert (rejected.answer.state, rejected.answer.reason) == (answer_t.REJECTED, "a sum of 12 is too large")
