"""Selects and renames the channels of played messages; stamps follow the messages to which they belong."""

from collections.abc import Mapping, Sequence
from fnmatch import fnmatchcase

from fwk.lcm.envelope import STAMP
from fwk.lcm.messages import MessageError, decoder, encode
from lcmtypes.core import stamp_t

CHANNEL_BYTES_MAX = 63
"""Longest name of a channel on an LCM bus."""
_decode = decoder(stamp_t, STAMP)


class Channels:
    """Choice and new names of channels.

    Args:
        include: names or patterns of channels; none means all.
        exclude: names or patterns of channels that are left out of these.
        names: new names of channels by former ones.

    Raises:
        ValueError: a new name cannot be that of a channel, or two channels would have the same name.
    """

    def __init__(
        self, include: Sequence[str] = (), exclude: Sequence[str] = (), names: Mapping[str, str] | None = None
    ) -> None:
        self._include, self._exclude, self._names = include, exclude, dict(names or {})
        self._known: dict[str, bool] = {}
        for new in self._names.values():
            if not 1 <= len(new.encode()) <= CHANNEL_BYTES_MAX:
                raise ValueError(f"'{new}' is not a channel; a name has 1 to {CHANNEL_BYTES_MAX} bytes")
        if len(set(self._names.values())) < len(self._names):
            twice = sorted(new for new in self._names.values() if list(self._names.values()).count(new) > 1)
            raise ValueError(f"two channels would have the name '{twice[0]}'; give each a name of its own")

    def takes(self, channel: str, data: bytes) -> bool:
        """Returns whether a message is played."""
        if channel == STAMP and (stamp := _stamp(data)):
            channel = stamp.channel
        if channel not in self._known:
            included = not self._include or any(fnmatchcase(channel, each) for each in self._include)
            self._known[channel] = included and not any(fnmatchcase(channel, each) for each in self._exclude)
        return self._known[channel]

    def renamed(self, channel: str, data: bytes) -> tuple[str, bytes]:
        """Returns a message with its new channel."""
        if channel == STAMP and self._names and (stamp := _stamp(data)) and stamp.channel in self._names:
            stamp.channel = self._names[stamp.channel]
            return channel, encode(stamp, STAMP)
        return self._names.get(channel, channel), data


def _stamp(data: bytes) -> stamp_t | None:
    try:
        stamp: stamp_t = _decode(data)
    except MessageError:
        return None
    return stamp
