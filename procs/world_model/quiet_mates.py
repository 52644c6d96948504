"""Mates whose messages are late, where the own camera sees them.

The last message of a mate moves it on at constant velocity, which is wrong by a metre after a second. During an outage
of the radio the sightings of the robots of the own team are tracked like those of mates that never tell their places.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from procs.model.estimation import linear_sum_assignment
from procs.world_model.robot_tracks import RobotTracks
from procs.world_model.team import Mate

_LATE_S = 0.25  # a message that is older is late; messages are 0.1 s apart, and one of them may be lost
_STRAYS_M_S = 2.0  # a mate leaves the place that its last message leads to about so fast
_OUT_OF_REACH = 1e3  # cost of a pair that cannot be the same robot, above all distances on the field


def in_time(mates: Sequence[Mate], now_s: float) -> list[Mate]:
    """Returns the mates whose newest messages are not late."""
    return [mate for mate in mates if not _is_late(mate, now_s)]


class QuietMates:
    """Tells which of the robots that the own camera tracks are mates known from their messages."""

    def __init__(self, tracks: RobotTracks) -> None:
        """Starts without such mates.

        Args:
            tracks: robots of the own team, as the own camera sees them.
        """
        self._tracks = tracks
        self._found: dict[str, int] = {}  # number of the track (`RobotTracks.ids`) of each late mate, by its name

    @property
    def ids(self) -> frozenset[int]:
        """Numbers of the tracks that are mates."""
        return frozenset(self._found.values())

    def find(self, mates: Sequence[Mate], now_s: float, near_m: float) -> None:
        """Looks for late mates among the tracks, and drops the tracks of those that are heard again.

        Args:
            mates: as their newest messages state.
            now_s: the present, to which the tracks were moved.
            near_m: distance of a mate from its sighting, besides the way that it strays.
        """
        heard = [self._found[mate.name] for mate in in_time(mates, now_s) if mate.name in self._found]
        if heard:
            self._tracks.drop(heard)
        self._found = {}
        late = [mate for mate in mates if _is_late(mate, now_s)]
        sure = self._tracks.sure.tolist() if late else []
        if not sure:
            return
        told_m = np.array([mate.position_at(now_s) for mate in late])
        apart_m = np.sqrt(((told_m[:, None] - self._tracks.states[None, sure, :2]) ** 2).sum(axis=2))
        reach_m = np.array([near_m + _STRAYS_M_S * (now_s - mate.told_s) for mate in late])
        fits = apart_m <= reach_m[:, None]
        rows, columns = linear_sum_assignment(np.where(fits, apart_m, _OUT_OF_REACH))
        pairs, ids = zip(rows.tolist(), columns.tolist(), strict=True), self._tracks.ids[sure].tolist()
        self._found = {late[row].name: ids[column] for row, column in pairs if fits[row, column]}

    def as_seen(self, mates: Sequence[Mate], passed_s: float, now_s: float) -> list[Mate]:
        """Returns the mates, late ones where they are seen; whatever cannot be seen is that of their messages.

        `passed_s` is the time since the tracks were moved on.
        """
        if not self._found:
            return list(mates)
        rows = self._tracks.rows_after(passed_s)
        tracks = {number: track for track, number in enumerate(self._tracks.ids.tolist())}
        seen = list(mates)
        for index, mate in enumerate(mates):
            track = tracks.get(self._found.get(mate.name, 0))
            if track is not None and _is_late(mate, now_s):
                x_m, y_m, vx_m_s, vy_m_s, _ = rows[track]
                seen[index] = replace(
                    mate,
                    told_s=now_s,
                    position_m=np.array((x_m, y_m)),
                    velocity_m_s=np.array((vx_m_s, vy_m_s)),
                    covariance_m2=self._tracks.covariances[track, :2, :2],
                )
        return seen


def _is_late(mate: Mate, now_s: float) -> bool:
    """Returns whether a message of the mate should have arrived since its newest one."""
    return now_s - mate.told_s > _LATE_S
