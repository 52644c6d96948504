"""The retransmission timeout: usual durations, repetitions in vain, losses."""

import random

from fwk.bus.retransmission import RetransmissionTimeout

USUAL_US = 4_000


def learnt() -> RetransmissionTimeout:
    """Returns a timeout that knows stages of 4 ms."""
    timeout = RetransmissionTimeout()
    for _ in range(200):
        timeout.took(USUAL_US)
    return timeout


def test_timeout_learns_usual_duration() -> None:
    assert USUAL_US < learnt().wait_us < USUAL_US + 500


def test_lost_ticks_leave_the_timeout_short() -> None:
    timeout = learnt()
    before_us = timeout.wait_us
    for _ in range(50):
        timeout.repeated()
        timeout.took(USUAL_US, repeated=True)
        timeout.took(USUAL_US)
    assert timeout.wait_us <= before_us


def test_repetition_in_vain_widens_the_margin() -> None:
    timeout = learnt()
    for _ in range(20):
        timeout.repeated()
        timeout.answered_twice()
        timeout.took(USUAL_US, repeated=True)
    assert USUAL_US + 4_000 < timeout.wait_us < USUAL_US + 6_000


def test_lost_tick_sets_the_margin_back() -> None:
    timeout = learnt()
    before_us = timeout.wait_us
    for _ in range(20):
        timeout.repeated()
        timeout.took(USUAL_US, repeated=True)
        timeout.answered_twice()  # the second answer may come when the stage has ended
    assert timeout.wait_us > before_us + 4_000
    timeout.repeated()
    timeout.took(USUAL_US, repeated=True)
    timeout.took(USUAL_US)
    assert timeout.wait_us == before_us


def test_timeout_follows_stages_that_became_longer() -> None:
    timeout = learnt()
    for _ in range(60):
        left_us, late = 10 * USUAL_US, False
        while left_us > timeout.wait_us:
            left_us, late = left_us - timeout.wait_us, True
            timeout.repeated()
        timeout.took(left_us, repeated=late)
        timeout.answered_twice()
    assert timeout.wait_us > 2 * USUAL_US


def test_stage_held_up_for_long_teaches_little() -> None:
    timeout = learnt()
    before_us = timeout.wait_us
    for _ in range(100):
        timeout.repeated()
    timeout.took(100, repeated=True)
    for _ in range(100):
        timeout.answered_twice()
    assert timeout.wait_us < 2 * before_us


def test_few_stages_of_varying_duration_are_repeated() -> None:
    timeout, rng, repetitions = RetransmissionTimeout(), random.Random(1), 0
    for _ in range(2_000):
        duration_us = USUAL_US + round(rng.expovariate(1 / 400))
        late = duration_us > timeout.wait_us
        repetitions += late
        if late:
            timeout.repeated()
            timeout.answered_twice()
        timeout.took(duration_us, repeated=late)
    assert repetitions < 20
