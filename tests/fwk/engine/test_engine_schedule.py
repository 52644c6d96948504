"""The schedule of a tick: which component holds the main loop, and which stages run."""

import pytest

from fwk import Component
from fwk.engine.schedule import Schedule
from fwk.model.plan import NOBODY
from fwk.model.requests import main_loop_request
from fwk.testing.plans import plan_of

THINK, ACT, IDLE = range(3)
A, B, CONTINUOUS = range(3)
USUAL = [(THINK, THINK), (ACT, ACT)]


class Thinker(Component):
    stage = "think"


class Actor(Component):
    stage = ("think", "act")


class Drifter(Component):
    rate_hz = 10.0


@pytest.fixture
def schedule() -> Schedule:
    components = {"r/a": Thinker, "r/b": Actor, "r/c": Drifter}
    return Schedule(plan_of(components, stages=("think", "act", "idle")))


def ask(schedule: Schedule, tick: int, step: int, component: int, *stages: int) -> None:
    schedule.ask(tick, step, main_loop_request(component, stages))


def test_usual_schedule_has_the_stages_with_components(schedule: Schedule) -> None:
    assert schedule.steps == USUAL
    assert (schedule.holder, schedule.holder_name, schedule.stage_names) == (NOBODY, "", ["think", "act"])


def test_the_first_gets_it_and_the_second_learns_the_holder(schedule: Schedule) -> None:
    ask(schedule, 3, 5, B, ACT, ACT)
    ask(schedule, 3, 5, A, THINK, IDLE)
    assert schedule.decide()
    assert (schedule.holder_name, schedule.stage_names) == ("r/a", ["think", "idle"])
    assert schedule.steps == [(0, THINK), (1, IDLE)]
    assert schedule.refused == ["r/b wants the main loop, but r/a has it; refused until that gives it back"]


def test_the_earlier_step_wins_in_any_order_of_answers(schedule: Schedule) -> None:
    ask(schedule, 3, 5, A, THINK)
    ask(schedule, 3, 1, B, ACT)
    schedule.decide()
    assert schedule.holder == B


def test_main_loop_holder_changes_order_and_hands_over(schedule: Schedule) -> None:
    ask(schedule, 1, 5, A, THINK)
    schedule.decide()
    ask(schedule, 2, 0, A, THINK, ACT)
    assert schedule.decide()
    assert schedule.stage_names == ["think", "act"]
    ask(schedule, 3, 0, B)  # b does not hold it
    assert not schedule.decide()
    ask(schedule, 4, 0, A)
    ask(schedule, 4, 1, B, ACT)
    assert schedule.decide()
    assert (schedule.holder, schedule.steps, schedule.refused) == (B, [(0, ACT)], [])
    ask(schedule, 5, 0, B)
    assert schedule.decide()
    assert (schedule.holder, schedule.steps) == (NOBODY, USUAL)


def test_an_order_without_the_holders_stage_is_refused(schedule: Schedule) -> None:
    ask(schedule, 1, 5, A, ACT)
    assert not schedule.decide()
    assert schedule.refused == [
        "r/a wants the main loop for act; refused: without a stage of its own (think) it could never give it back"
    ]


def test_continuous_component_needs_no_stage_of_its_own(schedule: Schedule) -> None:
    ask(schedule, 1, 5, CONTINUOUS, ACT, THINK)
    assert schedule.decide()
    assert schedule.steps == [(0, ACT), (1, THINK)]


def test_the_end_of_the_holders_process_gives_it_back(schedule: Schedule) -> None:
    ask(schedule, 1, 5, A, THINK)
    schedule.decide()
    ask(schedule, 2, 0, A, THINK, THINK)
    schedule.left([A])
    ask(schedule, 2, 0, B, ACT)
    assert schedule.asked
    schedule.decide()
    assert (schedule.holder, schedule.asked) == (B, False)
    schedule.left([A])
    assert not schedule.decide()
