"""The standard normal distribution."""

import math


def normal_cdf(deviations: float) -> float:
    """Returns the probability that a value of the standard normal distribution is below `deviations`."""
    return 0.5 * math.erfc(-deviations / math.sqrt(2.0))
