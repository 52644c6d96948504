"""One value in a YAML text changes, all other text stays as written."""

import pytest

from fwk.control.yaml_edit import EditError, read, with_value, without

GAIN = ("config", "a/b", "gain")


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("", "config:\n  a/b:\n    gain: 0.5\n"),
        ("# mine\n", "# mine\nconfig:\n  a/b:\n    gain: 0.5\n"),
        ("speed: 2  # slow", "speed: 2  # slow\nconfig:\n  a/b:\n    gain: 0.5\n"),
        ("config:\n", "config: {a/b: {gain: 0.5}}\n"),
        ("config: {}\n", "config: {a/b: {gain: 0.5}}\n"),
        ("config: {c/d: {x: 1}}\n", "config: {c/d: {x: 1}, a/b: {gain: 0.5}}\n"),
        (
            "config:\n  a/b:\n    gain: 1  # why\n  # end\nspeed: 1\n",
            "config:\n  a/b:\n    gain: 0.5  # why\n  # end\nspeed: 1\n",
        ),
        ("config:\n  a/b: {gain: 1, x: 2}\n\nspeed: 3", "config:\n  a/b: {gain: 0.5, x: 2}\n\nspeed: 3"),
        (
            "config:\n  a/b:\n    x: 1  # one\n\n  c/d:\n    y: 2\n",
            "config:\n  a/b:\n    x: 1  # one\n    gain: 0.5\n\n  c/d:\n    y: 2\n",
        ),
        (
            "config:\n  a/b:\n    xs:\n    - 1\n    - 2\nspeed: 1\n",
            "config:\n  a/b:\n    xs:\n    - 1\n    - 2\n    gain: 0.5\nspeed: 1\n",
        ),
        (
            "config:\n  a/b:\n    t: |\n      one\n      two\nspeed: 1\n",
            "config:\n  a/b:\n    t: |\n      one\n      two\n    gain: 0.5\nspeed: 1\n",
        ),
        ("config:\n  a/b:\n    gain:\n    x: 1\n", "config:\n  a/b:\n    gain: 0.5\n    x: 1\n"),
    ],
)
def test_the_value_is_inserted_where_a_person_would_put_it(before: str, after: str) -> None:
    assert with_value(before, GAIN, 0.5) == after


@pytest.mark.parametrize(
    "before",
    [
        "config:\n  a/b:\n    gain: [1,\n      2]\n    x: 1\n",
        "config:\n  a/b:\n    gain:\n    - 1\n    - 2\n    x: 1\n",
        "config:\n  a/b:\n    gain:\n      deep: 1\n      deeper: 2\n    x: 1\n",
        "config:\n  a/b:\n    gain: |\n      long\n      text\n    x: 1\n",
        "config:\n  a/b:\n    gain: 'quoted'  # kept\n    x: 1\n",
    ],
)
@pytest.mark.parametrize(
    "value", [0.5, "te: xt", [1, 2.5], {"deep": 1, "*": False}, float("inf"), 1e-7, None, "é\n", {"🙂": "🙂"}]
)
def test_any_value_replaces_any_other(before: str, value: object) -> None:
    changed = read(with_value(before, GAIN, value))
    assert changed == {"config": {"a/b": {"gain": value, "x": 1}}}


def test_a_pattern_is_quoted() -> None:
    text = with_value("", ("config", "*/camera", "noise"), 2)
    assert '"*/camera":' in text
    assert read(text) == {"config": {"*/camera": {"noise": 2}}}


@pytest.mark.parametrize(
    ("text", "error"),
    [
        (
            "config:\n  a/b: &x {gain: 1}\n  c/d: *x\n",
            "'config.a/b.gain' cannot be changed there without touching other",
        ),
        ("config: [\n", "the text is not YAML; correct it first: fwk check names the place"),
        ("a: 1\na: 2\n", "the text is not YAML; correct it first: fwk check names the place"),
    ],
)
def test_a_change_that_would_damage_the_file_is_refused(text: str, error: str) -> None:
    with pytest.raises(EditError, match=error):
        with_value(text, GAIN, 0.5)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("config:\n  a/b:\n    gain: 0.5\n", ""),
        ("# mine\nconfig:\n  a/b:\n    gain: 0.5  # why\nspeed: 2\n", "# mine\nspeed: 2\n"),
        ("config:\n  a/b:\n    gain: 1\n    x: 1  # one\n", "config:\n  a/b:\n    x: 1  # one\n"),
        ("config:\n  a/b:\n    x: 1\n    gain:\n      deep: 1\n", "config:\n  a/b:\n    x: 1\n"),
        ("config:\n  a/b:\n    gain:\n    - 1\n    - 2\n  c/d: {x: 2}", "config:\n  c/d: {x: 2}"),
        ("config:\n  a/b:\n    gain: |\n      long\n      text\n    x: 1\n", "config:\n  a/b:\n    x: 1\n"),
        ("config: {a/b: {gain: 0.5}}\n", ""),
        ("config: {a/b: {gain: 0.5, x: 1}}\n", "config: {a/b: {x: 1}}\n"),
        ("config: {a/b: {x: 1, gain: 0.5}}\n", "config: {a/b: {x: 1}}\n"),
        ("config: {c/d: {x: 1}, 'a/b': {gain: 0.5}}", "config: {c/d: {x: 1}}"),
    ],
)
def test_removal_includes_mappings_that_become_empty(before: str, after: str) -> None:
    assert without(before, GAIN) == after


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("", "there is no"),
        ("config: {a/b: {x: 1}}", "there is no 'config.a/b.gain'"),
        ("config: {a/b: 3}", "there is no"),
        ("config: [", "the text is not YAML"),
        ("config:\n  a/b: &x {gain: 1}\n  c/d: *x\n", "without touching other values"),
        ("config:\n  a/b: {gain: 1}\n  c/d: {<<: *x}\n", "the text is not YAML"),
    ],
)
def test_a_missing_value_is_not_removed(text: str, error: str) -> None:
    with pytest.raises(EditError, match=error):
        without(text, GAIN)


def test_letters_beyond_16_bits_stay_unchanged() -> None:
    text = with_value("", ("config", "a/b", "\U0001f916"), "\U0001f916")
    assert read(text) == {"config": {"a/b": {"\U0001f916": "\U0001f916"}}}
    assert read('{"\\ud83e\\udd16": "\\ud83e\\udd16"}') == {"\U0001f916": "\U0001f916"}
