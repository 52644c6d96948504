"""A histogram of durations: constant memory, each duration known to a sixteenth of itself."""

from collections.abc import Iterable
from typing import Any

_EXACT = 32  # microseconds up to which each has a bucket of its own
_FINE_BITS = 4  # of a duration above, what tells its bucket beside the power of two


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
        """One from its parts."""
        made = cls()
        made.counts, made.total_us, made.worst_us = dict(counts), total_us, worst_us
        return made

    @property
    def count(self) -> int:
        """How many durations."""
        return sum(self.counts.values())

    @property
    def mean_us(self) -> float:
        """Their mean; 0 if there are none."""
        return self.total_us / self.count if self.counts else 0.0

    def percentile_us(self, percent: float) -> int:
        """The duration that so many percent of all do not exceed; 0 if there are none."""
        wanted, found = self.count * percent / 100, 0
        for bucket, count in sorted(self.counts.items()):
            found += count
            if found >= wanted:
                return min(longest_us(bucket), self.worst_us)
        return 0

    def rows(self) -> list[tuple[int, int]]:
        """The longest duration that each bucket counts, and how many it has, the shortest first."""
        return [(longest_us(bucket), count) for bucket, count in sorted(self.counts.items())]

    def since(self, before: "Histogram") -> "Histogram":
        """What was counted after `before` was taken of the same histogram; its worst is that of the highest bucket."""
        left = {bucket: count - before.counts.get(bucket, 0) for bucket, count in self.counts.items()}
        if min(left.values(), default=0) < 0 or self.total_us < before.total_us:  # it began anew meanwhile
            return self
        counts = {bucket: count for bucket, count in left.items() if count}
        worst_us = min(self.worst_us, longest_us(max(counts))) if counts else 0
        return Histogram.of(counts.items(), self.total_us - before.total_us, worst_us)

    def to_json(self) -> dict[str, Any]:
        """Plain data for JSON."""
        return {"counts": sorted(self.counts.items()), "total_us": self.total_us, "worst_us": self.worst_us}

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> "Histogram":
        """Reads back what `to_json` gave."""
        return cls.of(((bucket, count) for bucket, count in data["counts"]), data["total_us"], data["worst_us"])


def longest_us(bucket: int) -> int:
    """The longest duration that a bucket counts."""
    if bucket < _EXACT:
        return bucket
    shift = (bucket >> _FINE_BITS) - 1
    return (((bucket & (1 << _FINE_BITS) - 1) + (1 << _FINE_BITS) + 1) << shift) - 1
