"""Comparison of logs: equal logs, and every kind of difference, found and named."""

import random
import struct
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fwk.lcm.event_log import LogError
from fwk.recording.compare import Comparison, compare
from fwk.recording.differing import differing
from fwk.recording.log_info import log_info
from tests.fwk.recording.recording_made import Entry, entries, entry, odometry, world_model, write


def text_of(tmp_path: Path, a: list[Entry], b: list[Entry], common: bool = False) -> str:
    return str(compare(write(tmp_path / "A", a), write(tmp_path / "B", b), common))


def at(made: list[Entry], channel: str, tick: int) -> int:
    return [i for i, (name, _, _) in enumerate(made) if name == channel][tick - 1]


def test_the_same_messages_are_equal(tmp_path: Path) -> None:
    result = Comparison(write(tmp_path / "A", entries()), write(tmp_path / "B", entries()))
    assert result.difference is None
    assert (result.messages, result.channels) == (80, 4)


def test_interleaving_and_event_times_do_not_matter(tmp_path: Path) -> None:
    mixed = [(channel, data, 7) for channel, data, _ in sorted(entries(), key=lambda made: made[0])]
    assert text_of(tmp_path, entries(), mixed) == "None"
    assert text_of(tmp_path, mixed, entries()) == "None"


def test_every_channel_that_differs_is_named_once(tmp_path: Path) -> None:
    b = entries()
    for channel, tick in (("cyan2/odometry", 7), ("cyan2/odometry", 9), ("cyan1/odometry", 8)):
        b[at(b, channel, tick)] = entry(channel, odometry(30, 1), tick)
    result = Comparison(write(tmp_path / "A", entries()), write(tmp_path / "B", b))
    assert [(each.channel, each.tick) for each in result.differences] == [("cyan2/odometry", 7), ("cyan1/odometry", 8)]
    assert [row.component for row in differing(result.differences, None)] == ["cyan2/base", "cyan1/base"]


def test_the_frameworks_own_channels_do_not_count(tmp_path: Path) -> None:
    without = [made for made in entries() if not made[0].startswith("fwk/")]
    assert text_of(tmp_path, entries(), without) == "None"


def test_liblcms_own_messages_do_not_count(tmp_path: Path) -> None:
    heard = [*entries(), ("LCM_SELF_TEST", b"lcm self test", 0)]
    assert text_of(tmp_path, entries(), heard) == "None"


def test_a_repeated_message_counts_once(tmp_path: Path) -> None:
    made = entries()
    heard = made[:]
    for distance in (1, 5, 30):
        heard.insert(40 + distance, made[40])
    result = Comparison(write(tmp_path / "A", made), write(tmp_path / "B", heard))
    assert result.difference is None
    assert result.repeated == 3


def test_a_repeated_message_with_other_bytes_is_a_difference(tmp_path: Path) -> None:
    made = entries()
    again = made[:]
    again.insert(at(made, "cyan1/odometry", 5) + 1, entry("cyan1/odometry", odometry(9, 9), 5))
    assert "cyan1/odometry: tick 5" in text_of(tmp_path, made, again)


@pytest.mark.parametrize("seed", range(8))
def test_one_changed_byte_anywhere_is_found(tmp_path: Path, seed: int) -> None:
    dice, made = random.Random(seed), entries()
    place = dice.choice([i for i, (channel, _, _) in enumerate(made) if not channel.startswith("fwk/")])
    channel, data, time_us = made[place]
    changed = bytearray(data)
    changed[dice.randrange(len(data))] ^= 1 << dice.randrange(8)
    assert text_of(tmp_path, made, [*made[:place], (channel, bytes(changed), time_us), *made[place + 1 :]]) != "None"


def test_a_changed_value_is_named_with_its_field_and_both_values(tmp_path: Path) -> None:
    made, other = entries(), entries()
    model = world_model(7, 2)
    model.ball.covariance[1][0] = 0.25
    other[at(other, "cyan2/world_model", 7)] = entry("cyan2/world_model", model, 7)
    assert text_of(tmp_path, made, other) == (
        "cyan2/world_model: tick 7, stage 4, message 7 by cyan2/world_model: "
        "ball.covariance[1][0] is 0.0 in A, 0.25 in B"
    )


