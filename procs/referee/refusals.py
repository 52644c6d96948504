"""Commands by hand that make no sense at the state of the match: after its end, in a break, between deciding penalties.

Cards, repairs and the score can be put right at any time, and a half can begin at any time; penalties decide a draw.
"""

from procs.model.game_states import State
from procs.model.teams import Team
from procs.referee import halves
from procs.referee.match import Match

SET_PIECES = {
    "kickoff": State.KICK_OFF,
    "freekick": State.FREE_KICK,
    "goalkick": State.GOAL_KICK,
    "throwin": State.THROW_IN,
    "corner": State.CORNER_KICK,
    "penalty": State.PENALTY,
}
_NEXT = {
    halves.FIRST: "second_half begins the next half",
    halves.SECOND: "first_half_overtime begins the overtime",
    halves.THIRD: "second_half_overtime begins the next half",
    halves.FOURTH: "penalties begins the deciding penalties",
}


def begun_by(match: Match, name: str) -> int | None:
    """Returns the half whose first set piece has this name, in the break before it; None for other commands.

    A drawn match that has ended goes on in the same way.
    """
    following = match.half + 1
    begins = name == ("penalty" if following == halves.PENALTIES else "kickoff")
    return following if begins and _goes_on(match) else None


def why_not(match: Match, name: str, team: Team) -> str:
    """Returns why a command makes no sense now, and what would; an empty text if it does."""
    if name == "start" and not match.stopped:
        return "nothing to start: the game runs; stop or a set piece interrupts it"
    if begun_by(match, name):
        return ""
    if name == "penalties" and not match.drawn:
        return f"no penalties: they decide a draw, and the score is {match.standing}; goal or subgoal corrects it"
    if match.at_rest and (name in SET_PIECES or name in ("start", "drop_ball", "half_time")):
        return f"no {_words(name)} {_why_not_at_rest(match)}"
    if name == "half_time" and not halves.after(match.half, match.score, match.rules):
        return "no half time: no other half follows; end_game ends the match"
    if match.shootout and not match.over:
        return _why_not_between_penalties(match, name, team)
    return ""


def _why_not_between_penalties(match: Match, name: str, team: Team) -> str:
    assert match.shootout
    shooter = match.shootout.shooter
    whose = shooter.name.lower()
    if name == "drop_ball" or (name in SET_PIECES and name != "penalty"):
        return f"no {_words(name)} while penalties decide the match; penalty team={whose} repeats the one at hand"
    if name == "goal" and team is shooter.other:
        other = team.name.lower()
        return f"{other} cannot score: the penalty is that of {whose}; penalty team={other} gives {other} one"
    return ""


def _goes_on(match: Match) -> bool:
    """Returns whether another half may follow the break or the end of the match that is at hand."""
    if match.half in (halves.SECOND, halves.FOURTH):
        return match.at_rest and match.drawn
    return match.state is State.HALF_TIME


def _why_not_at_rest(match: Match) -> str:
    goes_on = _goes_on(match)
    if match.over:
        others = f"{_NEXT[match.half]}, reset another match" if goes_on else "reset begins another match"
        return f"after the end of the match; {others}"
    return f"in a break; {_NEXT[match.half] if goes_on else 'end_game ends the match, which is decided'}"


def _words(name: str) -> str:
    states = SET_PIECES | {"drop_ball": State.DROP_BALL, "half_time": State.HALF_TIME}
    return states[name].words if name in states else name
