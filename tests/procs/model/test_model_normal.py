"""The standard normal distribution."""

import pytest

from procs.model.normal import normal_cdf


@pytest.mark.parametrize(("deviations", "share"), [(0.0, 0.5), (1.0, 0.8413), (-1.96, 0.025), (9.0, 1.0)])
def test_share_below_a_deviation(deviations: float, share: float) -> None:
    assert normal_cdf(deviations) == pytest.approx(share, abs=1e-4)


def test_far_tail_is_not_lost_in_rounding() -> None:
    assert 0.0 < normal_cdf(-10.0) < 1e-22
