"""Commands of a RefBox that lead from one state of the game to the next."""

from collections import Counter
from collections.abc import Mapping, Sequence

from lcmtypes.soccer import game_event_t, game_state_t
from procs.model.robot import PLAYERS, Player, number_of_player, team_of_player
from procs.refbox.protocol import Command
from procs.referee import halves
from procs.referee.reasons import OFF_FIELD, Reason

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
_GOALS_MAX = 99  # a RefBox counts no further
_HALVES = {1: "FIRST_HALF", 2: "SECOND_HALF", 3: "FIRST_HALF_OVERTIME", 4: "SECOND_HALF_OVERTIME"}
_OVERTIME_IS_DRAWN = [Command("SECOND_HALF_OVERTIME"), Command("STOP"), Command("END_GAME")]
_GAMEOVER = Command("GAMEOVER")
_BREAKS = (game_state_t.HALF_TIME, game_state_t.FROZEN)
_CARDS = {game_event_t.YELLOW: "YELLOW_CARD", game_event_t.DOUBLE_YELLOW: "DOUBLE_YELLOW", game_event_t.RED: "RED_CARD"}
_AWAY = (game_event_t.DOUBLE_YELLOW, game_event_t.RED)


def news(
    before: game_state_t | None,
    now: game_state_t,
    events: Sequence[game_event_t] = (),
    players: Mapping[str, Player] = PLAYERS,
) -> list[Command]:
    """Returns the commands between two states, in their order; without a state before, those that lead to this one.

    `events` is the history of the match; `players` states team and number of each robot by its namespace. A robot that
    is off the field for no decision in it is under repair.
    """
    if before is None:
        in_penalties = now.half == halves.PENALTIES
        score = _until_penalty(now, events) if in_penalties else _half(now.half) + _scores(game_state_t(), now)
        commands = score + _robots(game_state_t(), now, _in_force(events[: now.decisions], now), players)
        return commands + _break(now) + _stopped(now) + ([] if now.stopped else [Command("START")])
    if _is_new_match(before, now, events) or (_is_over(before) and not _is_over(now)):
        return [Command("RESET"), *news(None, now, events, players)]
    commands = _scores(before, now) + _robots(before, now, events, players)
    if now.state != before.state and now.state in _BREAKS:
        return commands + _break(now)
    if _is_over(now) and not _is_over(before):
        return [*commands, _GAMEOVER]
    start = [] if now.stopped else [Command("START")]
    stop = [Command("STOP")] if now.stopped and not before.stopped else []
    begins = now.half != before.half or _begins_again(before, now)
    if begins and now.half == halves.PENALTIES:
        drawn = before.half == halves.FOURTH and before.state in _BREAKS
        return commands + stop + ([] if drawn else _OVERTIME_IS_DRAWN) + _stopped(now) + start
    commands += stop + (_half(now.half) if begins else [])
    whistled = begins or _piece(now) != _piece(before) or _commanded(events[before.decisions : now.decisions])
    if stop or (before.stopped and whistled):
        commands += _stopped(now)
    return commands + (start if before.stopped else [])


def _piece(state: game_state_t) -> tuple[int, int, float, float]:
    return state.state, state.state_team, state.ball_x_m, state.ball_y_m


def _commanded(newer: Sequence[game_event_t]) -> bool:
    """Returns whether a person has commanded a set piece, which may be the one at hand."""
    return any(event.reason == Reason.BY_HAND for event in newer)


def _robots(
    before: game_state_t,
    now: game_state_t,
    events: Sequence[game_event_t],
    players: Mapping[str, Player],
) -> list[Command]:
    """Returns the cards, and the robots that left the field, between two states."""
    newer = events[before.decisions : now.decisions]
    causes = {robot: _cause(robot, newer) for robot in now.sent_off}
    off = [
        Command(event.reason.upper(), team_of_player(event.robot, players), number_of_player(event.robot, players))
        if event.robot
        else Command("PARK")
        for event in newer
        if event.reason in OFF_FIELD and any(event is cause for cause in causes.values())
    ]
    repairs = [
        Command("REPAIR", team_of_player(robot, players), number_of_player(robot, players))
        for robot, cause in causes.items()
        if cause is None and robot not in before.sent_off
    ]
    return _cards(newer, players) + off + repairs


