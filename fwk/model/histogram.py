"""Histogram of durations with constant memory and a resolution of one sixteenth."""

from collections.abc import Iterable
from typing import Any

_EXACT = 32  # microseconds up to which each has a bucket of its own
_FINE_BITS = 4  # number of buckets for each power of two above


class Histogram:
    """Durations in microseconds of wall time, counted in buckets that grow with the duration."""

    def __init__(self) -> None:
        self.counts: dict[int, int] = {}
        self.total_us = 0
        self.worst_us = 0

    def add(self, duration_us: int) -> None:
        """Counts a duration."""
        self.total_us += duration_us
        if duration_us > self.worst_us:
            self.worst_us = duration_us
        if duration_us < _EXACT:
            bucket = duration_us if duration_us > 0 else 0
        else:
            shift = duration_us.bit_length() - _FINE_BITS - 1
            bucket = (shift << _FINE_BITS) + (duration_us >> shift)
        self.counts[bucket] = self.counts.get(bucket, 0) + 1

    @classmethod
    def of(cls, counts: Iterable[tuple[int, int]], total_us: int, worst_us: int) -> "Histogram":
        """Returns a histogram with these counts."""
        made = cls()
        made.counts, made.total_us, made.worst_us = dict(counts), total_us, worst_us
        return made

    @property
    def count(self) -> int:
        """Number of durations."""
        return sum(self.counts.values())

    @property
    def mean_us(self) -> float:
        """Mean duration in us; 0 if there are none."""
        return self.total_us / self.count if self.counts else 0.0

    def percentile_us(self, percent: float) -> int:
        """Returns the duration in us that `percent` of all durations do not exceed; 0 if there are none."""
        wanted, found = self.count * percent / 100, 0
        for bucket, count in sorted(self.counts.items()):
            found += count
            if found >= wanted:
                return min(longest_us(bucket), self.worst_us)
        return 0

    def rows(self) -> list[tuple[int, int]]:
        """Yields the longest duration of each bucket in us and its count, shortest first."""
        return [(longest_us(bucket), count) for bucket, count in sorted(self.counts.items())]

    def since(self, before: "Histogram") -> "Histogram":
        """Returns the durations counted since `before`; its worst is the longest of the highest bucket."""
        left = {bucket: count - before.counts.get(bucket, 0) for bucket, count in self.counts.items()}
        if min(left.values(), default=0) < 0 or self.total_us < before.total_us:  # it has been reset since
            return self
        counts = {bucket: count for bucket, count in left.items() if count}
        worst_us = min(self.worst_us, longest_us(max(counts))) if counts else 0
        return Histogram.of(counts.items(), self.total_us - before.total_us, worst_us)

    def to_json(self) -> dict[str, Any]:
        """Returns plain data for JSON."""
        return {"counts": sorted(self.counts.items()), "total_us": self.total_us, "worst_us": self.worst_us}

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> "Histogram":
        """Returns the histogram of plain data from `to_json`."""
        return cls.of(((bucket, count) for bucket, count in data["counts"]), data["total_us"], data["worst_us"])


def longest_us(bucket: int) -> int:
    """Returns the longest duration of a bucket in us."""
    if bucket < _EXACT:
        return bucket
    shift = (bucket >> _FINE_BITS) - 1
    return (((bucket & (1 << _FINE_BITS) - 1) + (1 << _FINE_BITS) + 1) << shift) - 1
