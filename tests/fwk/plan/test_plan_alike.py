"""Settings whose type is marked with `Alike`: all components of a system have the same value."""

from collections.abc import Callable

import pytest

from fwk.model.errors import PlanError
from fwk.model.plan import Plan

Load = Callable[..., Plan]

BEDS = """
components:
  a/gardener: {use: plan_parts:Gardener}
  b/gardener: {use: plan_parts:Gardener, config: {gain: 0.25}}
  c/gardener: {use: plan_parts:Gardener}
"""
RIGHT = "all components have to agree: state it once, under 'shared:'"


def mistakes(load: Load, text: str, *sets: str) -> list[str]:
    with pytest.raises(PlanError) as caught:
        load(text, sets=sets)
    return str(caught.value).splitlines()


def test_other_value_names_both_components_and_its_place(load: Load) -> None:
    assert mistakes(load, f"{BEDS}config: {{c/gardener: {{bed: {{speed_m_s: 3.0}}}}}}") == [
        f"it.yaml:6: c/gardener: 'bed.speed_m_s' is 3.0 in c/gardener, but 2.0 in a/gardener and 1 more; {RIGHT}"
    ]


def test_component_that_differs_is_wrong_though_it_is_first(load: Load) -> None:
    assert mistakes(load, BEDS, "a/gardener.names.fern=2") == [
        f"--set: a/gardener: 'names.fern' is 2 in a/gardener, but 1 in b/gardener and 1 more; {RIGHT}"
    ]


@pytest.mark.parametrize(
    ("stated", "difference"),
    [
        ("{ivy: 2, fern: 1}", "'names.ivy' is 2 in b/gardener, but missing in a/gardener and 1 more"),
        ("{}", "'names.fern' is missing in b/gardener, but 1 in a/gardener and 1 more"),
    ],
)
def test_entry_that_others_lack_is_named(load: Load, stated: str, difference: str) -> None:
    (mistake,) = mistakes(load, BEDS.replace("{gain: 0.25}", f"{{names: {stated}}}"))
    assert mistake.startswith("it.yaml:4: b/gardener: " + difference)


def test_values_stated_for_all_are_right(load: Load) -> None:
    plan = load(f"{BEDS}shared: {{bed: {{speed_m_s: 3.0}}, names: {{ivy: 2, fern: 1}}}}")
    assert {str(each.config["bed"]) for each in plan.components} == {"{'speed_m_s': 3.0, 'turns': [-1.0, 1.0]}"}
    load(f"{BEDS}config: {{'*/gardener': {{names: {{moss: 3}}}}}}")


def test_order_of_entries_makes_no_difference(load: Load) -> None:
    load(BEDS, sets=["*/gardener.names={fern: 1, ivy: 2}", "b/gardener.names={ivy: 2, fern: 1}"])


def test_differences_in_a_template_are_told_once(load: Load) -> None:
    text = """
components: {house/gardener: {use: plan_parts:Gardener}}
templates: {bed: {one: {use: plan_parts:Gardener}, odd: {use: plan_parts:Gardener}}}
robots: {a: {use: bed}, b: {use: bed}}
config: {"*/odd": {names: {fern: 7}}}
"""
    assert mistakes(load, text) == [
        f"it.yaml:5: a/odd (and 1 more): 'names.fern' is 7 in a/odd, but 1 in house/gardener and 2 more; {RIGHT}"
    ]
