"""Commands of a RefBox that lead from one state of the game to the next."""

from collections.abc import Callable, Sequence

from lcmtypes.soccer import game_event_t, game_state_t
from procs.model.robot import number_of, team_of
from procs.refbox.protocol import Command

TEAMS = {game_state_t.TEAM_CYAN: "cyan", game_state_t.TEAM_MAGENTA: "magenta"}
_SET_PIECES = {
    game_state_t.KICK_OFF: "KICKOFF",
    game_state_t.DROP_BALL: "DROP_BALL",
    game_state_t.PENALTY: "PENALTY",
    game_state_t.CORNER_KICK: "CORNER",
    game_state_t.THROW_IN: "THROWIN",
    game_state_t.FREE_KICK: "FREEKICK",
    game_state_t.GOAL_KICK: "GOALKICK",
}
_GOALS_MAX = 99
"""A RefBox counts no further."""
_HALVES = {1: "FIRST_HALF", 2: "SECOND_HALF", 3: "FIRST_HALF_OVERTIME", 4: "SECOND_HALF_OVERTIME"}
_BREAKS = {game_state_t.HALF_TIME: "HALF_TIME", game_state_t.FROZEN: "END_GAME"}
_CARDS = {game_event_t.YELLOW: "YELLOW_CARD", game_event_t.DOUBLE_YELLOW: "DOUBLE_YELLOW", game_event_t.RED: "RED_CARD"}


def news(
    before: game_state_t | None,
    now: game_state_t,
    events: Sequence[game_event_t] = (),
    number: Callable[[str], int] = number_of,
    team: Callable[[str], str] = team_of,
) -> list[Command]:
    """Returns the commands between two states, in their order; without a state before, those that lead to this one.

    `events` is the history of the match; `number` and `team` give those of the robot with a namespace. A robot that
    leaves the field without a card is under repair: the states do not tell repair, substitution and parking apart.
    """
    if before is None:
        commands = _half(now) + _robots(game_state_t(), now, events, number, team)
        return commands + _break(now) + _stopped(now) + ([] if now.stopped else [Command("START")])
    if now.decisions < before.decisions:
        return [Command("RESET"), *news(None, now, events, number, team)]
    commands = _robots(before, now, events, number, team)
    if now.state != before.state and now.state in _BREAKS:
        return commands + _break(now)
    if now.half != before.half:
        commands += _half(now)
    if now.stopped and _piece(now) != _piece(before):
        commands += [Command("STOP"), *_stopped(now)] if not before.stopped else _stopped(now)
    if before.stopped and not now.stopped:
        commands.append(Command("START"))
    return commands


def _piece(state: game_state_t) -> tuple[bool, int, int, float, float]:
    return state.stopped, state.state, state.state_team, state.ball_x_m, state.ball_y_m


def _robots(
    before: game_state_t,
    now: game_state_t,
    events: Sequence[game_event_t],
    number: Callable[[str], int],
    team: Callable[[str], str],
) -> list[Command]:
    """Returns the goals, the cards and the repairs between two states."""
    newer = events[before.decisions : now.decisions]
    known = {*before.sent_off, *(event.robot for event in newer if event.card in _CARDS)}
    repairs = [Command("REPAIR", team(robot), number(robot)) for robot in now.sent_off if robot not in known]
    return _scores(before, now) + _cards(newer, number) + repairs


def _break(now: game_state_t) -> list[Command]:
    return [Command("STOP"), Command(_BREAKS[now.state])] if now.state in _BREAKS else []


def _half(now: game_state_t) -> list[Command]:
    return [Command(_HALVES[now.half])] if now.half in _HALVES else []


def _stopped(now: game_state_t) -> list[Command]:
    return [Command(_SET_PIECES[now.state], TEAMS.get(now.state_team, ""))] if now.state in _SET_PIECES else []


def _scores(before: game_state_t, now: game_state_t) -> list[Command]:
    commands = []
    for team in TEAMS.values():
        more = getattr(now, f"score_{team}") - getattr(before, f"score_{team}")
        commands += [Command("GOAL" if more > 0 else "SUBGOAL", team)] * min(abs(more), _GOALS_MAX)
    return commands


def _cards(events: Sequence[game_event_t], number: Callable[[str], int]) -> list[Command]:
    return [
        Command(_CARDS[event.card], TEAMS.get(event.team, ""), number(event.robot))
        for event in events
        if event.card in _CARDS
    ]
