"""A histogram of durations."""

from hypothesis import given
from hypothesis import strategies as some

from fwk.model.histogram import Histogram, longest_us

DURATIONS = some.lists(some.integers(0, 2**40), min_size=1, max_size=50)


def histogram(durations: list[int]) -> Histogram:
    made = Histogram()
    for duration_us in durations:
        made.add(duration_us)
    return made


@given(some.integers(0, 2**45))
def test_a_duration_is_known_to_a_sixteenth(duration_us: int) -> None:
    (bucket,) = histogram([duration_us]).counts
    assert duration_us <= longest_us(bucket) <= duration_us * 17 / 16
    assert bucket == 0 or longest_us(bucket - 1) < duration_us
    assert bucket < 700


@given(DURATIONS, some.sampled_from([50, 95, 99, 100]))
def test_a_percentile_is_not_exceeded_by_that_share(durations: list[int], percent: int) -> None:
    made = histogram(durations)
    found = made.percentile_us(percent)
    assert sum(duration <= found for duration in durations) * 100 >= percent * len(durations)
    exact = sorted(durations)[-(-percent * len(durations) // 100) - 1]
    assert exact <= found <= exact * 17 / 16
    assert (made.count, made.worst_us, made.mean_us) == (
        len(durations),
        max(durations),
        sum(durations) / len(durations),
    )


@given(DURATIONS, DURATIONS)
def test_durations_since_a_moment_are_the_difference(before: list[int], after: list[int]) -> None:
    made = histogram(before)
    earlier = Histogram.from_json(made.to_json())
    for duration_us in after:
        made.add(duration_us)
    since, alone = made.since(earlier), histogram(after)
    assert (since.counts, since.total_us) == (alone.counts, alone.total_us)
    assert alone.worst_us <= since.worst_us <= alone.worst_us * 17 / 16


def test_a_histogram_that_began_anew_is_taken_whole() -> None:
    assert histogram([5, 6]).since(histogram([5, 5, 5])).counts == {5: 1, 6: 1}


def test_an_empty_histogram_has_no_figures() -> None:
    empty = Histogram()
    assert (empty.count, empty.mean_us, empty.percentile_us(99), empty.since(empty).worst_us) == (0, 0.0, 0, 0)
