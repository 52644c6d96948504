"""Messages that one component has not seen yet of the channels that it reads."""

from collections.abc import Mapping, Sequence

from fwk.engine.catch_up import CatchUp


class InputView:
    """Collects messages that became visible since the component's last iteration."""

    def __init__(self, catch_up: CatchUp) -> None:
        self._catch_up = catch_up
        self._waiting: dict[str, list[bytes]] = {}
        self._joined: set[str] = set()  # channels that the component reads from its next iteration on

    def arrive(self, channel: str, messages: Sequence[bytes]) -> None:
        """Takes messages of a channel that became visible, oldest first."""
        waiting = self._waiting.get(channel)
        if waiting is None:
            self._waiting[channel] = list(messages)
        else:
            waiting += messages

    def join(self, channel: str, messages: Sequence[bytes]) -> None:
        """Begins to show a channel; the next iteration sees its newest message only."""
        self._waiting[channel] = list(messages)
        self._joined.add(channel)

    def leave(self, channel: str) -> None:
        """Shows nothing of a channel any more."""
        self._waiting.pop(channel, None)
        self._joined.discard(channel)

    def waiting(self, channel: str) -> Sequence[bytes]:
        """Returns the messages of a channel that the next iteration may see, oldest first."""
        return self._waiting.get(channel, ())

    def pass_over(self, tick: int) -> None:
        """Notes a tick in which the component takes part without an iteration; messages wait for the next one."""
        if not self._catch_up.applies(tick):
            self._catch_up.took_part(tick)

    def take(self, tick: int) -> Mapping[str, list[bytes]]:
        """Returns what an iteration of this tick sees, by channel, each oldest first; empty channels are left out."""
        seen, self._waiting = self._waiting, {}
        if self._catch_up.takes_part(tick):
            seen = {channel: messages[-1:] for channel, messages in seen.items()}
        if self._joined:
            for channel in self._joined & seen.keys():
                seen[channel] = seen[channel][-1:]
            seen = {channel: messages for channel, messages in seen.items() if messages}
            self._joined = set()
        return seen
