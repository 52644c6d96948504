"""Skills as hierarchical state machines: a table of states, which runs and from which drawings are made."""

from collections.abc import Callable, Sequence
from difflib import get_close_matches
from typing import Any, ClassVar, NamedTuple

from procs.behaviour.skills.skill import Scene, Skill, Status, Step

Guard = Callable[[Any, Scene], bool]
Act = Callable[[Any, Scene], Step]

_MOST_EXITS = 8
"""In one tick; more would be a circle."""


class Exit(NamedTuple):
    """Way out of a state, taken as soon as its condition holds."""

    when: Guard
    """Method of the skill; its name labels the arrow."""
    to: str
    """Name of a state at the same level."""


class State(NamedTuple):
    """A state: a leaf acts, and any other state holds states."""

    name: str
    act: Act | None = None
    """Method of the skill that returns the step of a tick."""
    exits: tuple[Exit, ...] = ()
    """Looked at in every tick, in order, before the states inside."""
    inside: tuple["State", ...] = ()
    """The first one is entered, unless there is a choice."""
    choice: tuple[Exit, ...] = ()
    """The state inside is chosen anew in every tick: the first whose condition holds."""
    status: Status = Status.RUNNING
    """Status of the steps of a leaf. A failed leaf needs no act: its name is the reason."""


def otherwise(_skill: Skill, _scene: Scene) -> bool:
    """Holds always: the last condition of a choice."""
    return True


class StateMachine(Skill):
    """A skill that is a table of states."""

    STATES: ClassVar[tuple[State, ...]]
    """States of the highest level; the first one is entered."""

    def __init_subclass__(cls, **options: Any) -> None:
        """Checks the table of a skill when its class is made.

        Raises:
            ValueError: the table names a state that is not there, or a state has nothing to do.
        """
        super().__init_subclass__(**options)
        if mistake := _mistake_in(cls.__dict__.get("STATES", ())):
            raise ValueError(f"skill {cls.__module__}.{cls.__qualname__}: {mistake}")

    def __init__(self) -> None:
        self._path = _descent(self.STATES[0])

    @property
    def state(self) -> str:
        """Names of the active states, the outermost first."""
        return "/".join(state.name for state in self._path)

    def step(self, scene: Scene) -> Step:
        """Takes the exits that are open, chooses states, then acts."""
        scene = self._watch(scene)
        self._enter(self.STATES, 0, scene)
        leaf = self._path[-1]
        if leaf.act is None:
            return Step(status=leaf.status, reason=leaf.name)
        return leaf.act(self, scene)._replace(status=leaf.status)

    def _watch(self, scene: Scene) -> Scene:
        """Takes what the conditions and acts of this tick need, once a tick; returns the scene that they see."""
        return scene

    def _enter(self, states: Sequence[State], depth: int, scene: Scene) -> None:
        """Takes the exits of the active state at a depth until none is open, then goes on inside that state."""
        for _ in range(_MOST_EXITS):
            way = next((way for way in self._path[depth].exits if way.when(self, scene)), None)
            if way is None:
                break
            self._path[depth:] = _descent(_named(states, way.to))
        state = self._path[depth]
        if state.choice:
            chosen = next(way.to for way in state.choice if way.when(self, scene))
            if chosen != self._path[depth + 1].name:
                self._path[depth + 1 :] = _descent(_named(state.inside, chosen))
        if state.inside:
            self._enter(state.inside, depth + 1, scene)


def _named(states: Sequence[State], name: str) -> State:
    return next(state for state in states if state.name == name)


def _descent(state: State) -> list[State]:
    """Returns the state and the states inside that are entered with it."""
    path = [state]
    while path[-1].inside:
        path.append(path[-1].inside[0])
    return path


def _mistake_in(states: Sequence[State], parent: State | None = None) -> str:
    """Returns the first mistake in a level of a table or in the levels inside; empty without one."""
    names = [state.name for state in states]
    place = f"in state '{parent.name}'" if parent else "at the highest level"
    if parent and parent.choice and parent.choice[-1].when is not otherwise:
        return f"the last condition of the choice of state '{parent.name}' should be 'otherwise', which holds always"
    ways = [(f"choice of state '{parent.name}'", way.to) for way in parent.choice] if parent else []
    ways += [(f"exit of state '{state.name}'", way.to) for state in states for way in state.exits]
    for origin, name in ways:
        if name not in names:
            return f"the {origin} leads to '{name}'; the states {place} are {', '.join(_nearest(name, names))}"
    for state in states:
        if names.count(state.name) > 1:
            return f"{names.count(state.name)} states {place} have the name '{state.name}'; each should have its own"
        if mistake := _mistake_of(state) or _mistake_in(state.inside, state):
            return mistake
    return ""


def _mistake_of(state: State) -> str:
    if state.inside and state.act:
        return f"state '{state.name}' has an act and states inside; it should have one of both"
    if not (state.inside or state.act or state.status is Status.FAILED):
        return f"state '{state.name}' has no act and no states inside; only a failed state needs neither"
    if state.choice and not state.inside:
        return f"state '{state.name}' has a choice, but no states inside to choose from"
    return ""


def _nearest(name: str, names: Sequence[str]) -> list[str]:
    return [f"'{each}'" for each in get_close_matches(name, names, len(names), cutoff=0.0)]
