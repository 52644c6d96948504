"""From runs to the published figures."""

import pytest

from tools.bench.figures import Run, Runs, Spread, percentile, tick_mean_us, tick_us


def run(number: int, peer: str, *ticks_us: float, scenario: str = "N=5") -> Run:
    return Run(number, peer, scenario, {"tick_us": list(ticks_us), "stale": None})


def test_spread_is_median_and_extremes() -> None:
    assert Spread.of([3.0, 1.0, 10.0]) == Spread(3.0, 1.0, 10.0, 3)
    with pytest.raises(ValueError, match="no round"):
        Spread.of([])


@pytest.mark.parametrize(
    ("share", "expected"), [(0.0, 1), (0.5, 50), (0.99, 99), (0.991, 100), (1.0, 100)], ids=lambda value: str(value)
)
def test_percentile_by_nearest_rank(share: float, expected: int) -> None:
    assert percentile(list(range(100, 0, -1)), share) == expected


def test_percentile_refuses_no_values_and_bad_fractions() -> None:
    with pytest.raises(ValueError, match="0 values"):
        percentile([], 0.5)
    with pytest.raises(ValueError, match=r"1\.5"):
        percentile([1.0], 1.5)


def test_median_hides_the_rare_and_mean_does_not() -> None:
    result = {"tick_us": [100.0] * 9 + [5100.0]}
    assert tick_us(result) == 100
    assert tick_mean_us(result) == 600


def test_ratio_compares_within_a_round() -> None:
    # the machine was half as fast in round 1: the ratio is unaffected
    runs = Runs([run(0, "fwk", 120), run(0, "lcm", 100), run(1, "fwk", 240), run(1, "lcm", 200)])
    assert runs.ratio("fwk", "lcm", "N=5") == Spread(1.2, 1.2, 1.2, 2)


def test_ratio_leaves_out_rounds_without_a_partner() -> None:
    failed = Run(1, "lcm", "N=5", {"error": "no first tick"})
    runs = Runs([run(0, "fwk", 150), run(0, "lcm", 100), run(1, "fwk", 900), failed])
    assert runs.ratio("fwk", "lcm", "N=5") == Spread(1.5, 1.5, 1.5, 1)
    assert runs.ratio("fwk", "zmq", "N=5") is None


def test_ratio_between_two_arrangements() -> None:
    runs = Runs([run(0, "fwk", 800, scenario="N=160"), run(0, "fwk", 100, scenario="N=20")])
    ratio = runs.ratio("fwk", "fwk", "N=160", "N=20")
    assert ratio is not None
    assert ratio.middle == 8


def test_a_failed_run_is_left_out_and_named() -> None:
    failed = [Run(number, "dora", "N=5", {"error": "no first tick"}) for number in range(2)]
    runs = Runs(failed)
    assert runs.of("dora", "N=5") == []
    assert runs.spread("dora", "N=5", tick_us) is None
    assert runs.errors("dora", "N=5") == ["no first tick"]


def test_a_figure_that_a_run_lacks_is_left_out() -> None:
    assert Runs([run(0, "unix", 1.0)]).spread("unix", "N=5", lambda result: result["stale"]) is None
