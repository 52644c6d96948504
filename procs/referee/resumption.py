"""Resumption: a referee that was restarted goes on with the match that its messages state.

They do not state the fouls that brought no card yet, the touches since the last start, whether a person has stopped
the game, and which deciding penalties a person has taken back; these are forgotten.
"""

import math
from collections.abc import Iterable, Sequence

from lcmtypes.soccer import game_event_t, game_state_t
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.geometry import plausible
from procs.model.teams import Team
from procs.referee import halves
from procs.referee.cards import Card
from procs.referee.match import Match
from procs.referee.names import Names
from procs.referee.reasons import OFF_FIELD, Reason
from procs.referee.restarts import Restart
from procs.referee.rules import Rules
from procs.referee.shootout import Shootout
from procs.referee.sight import Sight


def resume(
    match: Match, told: game_state_t, events: Sequence[game_event_t], sight: Sight, names: Names, placements: int
) -> bool:
    """Puts a match into the state that was told last, and returns whether that is one of a match.

    Args:
        match: a match that has not begun.
        told: the newest state of the game.
        events: the history of the match.
        sight: what the referee sees now.
        names: the players' names.
        placements: number of the newest placement, which no later one may have.
    """
    numbers = told.time_in_half_s, told.time_in_state_s, told.ball_x_m, told.ball_y_m
    known = told.state in set(State) and told.state_team in set(Team) and halves.FIRST <= told.half <= halves.PENALTIES
    if not (known and plausible(*numbers)) or min(told.score_cyan, told.score_magenta, *numbers[:2]) < 0:
        return False
    restart = Restart(State(told.state), Team(told.state_team), Point(told.ball_x_m, told.ball_y_m))
    _show_cards(match, told, events, names)
    match.resume(told.half, restart, bool(told.stopped), placements, sight.without(match.cards.sent_off))
    match.score = {Team.CYAN: told.score_cyan, Team.MAGENTA: told.score_magenta}
    match.time_in_half_s, match.time_in_state_s = told.time_in_half_s, told.time_in_state_s
    if told.half == halves.PENALTIES:
        match.shootout = _shootout(match.rules, restart.team, events)
    return True


def _show_cards(match: Match, told: game_state_t, events: Sequence[game_event_t], names: Names) -> None:
    newest = {event.robot: event.card for event in events if event.card}
    for robot in [robot for robot, card in newest.items() if card == Card.YELLOW]:
        match.cards.show(names.of_player(robot), Card.YELLOW, match.rules)
    for robot in told.sent_off:
        match.cards.take_out(names.of_player(robot), _left_s(robot, told, events, match.rules))


def _left_s(robot: str, told: game_state_t, events: Iterable[game_event_t], rules: Rules) -> float:
    """Returns how long a robot stays beside the field; of an earlier half, only the time of this one has passed."""
    left_s = 0.0
    for event in events:
        passed_s = told.time_in_half_s - (event.time_in_half_s if event.half == told.half else 0.0)
        if event.robot == robot and event.card == Card.RED:
            return math.inf
        if event.robot == robot and event.card == Card.DOUBLE_YELLOW:
            left_s = max(left_s, rules.double_yellow_s - passed_s)
        elif event.reason in OFF_FIELD and event.robot in (robot, ""):
            left_s = max(left_s, rules.repair_s - passed_s)
    return left_s


def _shootout(rules: Rules, shooter: Team, events: Sequence[game_event_t]) -> Shootout:
    """Returns the deciding penalties, with the shots and goals since they began; `shooter` has the one at hand."""
    decided = [event for event in events if event.half == halves.PENALTIES and not _is_of_robot(event)]
    begins = [place for place, event in enumerate(decided) if not event.goal and event.time_in_half_s <= 0.0]
    since = decided[begins[-1] :] if begins else []
    played = Shootout(rules.penalties, Team(since[0].team) if since else shooter)
    for event in since:
        missed = event.reason == Reason.MISSED
        if event.goal:
            played.shooter = Team(event.team)
        if event.goal or missed:
            played.shot(scored=event.goal)
        if not event.goal:
            played.shooter = Team(event.team)
    played.shooter = shooter or played.shooter
    return played


def _is_of_robot(event: game_event_t) -> bool:
    return bool(event.card) or event.reason in OFF_FIELD
