"""The referee's memory of the match as text, so that a referee that was restarted goes on as the one before it.

The text is JSON: numbers and texts stand for themselves; everything else is an object whose one key names its class.
The same memory gives the same text in every process.
"""

import json
from collections import Counter
from collections.abc import Callable, Mapping
from typing import Any

from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Ends, Team
from procs.referee.advantage import Advantage
from procs.referee.ball_placing import BallPlacing
from procs.referee.cards import Cards
from procs.referee.fouls.areas import Areas
from procs.referee.fouls.book import RuleBook
from procs.referee.fouls.foul import Foul
from procs.referee.fouls.holding import Holding
from procs.referee.fouls.pushing import Pushing
from procs.referee.match import Match
from procs.referee.reasons import Reason
from procs.referee.shootout import Shootout
from procs.referee.stretch import Stretch
from procs.referee.touches import Carrier, Touches

_SPOT = Point(0.0, 0.0)
_SAMPLES = (
    *(Advantage(), Areas(), BallPlacing(_SPOT), Cards(), Carrier(), Holding(), Pushing(), RuleBook(), Shootout(1)),
    *(Stretch(State.PLAY, Team.NONE, _SPOT), Touches(_SPOT)),
)
"""One object of each class whose attributes are remembered."""
_NOT_KEPT = frozenset({"rules", "calls"})
"""Attributes of a match: the settings of the restarted referee, and the decisions of a tick, which were told."""


def written(match: Match) -> str:
    """Returns what the referee of a match remembers."""
    return json.dumps({name: _write(value) for name, value in vars(match).items() if name not in _NOT_KEPT})


def recall(match: Match, text: str) -> None:
    """Puts a match into the state that a text of `written` describes.

    Raises:
        ValueError: the text describes none, or one of another version of this program; the match stays as it is.
    """
    try:
        kept = {name: _read(value) for name, value in json.loads(text).items()}
    except (KeyError, TypeError, AttributeError, RecursionError) as error:
        raise ValueError(f"cannot be read: {error!r}") from error
    _compare("Match", kept, {name: value for name, value in vars(match).items() if name not in _NOT_KEPT})
    vars(match).update(kept)


def _compare(kind: str, kept: Mapping[str, Any], known: Mapping[str, Any]) -> None:
    if kept.keys() != known.keys():
        differing = ", ".join(sorted(kept.keys() ^ known.keys()))
        raise ValueError(f"cannot be used: {kind} has or lacks {differing}, as in another version")


def _write(value: Any) -> Any:
    return _WRITERS[type(value)](value)


def _write_attributes(value: Any) -> Any:
    return {type(value).__name__: {name: _write(each) for name, each in vars(value).items()}}


def _write_tuple(value: Any) -> Any:
    return {type(value).__name__: [_write(each) for each in value]}


def _read(value: Any) -> Any:
    if not isinstance(value, dict):
        return value
    ((kind, inner),) = value.items()
    return _READERS[kind](inner)


def _reader_of_attributes(known: Any) -> Callable[[Any], Any]:
    made: Any = type(known)

    def read(inner: Any) -> Any:
        kept = {name: _read(each) for name, each in inner.items()}
        _compare(made.__name__, kept, vars(known))
        value = object.__new__(made)
        vars(value).update(kept)
        return value

    return read


def _reader_of_tuple(made: Any) -> Callable[[Any], Any]:
    return lambda inner: made(*map(_read, inner))


def _reader_of_mapping(made: Any) -> Callable[[Any], Any]:
    return lambda inner: made(dict(map(_read, inner)))


_TUPLES = (Ends, Foul, Point)
_MAPPINGS = (dict, Counter)
_SETS = (set, frozenset)
_WRITERS: dict[type, Callable[[Any], Any]] = {
    **dict.fromkeys((bool, int, float, str, type(None)), lambda value: value),
    **dict.fromkeys((State, Team), lambda value: {type(value).__name__: int(value)}),
    Reason: lambda value: {"Reason": str(value)},
    **dict.fromkeys(_TUPLES, _write_tuple),
    **dict.fromkeys(_MAPPINGS, lambda value: {type(value).__name__: [_write(pair) for pair in value.items()]}),
    **dict.fromkeys(_SETS, lambda value: {type(value).__name__: sorted(value)}),
    tuple: _write_tuple,
    **{type(each): _write_attributes for each in _SAMPLES},
}
_READERS: dict[str, Callable[[Any], Any]] = {
    **{each.__name__: each for each in (State, Team, Reason)},
    **{each.__name__: _reader_of_tuple(each) for each in _TUPLES},
    **{each.__name__: _reader_of_mapping(each) for each in _MAPPINGS},
    **{each.__name__: each for each in _SETS},
    "tuple": lambda inner: tuple(map(_read, inner)),
    **{type(each).__name__: _reader_of_attributes(each) for each in _SAMPLES},
}
