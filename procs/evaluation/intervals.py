"""Intervals that hold a value with a probability of 95 %: of few pieces, of trials, and of rates of events."""

import math

_Z = 1.96  # of a normal distribution, 95 % lie within so many deviations
_NEVER = 3.0  # events that were expected at most, with a probability of 95 %, if none was seen
_TAIL = 0.025

Interval = tuple[float, float]


def widened(value: float, drawn: Interval, pieces: int, possible: Interval) -> Interval:
    """Widens an interval of redrawn pieces about its value, within what is possible; infinite limits stay.

    Few pieces redrawn vary less than pieces do: their variance is too small by (n - 1) / n, and as it is estimated
    from the same pieces, Student's distribution takes the place of the normal one.
    """
    from scipy.special import stdtrit  # takes a moment, which each start of a match would pay, too

    factor = float(stdtrit(pieces - 1, 1.0 - _TAIL)) / _Z * math.sqrt(pieces / (pieces - 1))
    low, high = (each if not math.isfinite(each - value) else value + factor * (each - value) for each in drawn)
    return max(possible[0], low), min(possible[1], high)


def wilson(successes: int, trials: int) -> Interval:
    """Returns the limits between which the probability of a success lies with 95 % (Wilson's score interval, 1927)."""
    part, square = successes / trials, _Z**2 / trials
    middle = (part + square / 2) / (1 + square)
    half = _Z * math.sqrt(part * (1 - part) / trials + square / (4 * trials)) / (1 + square)
    return max(0.0, middle - half), min(1.0, middle + half)


def never(time: float) -> Interval:
    """Returns the limits of the rate of an event that was not seen in a time."""
    return 0.0, _NEVER / time


def poisson(events: float, time: float) -> Interval:
    """Returns the limits of the rate of independent events that were counted in a time (Garwood's interval, 1936)."""
    from scipy.special import gammaincinv

    low = float(gammaincinv(events, _TAIL)) if events else 0.0
    return low / time, float(gammaincinv(events + 1, 1.0 - _TAIL)) / time


def difference(events: float, others: float, time: float) -> Interval:
    """Returns the limits of the difference of two rates, from those of each (Zou and Donner, 2008)."""
    rate, other = events / time, others / time
    (low, high), (other_low, other_high) = poisson(events, time), poisson(others, time)
    below, above = math.hypot(rate - low, other_high - other), math.hypot(high - rate, other - other_low)
    return rate - other - below, rate - other + above
