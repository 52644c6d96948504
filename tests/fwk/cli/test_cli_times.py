"""Histograms as figures."""

from fwk.cli.look.times import Stopwatch
from fwk.model.histogram import Histogram


def answer(*durations_us: int) -> dict[str, object]:
    made = Histogram()
    for duration_us in durations_us:
        made.add(duration_us)
    return {
        "loop": made.to_json(),
        "cycle": Histogram().to_json(),
        "stages": {},
        "components": {"r/it": made.to_json()},
    }


def test_figures_come_with_their_histogram() -> None:
    stopwatch = Stopwatch("picture")
    stopwatch.measure(answer(3, 3, 1000))
    figures = stopwatch.measure(answer(3, 3, 1000, 3, 5))["components"]["r/it"]
    assert figures["histogram"] == [[0.003, 1], [0.005, 1]]
    assert (figures["count"], figures["p50_ms"], figures["max_ms"]) == (2, 0.003, 0.005)