def _in_force(events: Sequence[game_event_t], now: game_state_t) -> list[game_event_t]:
    """Leaves out a double yellow card whose robot is back, and its earlier ones: it would be sent off once more."""
    served = {
        event.robot: place
        for place, event in enumerate(events)
        if event.card == game_event_t.DOUBLE_YELLOW and event.robot not in now.sent_off
    }
    return [event for place, event in enumerate(events) if not event.card or place > served.get(event.robot, -1)]


def _cause(robot: str, events: Sequence[game_event_t]) -> game_event_t | None:
    """Returns the newest decision that took a robot off the field: a card, which lasts longer, or else another one."""
    cards = [event for event in events if event.robot == robot and event.card in _AWAY]
    others = [event for event in events if event.reason in OFF_FIELD and event.robot in (robot, "")]
    return next(reversed(cards or others), None)


def _is_new_match(before: game_state_t, now: game_state_t, events: Sequence[game_event_t]) -> bool:
    """Returns whether the match has begun anew: its history has, or time has gone back without a newer whistle."""
    newer = events[before.decisions : now.decisions]
    if now.decisions < before.decisions or any(event.reason == Reason.RESET for event in newer):
        return True
    went_back = now.half == 1 and (before.half > 1 or now.time_in_half_s < before.time_in_half_s)
    no_whistles = {*OFF_FIELD, Reason.SUBGOAL}
    return went_back and all(event.goal or event.card or event.reason in no_whistles for event in newer)


def _begins_again(before: game_state_t, now: game_state_t) -> bool:
    """Returns whether the same half is played anew, or goes on after a break."""
    after_break = before.state in _BREAKS and now.state not in _BREAKS
    return after_break or now.time_in_half_s < before.time_in_half_s


def _break(now: game_state_t) -> list[Command]:
    """Returns what begins a break; overtime or penalties may follow END_GAME, but only RESET follows GAMEOVER."""
    if now.state not in _BREAKS:
        return []
    if now.state == game_state_t.HALF_TIME and now.half in (1, 3):
        return [Command("STOP"), Command("HALF_TIME")]
    return [Command("STOP"), Command("END_GAME")] + [_GAMEOVER] * _is_over(now)


def _is_over(now: game_state_t) -> bool:
    """Returns whether the match has ended, and no overtime or penalties may follow."""
    drawn = now.half in (2, 4) and now.score_cyan == now.score_magenta
    return now.state == game_state_t.FROZEN and not drawn


def _half(half: int) -> list[Command]:
    return [Command(_HALVES[half])] if half in _HALVES else []


def _stopped(now: game_state_t) -> list[Command]:
    return [Command(_SET_PIECES[now.state], TEAMS.get(now.state_team, ""))] if now.state in _SET_PIECES else []


def _scores(before: game_state_t, now: game_state_t) -> list[Command]:
    commands = []
    for team in TEAMS.values():
        more = getattr(now, f"score_{team}") - getattr(before, f"score_{team}")
        commands += [Command("GOAL" if more > 0 else "SUBGOAL", team)] * min(abs(more), _GOALS_MAX)
    return commands


def _until_penalty(now: game_state_t, events: Sequence[game_event_t]) -> list[Command]:
    """Returns what leads to the deciding penalty at hand, or to the end of all: a drawn overtime, and those scored."""
    penalties = [event for event in events[: now.decisions] if event.half == halves.PENALTIES]
    scored = Counter(event.team for event in penalties if event.goal)
    scored.subtract(event.team for event in penalties if event.reason == Reason.SUBGOAL)
    drawn = game_state_t()
    before = [getattr(now, f"score_{name}") - scored[team] for team, name in TEAMS.items()]
    drawn.score_cyan = drawn.score_magenta = max(0, min(before))
    half, *end = _OVERTIME_IS_DRAWN
    commands = [half, *_scores(game_state_t(), drawn), *end]
    for goal in _scores(drawn, now):
        commands += [Command("PENALTY", goal.team), goal]
    return commands


def _cards(events: Sequence[game_event_t], players: Mapping[str, Player]) -> list[Command]:
    return [
        Command(_CARDS[event.card], TEAMS.get(event.team, ""), number_of_player(event.robot, players))
        for event in events
        if event.card in _CARDS
    ]
