"""Set pieces: only the team that takes it plays the ball; rivals keep their distance until it is free (2016)."""

from collections.abc import Collection

from procs.model.game_states import State
from procs.model.teams import Team, team_number
from procs.referee.fouls.foul import Foul, Scene
from procs.referee.positions import in_wrong_half, too_near
from procs.referee.reasons import Reason
from procs.referee.restarts import Restart


def breach(scene: Scene, restart: Restart, excused: frozenset[str], keeper: str, released: bool) -> Foul | None:
    """Returns the breach that repeats a set piece; robots that were misplaced at its start are excused.

    Rivals keep their distance until the ball is `released`, or a second robot has touched it: the taker may turn with
    it first. A rival that keeps its distance to the spot, or to a ball that was taken elsewhere, is not too near.
    `keeper` is the goalkeeper that faced it at the start: one that takes its place later has left no area.
    """
    if restart.team is Team.NONE:
        return None
    rivals = [name for name in scene.sight.touching if team_number(name) is restart.team.other]
    taken = scene.touches.of_team(restart.team)
    if rivals and not taken:
        return Foul(min(rivals), Reason.EARLY_TOUCH, restart.spot)
    if released or len(scene.touches.robots) > 1:
        return None
    near = set(_too_near(scene, restart)) - excused
    if taken:
        near &= set(_too_near(scene, restart._replace(spot=scene.sight.ball)))
    intruders = [name for name in near if not taken or team_number(name) is restart.team.other]
    if intruders:
        return Foul(_first(intruders, restart.team), Reason.TOO_NEAR, restart.spot)
    if taken:
        return None
    crossed = set(in_wrong_half(restart, scene.sight.robots, scene.ends, scene.rules.intrusion_m)) - excused
    if crossed:
        return Foul(_first(crossed, restart.team), Reason.WRONG_HALF, restart.spot)
    return _keeper_left_goal(scene, restart, keeper) if keeper not in excused else None


def _too_near(scene: Scene, restart: Restart) -> list[str]:
    return too_near(restart, scene.sight.robots, scene.ends, scene.rules, scene.rules.intrusion_m)


def _first(robots: Collection[str], team: Team) -> str:
    """Returns the robot that is named of several: a rival of the team that takes the set piece, if there is one."""
    return min(robots, key=lambda name: (team_number(name) is team, name))


def _keeper_left_goal(scene: Scene, restart: Restart, keeper: str) -> Foul | None:
    if restart.state is not State.PENALTY or not keeper or keeper != scene.sight.goalkeeper(restart.team.other):
        return None
    side = scene.ends.side_of(restart.team.other)
    if scene.rules.field.in_goal_area(*scene.sight.robots[keeper], side, scene.rules.intrusion_m):
        return None
    return Foul(keeper, Reason.KEEPER_LEFT, restart.spot)
