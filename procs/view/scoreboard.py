"""The score in words: one line for a running match, a few lines for a match that has ended."""

from collections import Counter
from collections.abc import Callable
from typing import Any

from lcmtypes.soccer import game_event_t, game_state_t, match_history_t
from procs.model.game_states import State
from procs.model.geometry import plausible
from procs.model.teams import Ends
from procs.referee.reasons import OFF_FIELD, Reason
from procs.view.field_drawing import field_drawing
from procs.view.measures import MEASURES, field_in

Newest = Callable[[str], Any]
"""Returns the newest message of a channel, decoded, or None."""

GAME_STATE = "world/game_state"
HISTORY = "world/match_history"
TRUTH = "world/ground_truth"
CHANNELS = (GAME_STATE, HISTORY, TRUTH, MEASURES)
"""Channels whose messages the display passes to this module."""

STATES = {int(state): state.words for state in State}
"""Words for the states of `game_state_t`."""
CARDS = {game_event_t.YELLOW: "yellow", game_event_t.DOUBLE_YELLOW: "double yellow", game_event_t.RED: "red"}
TEAMS = {game_state_t.TEAM_CYAN: "cyan", game_state_t.TEAM_MAGENTA: "magenta"}


def score(state: game_state_t) -> str:
    """Returns the score: `CYAN 2 : 1 MAGENTA`."""
    return f"CYAN {state.score_cyan} : {state.score_magenta} MAGENTA"


def phase(state: game_state_t) -> str:
    """Returns the phase of the match: `play`, `throw-in magenta`, `corner kick cyan, taking positions`."""
    words = STATES.get(state.state, f"state {state.state}")
    set_piece = state.state not in (game_state_t.FROZEN, game_state_t.PLAY, game_state_t.HALF_TIME)
    if set_piece and state.state_team in TEAMS:
        words += f" {TEAMS[state.state_team]}"
    return f"{words}, taking positions" if set_piece and state.stopped else words


def play_time(time_s: float) -> str:
    """Returns minutes and seconds: `03:12`; dashes for what is no time of a match."""
    if not plausible(time_s) or time_s < 0.0:
        return "--:--"
    minutes, seconds = divmod(int(time_s), 60)
    return f"{minutes:02d}:{seconds:02d}"


def headline(newest: Newest) -> str:
    """Returns one line for the display; empty before the first message of the referee."""
    state = newest(GAME_STATE)
    if state is None:
        return ""
    return f"{score(state)}   half {state.half}  {play_time(state.time_in_half_s)}   {phase(state)}"


def drawing(newest: Newest, columns: int, rows: int) -> list[list[tuple[str, str]]]:
    """Returns the field with robots and ball for the display; nothing before the first message of the simulator."""
    truth, state = newest(TRUTH), newest(GAME_STATE)
    if truth is None:
        return []
    ends = Ends.told(state.cyan_side) if state else None
    return field_drawing(truth, columns, rows, field_in(newest), ends)


def summary(newest: Newest) -> list[str]:
    """Returns the lines for the end of a run; none without a referee."""
    state = newest(GAME_STATE)
    if state is None:
        return []
    leader = "cyan" if state.score_cyan > state.score_magenta else "magenta"
    over = state.state == game_state_t.FROZEN
    verdict = "a draw" if state.score_cyan == state.score_magenta else f"{leader} {'wins' if over else 'leads'}"
    told = _events(newest(HISTORY) or match_history_t(), state.half)
    return [score(state), f"{verdict} after {play_time(state.time_in_half_s)} of half {state.half}", *told]


def _events(history: match_history_t, half: int) -> list[str]:
    """Returns the lines about goals, whistles and cards; `half` is that of the newest state."""
    goals = [
        f"{play_time(event.time_in_half_s)}{f' of half {event.half}' if half > 1 else ''} {TEAMS[event.team]}"
        for event in _counting(history)
        if event.team in TEAMS
    ]
    others = {*OFF_FIELD, Reason.SUBGOAL}
    calls = [event for event in history.events if not event.goal and not event.card and event.reason not in others]
    whistles = Counter(STATES.get(event.state, f"state {event.state}") for event in calls)
    counted = [f"{name} {count}" for name, count in sorted(whistles.items(), key=lambda item: (-item[1], item[0]))]
    cards = [f"{CARDS[event.card]} {event.robot}" for event in history.events if event.card in CARDS]
    lists = (("goals", goals), ("whistles", counted), ("cards", cards))
    return [f"{name}: {', '.join(items)}" for name, items in lists if items]


def _counting(history: match_history_t) -> list[game_event_t]:
    """Returns the goals that count: `subgoal` has taken the newest one of its team back."""
    goals: list[game_event_t] = []
    for event in history.events:
        if event.goal:
            goals.append(event)
        elif event.reason == Reason.SUBGOAL:
            taken = next((goal for goal in reversed(goals) if goal.team == event.team), None)
            goals = [goal for goal in goals if goal is not taken]
    return goals
