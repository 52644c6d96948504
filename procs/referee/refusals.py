"""Commands by hand that make no sense at the state of the match: after its end, in a break, between deciding penalties.

Cards, repairs and the score can be put right at any time, and a half can begin at any time.
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
    drawn = match.score[Team.CYAN] == match.score[Team.MAGENTA]
    goes_on = match.state is State.HALF_TIME or (match.over and drawn and match.half in (halves.SECOND, halves.FOURTH))
    following = match.half + 1
    return following if goes_on and name == ("penalty" if following == halves.PENALTIES else "kickoff") else None


def why_not(match: Match, name: str, team: Team) -> str:
    """Returns why a command makes no sense now, and what would; an empty text if it does."""
    if name == "start" and (not match.stopped or match.at_rest):
        return "nothing to start: the game runs, or has a break"
    if begun_by(match, name):
        return ""
    if name in SET_PIECES or name in ("drop_ball", "half_time"):
        if match.over:
            return f"no {_words(name)} after the end of the match; reset begins another match"
        if match.state is State.HALF_TIME:
            return f"no {_words(name)} in a break; {_NEXT[match.half]}"
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
        return f"{team.name.lower()} cannot score: the penalty is that of {whose}"
    return ""


def _words(name: str) -> str:
    return (SET_PIECES | {"drop_ball": State.DROP_BALL, "half_time": State.HALF_TIME})[name].words
