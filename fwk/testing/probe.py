"""Replays a recording with the code of a folder and looks whether a condition holds: one step of `fwk bisect`.

python -m fwk.testing.probe LOG REPOSITORY FOLDER CONDITION [COMPONENT...]
"""

import json
import sys
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from fwk.lcm import envelope, messages
from fwk.lcm.type_registry import put_first, use_types_of
from fwk.recording.replay.recording import RecordedTick, Recording, RecordingError
from fwk.recording.replay.replay import Made, Replay
from fwk.testing.expression import Expression, ExpressionError

DIFFERS = "differs"
"""Condition: a component writes something else than in the recording."""


_SIDES = "the recording", "the replay"


class NoChannelError(Exception):
    """A condition names a channel that the recording does not have."""


class _ReachedError(Exception):
    """The condition holds; the rest of the recording does not matter."""


class Probe(Replay):
    """A replay that ends with the first tick in which a condition holds on what the components write.

    Args:
        recording: the recording.
        condition: `differs`, or a condition over messages: `cyan1.odometry.x_m > 3`. The messages are those of the
            replay, and recorded ones of components that are not replayed.
        only: names or patterns of the components to replay; none means all.

    Raises:
        ExpressionError: the condition cannot be understood.
        RecordingError: the recording cannot be replayed.
    """

    def __init__(self, recording: Recording, condition: str, only: Sequence[str] = ()) -> None:
        self.condition = None if condition == DIFFERS else Expression(condition)
        super().__init__(recording, only)
        self.tick: int | None = None
        """The first tick in which the condition holds; None: in none yet."""
        self.text = ""
        """The difference, if the condition is `differs`."""
        self._types = {channel.name: messages.type_named(channel.type_name) for channel in recording.plan.channels}
        self._last: dict[str, bytes] = {}  # newest message of each channel
        self._ours: set[str] = set()  # channels of the replayed components

    def look(self, to_tick: int | None = None) -> None:
        """Replays until the condition holds, or to the end."""
        try:
            self.run(to_tick)
        except _ReachedError:
            return

    def _tick(self, tick: RecordedTick) -> None:
        super()._tick(tick)
        if self.condition is None:
            holds = bool(self.differences)
            self.text = str(replace(self.differences[0], names=_SIDES)) if holds else ""
        else:
            holds = bool(self.condition.value(self._value))
        if holds:
            self.tick = tick.record.tick
            raise _ReachedError

    def _compare(self, host: int, tick: int, step: int, made: Made) -> None:
        for life, written in made:
            self._ours.update(life.writes)
            self._last.update(written)
        super()._compare(host, tick, step, made)

    def _publish(self, channel: str, data: list[bytes]) -> None:
        if channel not in self._ours:
            self._last[channel] = data[-1]
        super()._publish(channel, data)

    def _value(self, channel: str) -> Any:
        """Returns the newest message of a channel; the zero of its type before the first."""
        if channel not in self._types:
            raise NoChannelError(
                f"no channel '{channel}' in the recording; there are: {', '.join(sorted(self._types))}"
            )
        kind = self._types[channel]
        return envelope.decode(kind, self._last[channel], channel) if channel in self._last else kind()


def folders_in(folders: Iterable[str], repository: Path, worktree: Path) -> list[Path]:
    """Returns the folders of a run as they are in another worktree of its repository."""
    found = [Path(folder).resolve() for folder in folders]
    moved = [worktree / each.relative_to(repository) if each.is_relative_to(repository) else each for each in found]
    return list(dict.fromkeys([*moved, worktree]))


def main(log: str, repository: str, worktree: str, condition: str, *only: str) -> dict[str, Any]:
    """Returns the answer of a probe: the tick in which the condition holds, or why there is none."""
    recording = Recording(Path(log))
    folders = folders_in(recording.plan.folders, Path(repository), Path(worktree))
    for folder in folders:
        use_types_of(folder)
    put_first([str(folder) for folder in folders])
    probe = Probe(recording, condition, only)
    probe.look()
    return {"tick": probe.tick, "text": probe.text}


if __name__ == "__main__":
    try:
        answer = main(*sys.argv[1:])
    except (ExpressionError, NoChannelError) as error:
        answer = {"mistake": str(error)}
    except RecordingError as error:
        answer = {"unusable": str(error)}
    except Exception as error:
        answer = {"unusable": f"{type(error).__name__}: {error}"}
    print(json.dumps(answer))
