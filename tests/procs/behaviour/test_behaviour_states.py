"""State machines of the skills: how they run, that their tables are sound, and that their drawings say the same."""

import itertools
import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

from procs.behaviour.skills import drawings
from procs.behaviour.skills.book import SKILLS
from procs.behaviour.skills.getting import GetBall
from procs.behaviour.skills.playing import Shoot
from procs.behaviour.skills.skill import Scene, Status, Step
from procs.behaviour.skills.states import Exit, State, StateMachine, otherwise
from procs.behaviour.view import Ball
from procs.model.field import Point
from tests.procs.behaviour.behaviour_parts import ball, robot, view

PAGE = Path(__file__).parents[3] / "docs/soccer.md"
OWN = robot("cyan2", 0.0, 0.0)
SCENE = Scene(view(OWN, ball(5.0, 0.0)), Point(8.0, 0.0), 0.0)


def scene(where: Ball, **more: bool | None) -> Scene:
    return SCENE._replace(view=view(OWN, where), **more)  # type: ignore[arg-type]


class Lift(StateMachine):
    """Two floors; inside each the door is chosen by the speed, and the power fails for all."""

    def _power_cut(self, scene: Scene) -> bool:
        return not scene.charged

    def _called(self, scene: Scene) -> bool:
        return scene.place.y_m > 0

    def _slow(self, scene: Scene) -> bool:
        return scene.speed_m_s < 1

    def _move(self, _scene: Scene) -> Step:
        return Step(dribble=True)

    _DOORS = (State("open", _move), State("shut", _move))
    _CHOICE = (Exit(_slow, "open"), Exit(otherwise, "shut"))
    STATES = (
        State("ground", exits=(Exit(_power_cut, "no power"), Exit(_called, "top")), inside=_DOORS, choice=_CHOICE),
        State("top", exits=(Exit(_power_cut, "no power"),), inside=_DOORS, choice=_CHOICE),
        State("no power", status=Status.FAILED),
    )


def test_states_inside_are_chosen_anew_and_left_together() -> None:
    lift, states = Lift(), []
    for y_m, speed_m_s in ((0.0, 0.0), (0.0, 2.0), (1.0, 2.0), (0.0, 0.0)):
        assert lift.step(SCENE._replace(place=Point(0.0, y_m), speed_m_s=speed_m_s)) == Step(dribble=True)
        states.append(lift.state)
    assert states == ["ground/open", "ground/shut", "top/shut", "top/open"]
    assert lift.step(SCENE._replace(charged=False)) == Step(status=Status.FAILED, reason="no power")
    assert lift.state == "no power"


def acts(_skill: StateMachine, _scene: Scene) -> Step:
    return Step()


def slow(_skill: StateMachine, scene: Scene) -> bool:
    return scene.speed_m_s < 1


def leaf(name: str, *exits: str) -> State:
    return State(name, acts, tuple(Exit(slow, to) for to in exits))


@pytest.mark.parametrize(
    ("states", "mistake"),
    [
        (
            (leaf("turn", "dizzi"), leaf("dizzy")),
            "the exit of state 'turn' leads to 'dizzi'; the states at the highest level are 'dizzy', 'turn'",
        ),
        (
            (State("lift", inside=(leaf("open", "end"),)), leaf("end")),
            "the exit of state 'open' leads to 'end'; the states in state 'lift' are 'open'",
        ),
        (
            (State("lift", inside=(leaf("open"),), choice=(Exit(slow, "shut"), Exit(otherwise, "open"))),),
            "the choice of state 'lift' leads to 'shut'; the states in state 'lift' are 'open'",
        ),
        (
            (State("lift", inside=(leaf("open"),), choice=(Exit(slow, "open"),)),),
            "the last condition of the choice of state 'lift' should be 'otherwise', which holds always",
        ),
        ((leaf("open"), leaf("open")), "2 states at the highest level have the name 'open'; each should have its own"),
        ((State("end", status=Status.FINAL),), "state 'end' has no act and no states inside; only a failed state"),
        ((State("lift", acts, inside=(leaf("open"),)),), "state 'lift' has an act and states inside; it should have"),
        ((State("open", acts, choice=(Exit(otherwise, "shut"),)),), "state 'open' has a choice, but no states inside"),
    ],
)
def test_table_with_a_mistake_is_refused(states: tuple[State, ...], mistake: str) -> None:
    with pytest.raises(ValueError, match=re.escape(f"skill {__name__}.Spin: {mistake}")):
        type("Spin", (StateMachine,), {"STATES": states, "__module__": __name__, "__qualname__": "Spin"})


def levels(states: Sequence[State]) -> Iterator[tuple[Sequence[State], State | None]]:
    yield states, None
    for state in states:
        if state.inside:
            yield state.inside, state
            yield from list(levels(state.inside))[1:]