def test_a_list_of_other_length_is_named_by_its_count(tmp_path: Path) -> None:
    made, other = entries(), entries()
    model = world_model(7, 1)
    model.mates = []
    other[at(other, "cyan1/world_model", 7)] = entry("cyan1/world_model", model, 7)
    assert text_of(tmp_path, made, other).endswith("n_mates is 1 in A, 0 in B")


@pytest.mark.parametrize(("a", "b"), [(0.0, -0.0), (float("nan"), 1.0)])
def test_floats_are_compared_by_their_bits(tmp_path: Path, a: float, b: float) -> None:
    logs = []
    for value in (a, b):
        made = odometry(1, 1)
        made.x_m, made.y_m = float("nan"), value
        logs.append([entry("cyan1/odometry", made, 1)])
    assert text_of(tmp_path, logs[0], logs[0]) == "None"
    assert text_of(tmp_path, logs[0], logs[1]).endswith(f"y_m is {a!r} in A, {b!r} in B")


def test_bytes_outside_all_fields_are_named_by_their_place(tmp_path: Path) -> None:
    made, other = entries(), entries()
    place = at(made, "cyan1/odometry", 3)
    channel, data, time_us = made[place]
    other[place] = (channel, data + b"!", time_us)
    assert text_of(tmp_path, made, other).endswith(
        f"byte {len(data)} is the end after {len(data)} bytes in A, 0x21 in B"
    )
    unknown = struct.pack(">qqqqhI", 1, 1, 1, 1, 1, 2) + b"w\0" + b"x" * 20
    assert text_of(tmp_path, [("foreign", unknown, 1)], [("foreign", unknown[:-1] + b"y", 1)]) == (
        f"foreign: message 1, which has no header: byte {len(unknown) - 1} is 0x78 in A, 0x79 in B"
    )


def test_another_type_is_named(tmp_path: Path) -> None:
    made, other = entries(), entries()
    place = at(made, "cyan1/odometry", 3)
    other[place] = ("cyan1/odometry", other[place][1][:7] + b"\0" + other[place][1][8:], other[place][2])
    found = text_of(tmp_path, made, other)
    assert "type is robot.odometry_t in A, unknown (fingerprint" in found


def swap(made: list[Entry], channel: str, tick: int) -> list[Entry]:
    first, second = at(made, channel, tick), at(made, channel, tick + 1)
    made[first], made[second] = made[second], made[first]
    return made


def without(made: list[Entry], channel: str, ticks: range) -> list[Entry]:
    gone = {at(made, channel, tick) for tick in ticks}
    return [event for i, event in enumerate(made) if i not in gone]


ODOMETRY = "cyan1/odometry"
STRUCTURAL = {
    "missing message": (
        lambda made: without(made, ODOMETRY, range(5, 6)),
        "cyan1/odometry: tick 5, stage 1, message 5 by cyan1/base: there in A, missing in B",
    ),
    "missing last message": (
        lambda made: without(made, ODOMETRY, range(20, 21)),
        "cyan1/odometry: tick 20, stage 1, message 20 by cyan1/base: there in A, missing in B",
    ),
    "missing channel": (
        lambda made: without(made, ODOMETRY, range(1, 21)),
        "cyan1/odometry: tick 1, stage 1, message 1 by cyan1/base: there in A, missing, as is the whole channel in B",
    ),
    "log ends early": (
        lambda made: made[:50],
        "cyan1/odometry: tick 11, stage 1, message 11 by cyan1/base: there in A, missing in B",
    ),
    "reordered": (
        lambda made: swap(made, ODOMETRY, 5),
        "cyan1/odometry: tick 5, stage 1, message 5 by cyan1/base: here in A, later in B",
    ),
}


@pytest.mark.parametrize(("change", "expected"), STRUCTURAL.values(), ids=STRUCTURAL)
def test_missing_and_misplaced_messages_are_named(
    tmp_path: Path, change: Callable[[list[Entry]], list[Entry]], expected: str
) -> None:
    assert text_of(tmp_path, entries(), change(entries())) == expected
    where, _, values = expected.rpartition(": ")
    first, second = values.removesuffix(" in B").split(" in A, ")
    assert text_of(tmp_path, change(entries()), entries()) == f"{where}: {second} in A, {first} in B"


