"""Choice of channels, new names and plugins."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

from fwk.lcm.envelope import STAMP
from fwk.lcm.event_log import Event, LogReader
from fwk.recording.play.channels import Channels
from fwk.recording.play.plugins import PluginError, Plugins
from lcmtypes.core import stamp_t
from lcmtypes.robot import odometry_t
from tests.fwk.recording.play.play_logs import foreign, recording


class Faster:
    """Doubles speeds."""

    channels = ("*/odometry",)

    def play(self, channel: str, message: Any, time_us: int) -> Iterable[tuple[str, Any]]:
        message.vx_m_s *= 2
        yield channel, message
        yield "invented", str(time_us).encode()


class Silent(Faster):
    """Drops messages."""

    def play(self, channel: str, message: Any, time_us: int) -> Iterable[tuple[str, Any]]:
        return ()


class Broken(Faster):
    """Fails."""

    channels = ("*",)

    def play(self, channel: str, message: Any, time_us: int) -> Iterable[tuple[str, Any]]:
        yield channel, message.no_such_field / time_us


class Mute:
    """Lacks what a plugin has."""


def stamp(channel: str) -> bytes:
    made = stamp_t()
    made.channel = channel
    return bytes(made.encode())


def first(log: Path) -> Event:
    """Returns the first message of a robot or an arm."""
    return next(event for event in LogReader(log) if not event.channel.startswith("fwk/"))


def test_patterns_choose_channels_and_their_stamps() -> None:
    channels = Channels(["cyan1/*", "fwk/*"], ["*/odometry"])
    taken = [channels.takes(name, b"") for name in ("cyan1/pose", "cyan1/odometry", "cyan2/pose", "fwk/log")]
    assert taken == [True, False, False, True]
    assert [channels.takes(STAMP, stamp(name)) for name in ("cyan1/pose", "cyan2/pose")] == [True, False]
    assert Channels().takes("any", b"")


def test_a_new_name_reaches_the_stamp_too() -> None:
    channels = Channels(names={"a": "b"})
    assert channels.renamed("a", b"x") == ("b", b"x")
    assert channels.renamed("c", b"x") == ("c", b"x")
    assert channels.renamed(STAMP, stamp("a")) == (STAMP, stamp("b"))


@pytest.mark.parametrize(
    ("names", "reason"),
    [
        ({"a": "x" * 64}, "is not a channel; a name has 1 to 63 bytes"),
        ({"a": "c", "b": "c"}, "two channels would have the name 'c'"),
    ],
)
def test_impossible_new_names_are_refused(names: dict[str, str], reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        Channels(names=names)


def test_plugins_change_drop_and_invent_messages(tmp_path: Path) -> None:
    event = first(recording(tmp_path / "log"))
    changed, invented = Plugins([f"{__name__}:Faster"]).played(event)
    assert odometry_t.decode(changed[1]).vx_m_s == 2.0
    assert invented == ("invented", b"50000")
    assert Plugins([f"{__name__}:Faster", f"{__name__}:Silent"]).played(event) == [invented]
    assert Plugins().played(event) == [(event.channel, event.data)]


@pytest.mark.parametrize(
    ("word", "reason"),
    [
        ("Faster", "'Faster' is not a plugin; write 'module:Class'"),
        ("no_module:A", "plugin no_module:A: ModuleNotFoundError: No module named 'no_module'"),
        (f"{__name__}:Mute", "lacks 'channels', a tuple of channels or patterns, or a method"),
    ],
)
def test_a_plugin_that_cannot_be_used_is_named(word: str, reason: str) -> None:
    with pytest.raises(PluginError) as found:
        Plugins([word])
    assert reason in str(found.value)


def test_a_plugin_that_fails_is_named_with_the_message(tmp_path: Path) -> None:
    broken = Plugins([f"{__name__}:Broken"])
    with pytest.raises(PluginError, match=r"Broken: cyan1/odometry at 50000 us: AttributeError: .*no_such_field"):
        broken.played(first(recording(tmp_path / "log")))
    with pytest.raises(
        PluginError, match=r"Broken: arm: a message of an unknown type \(fingerprint 0000000000000000\)"
    ):
        broken.played(first(foreign(tmp_path / "arm")))
