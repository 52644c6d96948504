"""Start of a scenario in a running match: robots and ball are put to their places, and the match begins anew."""

from collections.abc import Sequence
from difflib import get_close_matches

from procs.model.field import Field
from procs.scenarios.action import Action
from procs.scenarios.file import BOOK, Scenario, ScenarioError, parsed

_APART_M = 0.8  # from one robot beside the field to the next
_OUTSIDE = 0.6  # of the border is between the touch line and a robot beside the field


def found(name: str, text: str) -> Scenario:
    """Returns the scenario of the book that has this name, or the one that a text holds.

    Raises:
        ScenarioError: there is no such scenario, or it has mistakes.
    """
    if text:
        return parsed(text, name or "text")
    names = [path.stem for path in BOOK.glob("*.yaml")]
    if not name:
        raise ScenarioError("neither a name nor a text; give name=pass-reaches-the-mate, or a file as text=@FILE")
    if name not in names:
        near = get_close_matches(name, names, 1)
        raise ScenarioError(
            f"no scenario '{name}' in the book; "
            + (f"did you mean '{near[0]}'?" if near else "a file of your own is given as text=@FILE")
        )
    return parsed((BOOK / f"{name}.yaml").read_text(), name)


def start_of(scenario: Scenario, robots: Sequence[str], field: Field) -> list[Action]:
    """Returns the commands that prepare the match, in their order; the world stands still afterwards.

    Robots of the match that the scenario does not name are sent off and stand beside the field.

    Args:
        scenario: the scenario.
        robots: all robots of the match.
        field: measures of the field.
    """
    absent = [robot for robot in robots if robot not in scenario.everyone]
    actions = [Action(reset={}), Action(referee={"name": "reset"}), Action(freeze={"frozen": True})]
    y_m = -(field.half_width_m + _OUTSIDE * field.border_m)
    for place, robot in enumerate(robots):  # all leave first: nobody stands where another is put
        if robot in absent or robot in scenario.places:
            x_m = (place - (len(robots) - 1) / 2) * _APART_M
            actions.append(Action(place_robot={"robot": robot, "x_m": x_m, "y_m": y_m}))
    for robot, (x_m, y_m, heading_rad) in scenario.places.items():
        actions.append(Action(place_robot={"robot": robot, "x_m": x_m, "y_m": y_m, "heading_rad": heading_rad}))
    for robot in robots:
        if robot in (*absent, *scenario.dummies, *scenario.scripted):
            actions.append(Action(hold_robot={"robot": robot, "held": True}))
        if robot in absent:
            actions.append(Action(referee={"name": "red_card", "robot": robot}))
    return actions


def play_of(scenario: Scenario) -> list[Action]:
    """Returns the commands from the moment at which the world moves, in the order of their times."""
    begins = [Action(referee={"name": "start"})] if scenario.ball else []  # the kick-off is free at once
    return sorted([Action(freeze={"frozen": False}), *begins, *scenario.actions], key=lambda action: action.at_s)


def left_out(scenario: Scenario) -> list[str]:
    """Returns the names of what a running match keeps instead of taking it from the scenario."""
    names = [f"rules.{rule}" for rule in scenario.rules] + [f"settings.{name}" for name in scenario.settings]
    return names + [name for name in ("realism", "seed") if name in scenario.model_fields_set]
