"""Stored results of pieces: the samples of each measure as JSON, and what makes a result unusable."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from procs.evaluation.beliefs import Samples
from procs.evaluation.table import MEASURES, Measure, frequency, rate, ratio, rms, root_99, root_ratio, share
from procs.model.frames import Floats

_PAIRS = (rate, ratio, root_ratio)
_NOT_NEGATIVE = (rate, rms, root_99, root_ratio)


def samples_in(result: Mapping[str, Any]) -> Samples:
    """Returns the samples of all measures; those that the result does not have, as one of former code, are empty.

    Raises:
        ValueError: a measure has values that are not its samples; the text names it.
    """
    return {each.name: _samples(result.get(each.name, []), each) for each in MEASURES}


def flaw_in(result: Any) -> str:
    """Returns why a result is not one of a piece, or an empty text."""
    if not isinstance(result, Mapping) or not any(each.name in result for each in MEASURES):
        return "it holds no measure of a match"
    try:
        samples_in(result)
    except ValueError as error:
        return str(error)
    return ""


def _samples(values: Any, measure: Measure) -> Floats:
    """Returns samples as they were measured, (n), or (n, 2) for pairs; null is NaN.

    Raises:
        ValueError: they are others.
    """
    pairs = measure.statistic in _PAIRS
    if values == []:
        return np.empty((0, 2) if pairs else 0)
    try:
        plain = np.array(values)
        if any(isinstance(each, str) for each in (plain.flat if plain.dtype.kind in "OU" else ())):
            raise ValueError
        samples = np.asarray(plain, np.float64)
        if samples.ndim != 1 + pairs or (pairs and samples.shape[1] != 2):
            raise ValueError
    except (ValueError, TypeError, OverflowError) as error:
        kind = "pairs of numbers" if pairs else "numbers"
        raise ValueError(f"'{measure.name}' should be a list of {kind}") from error
    told = samples if measure.statistic is share else samples[~np.isnan(samples)]
    if (measure.unit == "share" or measure.statistic is frequency) and not np.isin(told, (0.0, 1.0)).all():
        raise ValueError(f"'{measure.name}' should be a list of ones and zeros")
    if measure.statistic in _NOT_NEGATIVE and (samples < 0.0).any():
        raise ValueError(f"'{measure.name}' has a value below zero")
    return samples
