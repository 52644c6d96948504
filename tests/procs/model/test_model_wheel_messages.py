"""Wheels read from messages: each wrong number of wheels is told once."""

from procs.model.wheel_messages import WheelReader


def test_speeds_of_three_wheels_are_read() -> None:
    told: list[str] = []
    reader = WheelReader("rosy/wheel_command", "rosy stops", told.append)
    assert reader.read([0.1, 0.2, 0.3], "rosy/base") == (0.1, 0.2, 0.3)
    assert told == []


def test_each_wrong_number_of_wheels_names_its_writer_once() -> None:
    told: list[str] = []
    reader = WheelReader("rosy/wheel_command", "rosy stops", told.append)
    for count in (2, 2, 4, 3, 4):
        assert (reader.read([0.0] * count, "rosy/base") is None) == (count != 3)
    assert told == [
        f"rosy/wheel_command of rosy/base has {count} wheel speeds; this robot has 3 wheels, at 60, 180, 300 degrees "
        "from forward, and needs one speed for each, in this order; rosy stops"
        for count in (2, 4)
    ]
