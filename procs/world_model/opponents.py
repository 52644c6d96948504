"""Opponents: obstacles on the field that are not robots of the team, tracked from frame to frame."""

from dataclasses import dataclass

import numpy as np

from procs.world_model.robot_tracks import any_near, without_known
from procs.world_model.seen import Seen
from procs.world_model.team import Places

_DRIFTS_S = 0.5  # a mate that is silent for longer may be anywhere, so it explains only what is near its last place


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

    `seen_s` is the time of the exposure, at which the places of mates are compared.
    """
    if not len(seen.positions_m):
        return seen
    covariances_m2 = seen.covariances_m2
    places_m, spreads_m2 = seen.positions_m.tolist(), [(one[0][0], one[1][1]) for one in covariances_m2.tolist()]
    most_m2 = settings.deviation_m**2
    chosen = np.array(
        [
            abs(x_m) <= settings.half_length_m and abs(y_m) <= settings.half_width_m and xx_m2 + yy_m2 <= most_m2
            for (x_m, y_m), (xx_m2, yy_m2) in zip(places_m, spreads_m2, strict=True)
        ]
    )
    # Obstacles in messages of mates are seldom near the team: the mates have left out robots of the team themselves.
    if any_near(places_m, spreads_m2, team.rows_at(seen_s, _DRIFTS_S), settings.mate_radius_m):
        chosen &= without_known(seen.positions_m, covariances_m2, *team.at(seen_s, _DRIFTS_S), settings.mate_radius_m)
    return seen if chosen.all() else seen.only(chosen)
