"""Selection of messages by channel and type."""

from collections.abc import Sequence
from fnmatch import fnmatchcase

from fwk.lcm.envelope import STAMP
from fwk.lcm.event_log import Event, LogError
from fwk.lcm.messages import type_name
from fwk.lcm.type_registry import types_of
from fwk.model.errors import hint
from fwk.model.names import RESERVED
from fwk.recording.play.channels import Channels
from fwk.recording.versions import EXCERPT, PLAN


class Selection:
    """Choice of the messages of a log; stamps follow their messages, and the plan stays unless it is excluded.

    Args:
        channels: names or patterns of channels, such as `cyan1/*`; none means all.
        exclude: names or patterns of channels that are left out of these.
        types: names or patterns of types, such as `robot.*`; none means all.
    """

    def __init__(self, channels: Sequence[str] = (), exclude: Sequence[str] = (), types: Sequence[str] = ()) -> None:
        self._channels = Channels([*channels, PLAN, EXCERPT] if channels else (), exclude)
        self._types = types
        self._fits: dict[bytes, bool] = {}
        self._patterns = (*channels, *exclude)
        self._seen: dict[str, None] = {}
        self.takes_stamps = not any(fnmatchcase(STAMP, each) for each in exclude)
        """Whether messages of types without the header keep their stamps."""
        self.is_all = not (channels or exclude or types)
        """Whether every message is selected."""
        kinds = {"channels": channels, "without": exclude, "types": types}
        self.texts = [f"{kind} {' '.join(patterns)}" for kind, patterns in kinds.items() if patterns]
        """The selection in words, such as `channels cyan1/*`."""

    def takes(self, event: Event) -> bool:
        """Returns whether a message is selected."""
        self._seen[event.channel] = None
        if not self._channels.takes(event.channel, event.data):
            return False
        return not self._types or event.channel.startswith(RESERVED) or self._of_type(event.data)

    def check(self, place: str) -> None:
        """Checks, once all messages have been seen, that each pattern matched something.

        Raises:
            LogError: a pattern matched nothing; the text begins with `place`.
        """
        for pattern in self._patterns:
            if not any(fnmatchcase(name, pattern) for name in self._seen):
                raise LogError(f"{place}: no channel matches '{pattern}'; {hint(pattern, self._seen)}")
        if self._types and not any(self._fits.values()):
            names = ", ".join(dict.fromkeys(name for mark in self._fits for name in _names(mark))) or "none"
            raise LogError(f"{place}: no message of type {' or '.join(self._types)}; types in it: {names}")

    def _of_type(self, data: bytes) -> bool:
        mark = data[:8]
        if mark not in self._fits:
            self._fits[mark] = any(fnmatchcase(name, each) for name in _names(mark) for each in self._types)
        return self._fits[mark]


def _names(mark: bytes) -> list[str]:
    return [type_name(each) for each in types_of(mark)]
