"""Messages that cannot be encoded are named with the member, its path and its shape; messages from plain data."""

from typing import Any

import numpy as np
import pytest

from fwk.lcm import messages
from lcmtypes.core import frame_t, header_t
from lcmtypes.soccer import ball_percept_t

WRONG: list[tuple[Any, str]] = [
    (frame_t(width_px="wide"), "width_px is 'wide', not an int32_t"),  # type: ignore[arg-type]
    (frame_t(width_px=1 << 40), "width_px is 1099511627776, not an int32_t"),
    (frame_t(encoding=3), "encoding is 3, not a string"),  # type: ignore[arg-type]
    (frame_t(header=None), "header is a NoneType, not a core.header_t"),  # type: ignore[arg-type]
    (frame_t(header=header_t(tick="1")), "header.tick is '1', not an int64_t"),  # type: ignore[arg-type]
    (header_t(), "it is a header_t, not a core.frame_t"),
]


@pytest.mark.parametrize(("message", "text"), WRONG, ids=[text for _, text in WRONG])
def test_the_member_that_does_not_fit_is_named(message: Any, text: str) -> None:
    with pytest.raises(messages.MessageError) as told:
        messages.encoder(frame_t, "a/image")(message)
    assert str(told.value) == f"a/image: cannot encode core.frame_t: {text}"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (np.zeros((1, 2)), "covariance_m2 is an array of 1 x 2; it should be an array of 2 x 2"),
        ([1.0, 2.0], "covariance_m2 is an array of 2; it should be an array of 2 x 2"),
        ([[1.0, 2.0], [3.0]], "covariance_m2 is an array of 2 x 1; it should be an array of 2 x 2"),
        (5.0, "covariance_m2 is 5.0; it should be an array of 2 x 2"),
        ([[1.0, 2.0], [3.0, "x"]], "covariance_m2[1][1] is 'x', not a double"),
    ],
)
def test_a_wrong_array_names_member_and_shape(value: Any, text: str) -> None:
    with pytest.raises(messages.MessageError) as told:
        messages.encode(ball_percept_t(covariance_m2=value), "a/ball")
    assert str(told.value) == f"a/ball: cannot encode soccer.ball_percept_t: {text}"


def test_a_dict_becomes_a_struct() -> None:
    made = messages.of_dict(frame_t, {"frame": 3, "header": {"tick": 7, "writer": "a/b"}})
    assert repr(made) == "frame_t(header=header_t(tick=7, writer='a/b'), frame=3)"
    with pytest.raises(messages.MessageError, match="header_t has no field 'tik'; its fields are tick"):
        messages.of_dict(frame_t, {"header": {"tik": 7}})


@pytest.mark.parametrize("name", ["frame_t", "picture_t", "transform_t", "transforms_t"])
def test_types_are_found_by_their_former_names(name: str) -> None:
    assert messages.type_named(f"robot.{name}") is messages.type_named(f"core.{name}")
