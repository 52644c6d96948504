"""The opponents: obstacles on the field that are none of the team, followed from frame to frame."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from procs.world_model.robot_tracks import RobotTracks, without_known
from procs.world_model.seen import Seen
from procs.world_model.team import Mate


@dataclass(frozen=True)
class OpponentSettings:
    """Which obstacles can be opponents."""

    half_length_m: float
    """From the field's centre as far along x as a robot of the match may be."""
    half_width_m: float
    deviation_m: float
    """Obstacles seen with a larger standard deviation are not used."""
    mate_radius_m: float
    """An obstacle this near to a mate is that mate; further away only if it was seen so poorly."""
    timeout_s: float


class Opponents:
    """`advance`, then what the robot and each of its mates saw."""

    def __init__(self) -> None:
        self.tracks = RobotTracks()

    def advance(self, duration_s: float, settings: OpponentSettings) -> None:
        """Time goes on."""
        self.tracks.predict(duration_s, settings.timeout_s)

    def see(self, seen: Seen) -> None:
        """What one robot saw of `strangers`."""
        self.tracks.see(seen.positions_m, seen.covariances_m2)


def strangers(seen: Seen, team: Sequence[Mate], now_s: float, settings: OpponentSettings) -> Seen:
    """Those of the obstacles that are on the field, seen well enough, and none of the team."""
    if not len(seen.positions_m):
        return seen
    covariances_m2 = seen.covariances_m2
    on_field = (np.abs(seen.positions_m) <= (settings.half_length_m, settings.half_width_m)).all(axis=1)
    clear = np.trace(covariances_m2, axis1=1, axis2=2) <= settings.deviation_m**2
    team_m = np.array([mate.position_at(now_s) for mate in team])
    team_m2 = np.array([mate.covariance_at(now_s) for mate in team])
    unknown = without_known(seen.positions_m, covariances_m2, team_m, team_m2, settings.mate_radius_m)
    return seen.only(on_field & clear & unknown)
