"""Curves of fields."""

from types import SimpleNamespace

import pytest

from fwk.web.plotting import Curves, FieldNameError, number_at, parted


def test_a_field_is_found_in_structs_and_arrays() -> None:
    message = SimpleNamespace(x_m=1, word="a", below=SimpleNamespace(rows=[[1.0, 2.0], [3.0, 4.0]]))
    fields = ("x_m", "below.rows[1][0]", "below.rows[9][0]", "word", "no.such")
    assert [number_at(message, field) for field in fields] == [1.0, 3.0, None, None, None]
    assert parted(" a/pose.x_m ") == ("a/pose", "x_m")
    with pytest.raises(FieldNameError, match="'a/pose' is not CHANNEL"):
        parted("a/pose")


def test_curves_keep_their_points_and_begin_anew_with_a_run() -> None:
    curves = Curves()
    curves.choose(["a.x"])
    for time_us, value in ((1_000_000, 1.0), (1_000_000, 1.0), (2_000_000, 2.0), (3_000_000, None)):
        curves.add("a.x", time_us, value)
    curves.choose(["a.x", "a.y"])
    curves.add("a.y", 2_000_000, 5.0)
    curves.add("not chosen", 2_000_000, 5.0)
    assert [(each["name"], each["data"]) for each in curves.series()] == [
        ("a.x", [[1.0, 1.0], [2.0, 2.0]]),
        ("a.y", [[2.0, 5.0]]),
    ]
    curves.add("a.x", 500_000, 9.0)
    assert curves.series()[0]["data"] == [[0.5, 9.0]]
