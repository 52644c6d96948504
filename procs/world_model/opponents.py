"""Opponents: obstacles on the field that are not robots of the team, tracked from frame to frame."""

from dataclasses import dataclass

import numpy as np

from procs.world_model.robot_tracks import without_known
from procs.world_model.seen import Seen
from procs.world_model.team import Places


@dataclass(frozen=True)
class OpponentSettings:
    """Criteria for obstacles that can be opponents."""

    half_length_m: float
    """Limit along x, from the field's centre."""
    half_width_m: float
    """Limit along y, from the field's centre."""
    deviation_m: float
    """Obstacles seen with a larger standard deviation are not used."""
    mate_radius_m: float
    """Distance within which an obstacle is taken for a mate; larger for obstacles seen poorly."""


def strangers(seen: Seen, team: Places, seen_s: float, settings: OpponentSettings) -> Seen:
    """Returns the obstacles that are on the field, seen well enough, and not robots of the team.

    `seen_s` is the time of the exposure: mates are compared where they were then.
    """
    if not len(seen.positions_m):
        return seen
    covariances_m2 = seen.covariances_m2
    on_field = (np.abs(seen.positions_m) <= (settings.half_length_m, settings.half_width_m)).all(axis=1)
    clear = covariances_m2[:, 0, 0] + covariances_m2[:, 1, 1] <= settings.deviation_m**2
    unknown = without_known(seen.positions_m, covariances_m2, *team.at(seen_s), settings.mate_radius_m)
    return seen.only(on_field & clear & unknown)