@pytest.mark.parametrize("skill", SKILLS.values(), ids=list(SKILLS))
def test_table_of_a_skill_is_sound(skill: type[StateMachine]) -> None:
    for states, parent in levels(skill.STATES):
        names = [state.name for state in states]
        assert len(set(names)) == len(names)
        choice = parent.choice if parent else ()
        assert not choice or choice[-1].when is otherwise, "a choice always has a result"
        ways = [*choice, *(way for state in states for way in state.exits)]
        assert {way.to for way in ways} <= set(names), "an exit leads to a state beside"
        assert {way.to for way in ways} | {names[0]} == set(names), "every state can be reached"
        assert all("lambda" not in way.when.__name__ for way in ways), "conditions have names"
        for state in states:
            assert bool(state.inside) != bool(state.act or state.status is Status.FAILED)


def arrows(skill: type[StateMachine]) -> set[tuple[str, str]]:
    """Returns the arrows between states in the drawing of a skill, choices as from any state beside the chosen one."""
    found = set()
    for line in drawings.drawing(skill).splitlines():
        if " --> " in line:
            start, _, end = line.partition(":")[0].strip().partition(" --> ")
            found.add((start, end))
    return found


@pytest.mark.parametrize(
    ("skill", "scenes", "states"),
    [
        (
            GetBall,
            [
                scene(ball(4.0, 0.0)),
                scene(ball(0.33, 0.0), holds_ball=True),
                scene(ball(0.4, 0.0)),
                scene(ball(0.33, 0.0), holds_ball=True),
                scene(ball(0.33, 0.0), holds_ball=True),
            ],
            ["approach/drive to it", "settle", "approach/drive to it", "settle", "caught"],
        ),
        (
            GetBall,
            [scene(ball(3.0, 0.0, -2.0, 0.0)), scene(Ball(known=False))],
            ["approach/meet it/wait", "the ball is unknown"],
        ),
        (
            Shoot,
            [
                scene(ball(0.33, 0.0), holds_ball=True, charged=False),
                scene(ball(0.33, 0.0), holds_ball=True),
                scene(ball(0.33, 0.0), holds_ball=True, kicked=None),
                scene(ball(0.33, 0.0), holds_ball=True, kicked=False),
                scene(ball(1.0, 0.0), kicked=True),
            ],
            ["turn", "kick", "wait for the kicker", "kick", "kicked"],
        ),
    ],
    ids=["caught", "unknown", "kicked"],
)
def test_skill_moves_along_the_arrows_of_its_drawing(
    skill: type[StateMachine], scenes: list[Scene], states: list[str]
) -> None:
    machine, drawn, passed = skill(), arrows(skill), []
    for each in scenes:
        machine.step(each)
        passed.append(machine.state)
    assert passed == states
    for before, after in itertools.pairwise(passed):
        one, other = before.partition("/")[0].replace(" ", "_"), after.partition("/")[0].replace(" ", "_")
        assert one == other or reachable(one, other, drawn), f"no way from {one} to {other} is drawn"
    for path in passed:
        parts = path.replace(" ", "_").split("/")
        for depth in range(1, len(parts)):
            assert ("__".join([*parts[:depth], "choice"]), "__".join(parts[: depth + 1])) in drawn


def reachable(start: str, end: str, drawn: set[tuple[str, str]]) -> bool:
    """Returns whether one arrow leads from start to end, or two that are taken in the same tick."""
    return (start, end) in drawn or any((start, via) in drawn and (via, end) in drawn for via, _ in drawn)


def test_page_shows_the_skills_as_they_are(tmp_path: Path) -> None:
    copy = tmp_path / "soccer.md"
    copy.write_text(PAGE.read_text())
    assert not drawings.redraw(copy), "type: python -m procs.behaviour.skills.drawings docs/soccer.md"
    copy.write_text(copy.read_text().replace("settle --> caught: sure", "settle --> caught: perhaps"))
    assert drawings.redraw(copy)
    assert copy.read_text() == PAGE.read_text()


def test_page_without_marks_is_refused(tmp_path: Path) -> None:
    bare = tmp_path / "bare.md"
    bare.write_text("# Soccer\n")
    with pytest.raises(ValueError, match="has no line"):
        drawings.redraw(bare)


def test_page_that_is_not_text_is_refused(tmp_path: Path) -> None:
    picture = tmp_path / "field.png"
    picture.write_bytes(b"\x89PNG")
    with pytest.raises(ValueError, match=r"field\.png is not a page: .*; it should be UTF-8 text"):
        drawings.redraw(picture)


def test_page_that_does_not_exist_is_named(tmp_path: Path) -> None:
    words = [sys.executable, "-m", "procs.behaviour.skills.drawings", str(tmp_path / "nope.md")]
    ended = subprocess.run(words, capture_output=True, text=True, check=False, timeout=60)
    mistake = "nope.md: No such file or directory; name a page of text, such as docs/soccer.md\n"
    assert (ended.returncode, ended.stderr) == (2, f"{tmp_path}/{mistake}")


def test_drawing_names_states_as_mermaid_can_read_them() -> None:
    class Turn(StateMachine):
        """Turns half."""

        STATES = (State("half-turn (left)", inside=(leaf("go"),), exits=(Exit(slow, "stop"),)), leaf("stop"))

    lines = drawings.drawing(Turn).splitlines()
    assert lines[1] == '    state "half-turn (left)" as half_turn__left_ {'
    assert "    half_turn__left_ --> stop: slow" in lines
