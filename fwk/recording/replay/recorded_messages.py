"""The recorded messages that are not visible yet, and those that the recording lost."""

from collections.abc import Container, Iterator, Mapping
from pathlib import Path

from fwk.lcm.messages import Header, sequence_of
from fwk.recording.replay.recording import RecordedTick, RecordingError
from lcmtypes.core import header_t

MESSAGES_MAX = 1_000_000
"""Most messages of a channel in one tick; a record that names more is damaged."""


class RecordedMessages:
    """Messages of the recording, kept until the done that published them.

    Args:
        path: the log.
        lost: takes the sequence numbers by channel that became visible and are not in the recording.
    """

    def __init__(self, path: Path, lost: dict[str, set[int]]) -> None:
        self._path = path
        self._lost = lost
        self._marks: dict[int, int] = {}
        self._hidden: dict[tuple[str, int, int], list[bytes]] = {}  # by channel, tick and step

    def add(self, tick: RecordedTick, names: Mapping[int, str]) -> None:
        """Takes the messages of a tick; `names` are those of all channels.

        Raises:
            RecordingError: the record names more messages than there can be.
        """
        self._hidden.update(tick.messages)
        here: dict[str, list[int]] = {}
        for (channel, _, _), data in tick.messages.items():
            here.setdefault(channel, []).extend(map(sequence_of, data))
        for index, mark in zip(tick.record.channel, tick.record.sequence, strict=True):
            channel = names[index]
            before, self._marks[index] = self._marks.get(index, 0), mark
            if mark - before > MESSAGES_MAX:
                raise RecordingError(
                    f"{self._path}: damaged: {channel} cannot have {mark - before} messages in tick "
                    f"{tick.record.tick}; replay the ticks before it with --to-tick {tick.record.tick - 1}"
                )
            if len(here.get(channel, ())) < mark - before:
                lost = {*range(before + 1, mark + 1)} - {*here.get(channel, ())}
                self._lost.setdefault(channel, set()).update(lost)
        for channel, numbers in here.items():
            if max(numbers) > MESSAGES_MAX and max(numbers) > self._newest(channel, names) + MESSAGES_MAX:
                raise RecordingError(
                    f"{self._path}: damaged: {channel} cannot have message {max(numbers)} in tick {tick.record.tick}; "
                    f"replay the ticks before it with --to-tick {tick.record.tick - 1}"
                )

    def _newest(self, channel: str, names: Mapping[int, str]) -> int:
        """Returns the newest mark of a channel, which may have had several indices."""
        return max((mark for index, mark in self._marks.items() if names.get(index) == channel), default=0)

    def take(self, channel: str, tick: int, step: int) -> list[bytes]:
        """Returns the messages of a done on a channel, oldest first."""
        return self._hidden.pop((channel, tick, step), [])

    def take_final(self, channel: str, incarnation: int) -> list[bytes]:
        """Returns what an incarnation of a writer wrote in `finalize` on a channel, oldest first.

        Such messages carry the tick of their component's own last iteration, so the tick of the done does not tell
        which they are. A component that is restarted again at the same boundary has several incarnations there.
        """
        found: list[bytes] = []
        for key in sorted(key for key in self._hidden if key[0] == channel and key[2] == header_t.FINAL):
            messages = self._hidden.pop(key)
            own = [data for data in messages if Header.of(data).incarnation == incarnation]
            found += own
            if len(own) < len(messages):
                self._hidden[key] = [data for data in messages if data not in own]
        return found

    def hide(self, messages: Mapping[tuple[str, int, int], list[bytes]]) -> None:
        """Takes messages, by channel, tick and step, without a record of the main loop."""
        self._hidden.update(messages)

    def has_any(self, channels: Container[str]) -> bool:
        """Returns whether messages of these channels are kept."""
        return any(key[0] in channels for key in self._hidden)

    def take_all(self, channels: Container[str]) -> Iterator[tuple[str, list[bytes]]]:
        """Yields all messages of these channels, each with its channel."""
        for key in [key for key in self._hidden if key[0] in channels]:
            yield key[0], self._hidden.pop(key)