def test_reordered_message_is_found_in_interleaved_logs(tmp_path: Path) -> None:
    ahead = sorted(swap(entries(), ODOMETRY, 5), key=lambda made: made[0])
    assert text_of(tmp_path, entries(), ahead).endswith("message 5 by cyan1/base: here in A, later in B")


def test_first_difference_in_the_loops_order_is_named(tmp_path: Path) -> None:
    other = entries()
    for channel, tick in [("cyan1/odometry", 9), ("cyan2/world_model", 8), ("cyan2/odometry", 8)]:
        message = odometry(99, 1) if "odometry" in channel else world_model(99, 1)
        other[at(other, channel, tick)] = entry(channel, message, tick)
    for a, b in [(entries(), other), (sorted(entries()), sorted(other))]:
        assert text_of(tmp_path, a, b).startswith("cyan2/odometry: tick 8, stage 1")


def test_common_compares_only_what_both_logs_reach(tmp_path: Path) -> None:
    late, early = entries()[25:], entries()[:75]
    assert text_of(tmp_path, late, early) != "None"
    result = Comparison(write(tmp_path / "A", late), write(tmp_path / "B", early), common=True)
    assert result.difference is None
    assert result.messages == 40
    late[at(late, ODOMETRY, 5)] = entry(ODOMETRY, odometry(99, 1), 10)
    assert text_of(tmp_path, late, early, common=True).startswith("cyan1/odometry: tick 10")
    assert "there in A, missing in B" in text_of(
        tmp_path, entries(), without(early, ODOMETRY, range(8, 9)), common=True
    )


def test_a_torn_tail_is_a_missing_message(tmp_path: Path) -> None:
    whole = write(tmp_path / "A", entries()[:-1])
    (tmp_path / "B").write_bytes(whole.read_bytes()[:-3])
    result = Comparison(whole, tmp_path / "B")
    assert "cyan2/world_model: tick 20" in str(result.difference)
    assert result.skipped_bytes[0] == 0
    assert result.skipped_bytes[1] > 0


@given(st.lists(st.tuples(st.integers(0, 12_000), st.integers(1, 255)), min_size=1, max_size=12), st.integers(0, 400))
def test_no_damage_makes_the_tools_crash(
    tmp_path_factory: pytest.TempPathFactory, flips: list[tuple[int, int]], cut: int
) -> None:
    folder = tmp_path_factory.mktemp("damage")  # of few files: a log looks for its parts in its folder
    whole = write(folder / "whole", entries())
    data = bytearray(whole.read_bytes())
    for place, bits in flips:
        data[place % len(data)] ^= bits
    (folder / "damaged").write_bytes(data[: len(data) - cut])
    for common in (False, True):
        for a, b in [(whole, folder / "damaged"), (folder / "damaged", whole)]:
            assert str(compare(a, b, common))
    assert log_info(folder / "damaged").events <= len(entries())


def test_files_with_nothing_to_compare_are_refused(tmp_path: Path) -> None:
    good = write(tmp_path / "good", entries())
    (tmp_path / "text").write_text("no log at all\n" * 10)
    empty = write(tmp_path / "empty", [])
    late = write(tmp_path / "late", entries()[75:])
    early = write(tmp_path / "early", entries()[:20])
    for a, b, common, expected in [
        (good, tmp_path / "text", False, "text: not an LCM log: no event in it; it has 140 bytes"),
        (good, tmp_path / "text", True, "text: not an LCM log: no event in it; it has 140 bytes"),
        (good, tmp_path / "none", False, "none: cannot read: No such file or directory"),
        (empty, empty, False, "nothing to compare: no messages outside 'fwk/'"),
        (late, early, True, "nothing to compare: no common sequence numbers"),
    ]:
        with pytest.raises(LogError) as caught:
            compare(a, b, common)
        assert expected in str(caught.value)
