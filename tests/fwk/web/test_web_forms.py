"""Texts that people type into pages, and the answers of the pages."""

import json
from typing import Any

import pytest

from fwk.lcm.messages import of_dict
from fwk.web.pages.log import FilterMistakeError, filter_of
from fwk.web.pages.settings import choices_of, matches, tree_of
from fwk.web.rates import Rates
from fwk.web.sending import FieldError, examples_of, fields_of, value_of
from fwk.web.words import age, rows_of, seconds, size
from lcmtypes.core import log_t
from lcmtypes.robot import joint_state_t
from lcmtypes.soccer import place_ball_t, world_model_t


def test_a_form_has_the_fields_that_people_fill_in() -> None:
    assert fields_of(place_ball_t) == dict.fromkeys(
        ("x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s"), ("double", True)
    )
    fields = fields_of(world_model_t)
    assert "n_mates" not in fields
    assert fields["localized"] == ("boolean", True)
    assert fields_of(joint_state_t)["names"] == ("string", False)


def test_lists_and_structures_begin_with_their_empty_value() -> None:
    examples = examples_of(world_model_t)
    ball = json.loads(examples["ball"])
    assert (ball["x_m"], ball["covariance"]) == (0.0, [[0.0] * 4] * 4)
    assert examples["mates"] == examples_of(joint_state_t)["names"] == "[]"
    assert "localized" not in examples
    typed = examples | {"ball": json.dumps(ball | {"x_m": 1.5})}
    values = {name: value_of(name, *fields_of(world_model_t)[name], text) for name, text in typed.items()}
    assert of_dict(world_model_t, values).ball.x_m == 1.5


@pytest.mark.parametrize(
    ("type_name", "plain", "typed", "value"),
    [
        ("double", True, " 1.5", 1.5),
        ("double", True, "", 0.0),
        ("int32_t", True, "7", 7),
        ("string", True, "1", "1"),
        ("boolean", True, True, True),
        ("double", False, "[1, 2]", [1, 2]),
        ("byte", False, "[1, 255]", b"\x01\xff"),
        ("double", False, "", None),
    ],
)
def test_fields_become_values_of_their_type(type_name: str, plain: bool, typed: Any, value: Any) -> None:
    assert value_of("field", type_name, plain, typed) == value


@pytest.mark.parametrize(
    ("type_name", "plain", "typed", "said"),
    [
        ("double", True, "far", "field: 'far' is not a number of type double"),
        ("int8_t", True, "1.5", "field: '1.5' is not a number of type int8_t"),
        ("double", False, "[1,", r"field: '\[1,' is not JSON"),
        ("byte", False, "[256]", "bytes are numbers from 0 to 255"),
    ],
)
def test_a_wrong_field_is_named(type_name: str, plain: bool, typed: str, said: str) -> None:
    with pytest.raises(FieldError, match=said):
        value_of("field", type_name, plain, typed)


def line(tick: int) -> dict[str, Any]:
    return dict.fromkeys(log_t.__slots__, "") | {"level": "info", "tick": tick, "component": "a/b"}


@pytest.mark.parametrize(
    ("typed", "wanted"), [("", (1, 5, 9)), ("5", (5,)), ("5..", (5, 9)), ("..5", (1, 5)), (" 1 .. 5 ", (1, 5))]
)
def test_ticks_are_typed_as_ranges(typed: str, wanted: tuple[int, ...]) -> None:
    chosen = filter_of("debug", "", typed, "", "", "")
    assert tuple(tick for tick in (1, 5, 9) if chosen.wants(line(tick))) == wanted


def test_times_and_places_are_typed_as_people_say_them() -> None:
    lines = [line(5) | {"time_us": time_us, "file": "a/agent.py", "line": 41} for time_us in (900_000, 1_500_000)]
    for times, place, wanted in (
        ("0.5..1", "agent.py", (900_000,)),
        ("1..", "agent.py:41", (1_500_000,)),
        ("1", " a/agent.py:41 ", (1_500_000,)),
        ("", "agent.py:42", ()),
        ("", "gent.py", ()),
    ):
        chosen = filter_of("debug", "", "", times, place, "")
        assert tuple(each["time_us"] for each in lines if chosen.wants(each)) == wanted, (times, place)


@pytest.mark.parametrize(("ticks", "text"), [("x", ""), ("..", ""), ("1 2", ""), ("", "(")])
def test_a_filter_that_is_not_understood_is_refused(ticks: str, text: str) -> None:
    with pytest.raises(FilterMistakeError, match=r"ticks: write|text: "):
        filter_of("debug", "", ticks, "", "", text)


def test_rates_come_from_counts_and_survive_quick_looks() -> None:
    rates = Rates()
    assert rates.measure([{"channel": "a", "messages": 10}], 1_000_000) == {}
    assert rates.measure([{"channel": "a", "messages": 30}], 2_000_000) == {"a": 20.0}
    assert rates.measure([{"channel": "a", "messages": 31}], 2_100_000) == {"a": 20.0}
    assert rates.measure([{"channel": "a", "messages": 3}], 3_000_000) == {"a": 0.0}  # a new run


def test_settings_are_found_in_the_tree_and_by_text() -> None:
    about = {"origin": "default", "meaning": "Radius of the circle.", "value": 2.0}
    rows = [{**about, "component": name, "setting": "radius_m"} for name in ("a/mower", "a/rake", "b/mower")]
    assert [node["id"] for node in tree_of(rows, "")] == ["a", "b"]
    assert [child["id"] for child in tree_of(rows, "")[0]["children"]] == ["a/mower", "a/rake"]
    assert tree_of(rows, "b/mow")[0]["id"] == "b"
    assert [matches(rows[0], name, "") for name in ("", "a", "a/mower", "a/mow", "b")] == [
        True,
        True,
        True,
        False,
        False,
    ]
    assert matches(rows[0], "", "RADIUS OF")
    assert not matches(rows[0], "", "diameter")


def test_figures_are_written_for_people() -> None:
    assert (seconds(61_500_000), age(None), age(0.25), age(70.0), age(1200.0)) == (
        "1:01.50",
        "never",
        "0.25 s",
        "70 s",
        "20 min",
    )
    assert (size(999), size(1500), size(2_000_000), size(3_500_000_000)) == ("999 B", "1.5 kB", "2.0 MB", "3.5 GB")
    message = {"x_m": 1.23456789, "list": list(range(20)), "of": [{"a": 1}], "text": "<b>"}
    assert rows_of("", message) == [
        ("x_m", "1.23457"),
        ("list", "[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, ... (20)]"),
        ("of[0].a", "1"),
        ("text", "<b>"),
    ]


@pytest.mark.parametrize(
    ("kind", "value", "words"),
    [
        ("none | harsh", "harsh", ["none", "harsh"]),
        ("str | int", "pictures", []),
        ("float | None", None, []),
        ("list[str]", ["a"], []),
    ],
)
def test_only_a_word_among_others_is_chosen(kind: str, value: Any, words: list[str]) -> None:
    assert choices_of({"type": kind, "value": value}) == words
