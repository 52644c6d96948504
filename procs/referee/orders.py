"""Commands by hand: the referee's decisions, made by a person or by a RefBox, with the names of the RefBox."""

from collections.abc import Callable, Collection

from procs.model.field import Point
from procs.model.game_states import State
from procs.model.right_name import right_name
from procs.model.robot import PLAYERS
from procs.model.teams import Team, team_number
from procs.referee import halves, restarts
from procs.referee.cards import Card
from procs.referee.match import Match
from procs.referee.names import Names
from procs.referee.reasons import REPAIRS, Reason
from procs.referee.refusals import SET_PIECES, begun_by, why_not
from procs.referee.restarts import Restart
from procs.referee.sight import Sight

_USUAL = Names(PLAYERS)
TEAMS = {"": Team.NONE, "cyan": Team.CYAN, "magenta": Team.MAGENTA}
"""Teams by the names that commands give them."""
CARDS = {"yellow_card": Card.YELLOW, "double_yellow": Card.DOUBLE_YELLOW, "red_card": Card.RED}
OF_ROBOT = (*CARDS, *REPAIRS)
"""Commands that name a robot."""
GOALS = ("goal", "subgoal")
"""`subgoal` takes a goal back."""
OF_TEAM = (*SET_PIECES, *GOALS, *OF_ROBOT)
"""Commands that name a team."""
PLAIN = ("start", "stop", "drop_ball", "park", "half_time", "end_game", "reset")
"""Commands without a team or a robot."""
HALVES = {
    "first_half": halves.FIRST,
    "second_half": halves.SECOND,
    "first_half_overtime": halves.THIRD,
    "second_half_overtime": halves.FOURTH,
    "penalties": halves.PENALTIES,
}
"""Commands that begin a part of the match."""
COMMANDS = (*SET_PIECES, *GOALS, *OF_ROBOT, *HALVES, *PLAIN)
"""All commands."""


def mistake_in(name: str, team: str, robot: str, robots: Collection[str], names: Names = _USUAL) -> str:
    """Returns why a command is impossible whatever the state of the match, or an empty text.

    Args:
        name: name of the command.
        team: its team, empty for none.
        robot: namespace of its robot, empty for none.
        robots: namespaces of the robots that there are.
        names: the players' names.
    """
    if name not in COMMANDS:
        return f"no command '{name}'; {right_name(name, COMMANDS)}"
    if team not in TEAMS:
        return f"no team '{team}'; {right_name(team, filter(None, TEAMS))}"
    if name in (*SET_PIECES, *GOALS) and not team:
        return f"'{name}' needs a team: cyan or magenta"
    if team and name not in OF_TEAM:
        return f"'{name}' takes no team, so not {team}; commands with a team are {', '.join(OF_TEAM)}"
    if robot and name not in OF_ROBOT:
        return f"'{name}' takes no robot, so not {robot}; commands with a robot are {', '.join(OF_ROBOT)}"
    if name in OF_ROBOT:
        there = ", ".join(robots) or "none"
        if not team and not robot:
            return f"'{name}' needs a team or a robot; there are {there}"
        if robot and robot not in robots:
            return f"no robot '{robot}'; there are {there}"
        if robot and team and team_number(names.of_player(robot)) is not TEAMS[team]:
            plays = team_number(names.of_player(robot)).name.lower()
            return f"{robot} plays for {plays}, not for {team}"
    return ""


def carry_out(match: Match, sight: Sight, name: str, team: str = "", robot: str = "", names: Names = _USUAL) -> str:
    """Carries out a command; returns why it is impossible, or an empty text. `robot` is a namespace."""
    refused = mistake_in(name, team, robot, names.namespaces(sight.robots), names)
    refused = refused or why_not(match, name, TEAMS[team])
    if refused:
        return refused
    if name in SET_PIECES:
        return _set_piece(match, sight, name, TEAMS[team])
    if name in GOALS:
        return _goal(match, TEAMS[team], name == "goal")
    if name in OF_ROBOT:
        return _robot(match, sight, name, TEAMS[team], robot, names)
    if name in HALVES:
        match.begin_half(HALVES[name], first=match.kicks_off(HALVES[name]))
        return ""
    return _simple(match, sight, name)


def _set_piece(match: Match, sight: Sight, name: str, team: Team) -> str:
    half = begun_by(match, name)
    if half:
        match.begin_half(half, Reason.BY_HAND, team)
        return ""
    place, rules, ends = match.restart_place(sight.ball), match.rules, match.ends
    made: dict[State, Callable[[], Restart]] = {
        State.KICK_OFF: lambda: restarts.kick_off(team),
        State.FREE_KICK: lambda: restarts.after_foul(place, team.other, rules),
        State.GOAL_KICK: lambda: restarts.goal_kick(team, place.y_m, rules, ends),
        State.THROW_IN: lambda: restarts.after_side_line(place, team.other, rules),
        State.CORNER_KICK: lambda: restarts.corner_kick(
            team, Point(ends.side_of(team.other) * rules.field.half_length_m, place.y_m), rules
        ),
        State.PENALTY: lambda: restarts.penalty(team, rules, ends),
    }
    if match.shootout and team is not match.shootout.shooter:
        if match.started:
            match.end_penalty(scored=False)
            if match.at_rest or match.shootout.shooter is team:
                return ""
        match.shootout.shooter = team
    match.interrupt(made[SET_PIECES[name]](), Reason.BY_HAND)
    return ""


def _goal(match: Match, team: Team, more: bool) -> str:
    if more and match.at_rest:
        match.goal(team)
    elif more and match.shootout:
        match.end_penalty(scored=True)
    elif more:
        match.goal(team)
        match.interrupt(restarts.kick_off(team.other))
    elif match.score[team] == 0:
        return f"{team.name.lower()} has no goal to take back; the score is {match.standing}"
    else:
        match.take_back(team)
    return ""


def _robot(match: Match, sight: Sight, name: str, team: Team, namespace: str, names: Names) -> str:
    robot = names.of_player(namespace) if namespace else _chosen(match, sight, name, team)
    if not robot:
        off = ", ".join(names.namespaces(sight.team(team)))
        return f"no robot of {team.name.lower()} is on the field" + (
            off and f"; a robot that is off it has to be named: {off}"
        )
    if name in CARDS:
        match.card(robot, CARDS[name])
    else:
        match.take_out(robot, Reason(name))
    return ""


def _chosen(match: Match, sight: Sight, name: str, team: Team) -> str:
    """Returns the robot that a command for a team means, as a RefBox gives them; empty if none is on the field.

    It is the highest number on the field. The second yellow card goes to a robot that has one.
    """
    robots = sight.without(match.cards.sent_off).team(team)
    warned = [robot for robot in robots if robot in match.cards.warned]
    if name == "double_yellow" and warned:
        robots = warned
    elif name == "yellow_card" and len(warned) < len(robots):
        robots = [robot for robot in robots if robot not in warned]
    return robots[-1] if robots else ""


def _simple(match: Match, sight: Sight, name: str) -> str:
    match name:
        case "start":
            match.start(sight.without(match.cards.sent_off))
        case "stop":
            match.stop(sight.ball)
        case "drop_ball":
            place = match.restart_place(sight.ball)
            match.interrupt(restarts.dropped_ball(place, match.rules), Reason.BY_HAND)
        case "park":
            match.park(sight.robots)
        case "half_time":
            match.end_half()
        case "end_game":
            match.end_match()
        case "reset":
            match.begin_match()
    return ""
