"""The provider measures, and the user of the aspect notices a low level."""

from fwk.testing import Bench
from things.thing import Thing, ThingUser


def test_thing_loses_level() -> None:
    bench = Bench(Thing, loss=0.5)
    bench.iterate(3)
    assert [sent.value for sent in bench.thing.sent] == [0.5, 0.0, 0.0]


def test_thing_user_notices_a_low_level_once() -> None:
    bench = Bench(ThingUser)
    for value in (0.5, 0.2, 0.1):
        bench.port("level.thing").put(value=value)
        bench.iterate()
    assert [line.text for line in bench.logged] == ["the level is low"]
