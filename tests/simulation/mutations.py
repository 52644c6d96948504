"""Deliberate violations of the contract: each mutation replaces one method of the engine; histories must find it."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Any
from unittest.mock import patch

from fwk.component import services
from fwk.engine import lookahead
from fwk.engine.boundary import BoundaryRequest, BoundaryRequests
from fwk.engine.catch_up import CatchUp
from fwk.engine.channel_buffer import ChannelBuffer
from fwk.engine.schedule import Schedule
from fwk.engine.visibility import Visibility
from fwk.host.host import Host
from fwk.host.inputs import Inputs
from fwk.host.outputs import Outputs
from fwk.lcm.messages import Header
from fwk.model.plan import HostPlan, Plan
from fwk.supervisor.boundary import Boundary
from fwk.supervisor.control.control import Control


@dataclass(frozen=True)
class Mutation:
    """One way to break the contract."""

    name: str
    breaks: str
    """The broken promise."""
    owner: Any
    attribute: str
    replacement: Callable[[Any], Any]
    """Makes the broken method from the right one."""
    also: "Mutation | None" = None
    """A second method to break: two parts of the engine sort, and each repairs the other."""

    @contextmanager
    def applied(self) -> Iterator[None]:
        """Breaks the contract for the duration of the block."""
        right = getattr(self.owner, self.attribute)
        with ExitStack() as broken:
            broken.enter_context(patch.object(self.owner, self.attribute, self.replacement(right)))
            if self.also:
                broken.enter_context(self.also.applied())
            yield


def _visible_at_once(right: Any) -> Any:
    def publish(self: Visibility, channel: int, sequence: int) -> bool:
        moved: bool = right(self, channel, sequence)
        if moved:
            self.marks[channel] = sequence
            self._changed[channel] = self.step
        return moved

    return publish


def _never_new(_right: Any) -> Any:
    def applies(_self: CatchUp, _tick: int) -> bool:
        return False

    return applies


def _no_sequences(_right: Any) -> Any:
    def sequences(_self: Visibility, _host: int) -> Mapping[str, int]:
        return {}

    return sequences


def _nothing(_right: Any) -> Any:
    def do_nothing(*_: Any, **__: Any) -> None:
        pass

    return do_nothing


def _runs_again(right: Any) -> Any:
    def answer(self: Any, tick: Any, stage: int) -> Iterator[Any]:
        if (tick.tick, tick.step) == self._answered:
            self._answered = (tick.tick, tick.step - 1)
        yield from right(self, tick, stage)

    return answer


def _answers_once(right: Any) -> Any:
    def answer(self: Any, tick: Any, stage: int) -> Iterator[Any]:
        if (tick.tick, tick.step) != self._answered:
            yield from right(self, tick, stage)

    return answer


def _timeless(right: Any) -> Any:
    """Commands are sorted by a header without the time."""

    class Timeless:
        @staticmethod
        def of(data: bytes) -> Header:
            header = Header.of(data)
            return Header(0, header.sequence, header.time_us, 0, header.writer, header.end)

    return Timeless


def _as_they_arrive(_right: Any) -> Any:
    def take(self: BoundaryRequests) -> list[BoundaryRequest]:
        taken, self._requests = self._requests, []
        return taken

    return take


def _first_come(right: Any) -> Any:
    def ask(self: Schedule, _tick: int, _step: int, request: Any) -> None:
        right(self, 0, len(self._requests), request)

    return ask


def _in_the_middle(right: Any) -> Any:
    def ask_settings(self: Boundary, new: Any, origin: str) -> Any:
        asked = right(self, new, origin)
        waiting = self.requests.take()
        for request in waiting:
            if request.kind == "settings":
                self._set(request)
            else:
                self.requests.ask(request.tick, request.step, request.sender, request.kind, request.content)
        return asked

    return ask_settings


def _before_it_is_so(_right: Any) -> Any:
    def taken_over(self: Control, asked: Any) -> Any:
        return {"tick": self._loop.tick, "settings": [self._values(each.new) for each in asked]}

    return taken_over


def _uncounted(right: Any) -> Any:
    def gone(self: Inputs, message: Any) -> int:
        right(self, message)
        self.lost = 0
        return 0

    return gone


def _delivers_nothing_new(right: Any) -> Any:
    def take(self: ChannelBuffer) -> list[bytes]:
        taken: list[bytes] = right(self)
        return taken[-1:]

    return take


def _leaves_unseen(_right: Any) -> Any:
    def until_left(_self: Boundary) -> Iterator[int]:
        yield from ()

    return until_left


def _fails_at_once(right: Any) -> Any:
    def leave(self: Host, dones: Sequence[bytes]) -> Iterator[int]:
        if dones:
            yield from right(self, dones)

    return leave


def _boundless(_right: Any) -> Any:
    def of_host(plan: Plan, host: HostPlan) -> Mapping[int, int]:
        stages = {stage for index in host.components for stage in plan.components[index].stages}
        return dict.fromkeys(sorted(stages), max(stages, default=0))

    return of_host


MUTATIONS = (
    Mutation("early marks", "marks are visible one stage early", Visibility, "publish", _visible_at_once),
    Mutation("greedy newcomer", "a newcomer sees every message", CatchUp, "applies", _never_new),
    Mutation("newest alone", "an iteration sees only the newest message", ChannelBuffer, "take", _delivers_nothing_new),
    Mutation("sequence restarts", "a restarted writer counts from 1", Visibility, "sequences", _no_sequences),
    Mutation("void ignored", "messages of the dead stay", ChannelBuffer, "void", _nothing),
    Mutation("repeated tick runs", "a repeated tick runs an iteration again", Host, "_answer", _runs_again),
    Mutation("done not repeated", "a lost done is not sent again", Host, "_answer", _answers_once),
    Mutation("command order", "commands come by sender, not by time", services, "Header", _timeless),
    Mutation(
        "request order",
        "the main loop goes to the first done that arrives",
        BoundaryRequests,
        "take",
        _as_they_arrive,
        Mutation("", "", Schedule, "ask", _first_come),
    ),
    Mutation("fetch unanswered", "a writer does not answer a fetch", Outputs, "answer", _nothing),
    Mutation(
        "setting in a tick", "a setting changes in the middle of a tick", Boundary, "ask_settings", _in_the_middle
    ),
    Mutation("early answer", "a setting is acknowledged too early", Control, "_taken_over", _before_it_is_so),
    Mutation("silent loss", "a lost message is not counted", Inputs, "gone", _uncounted),
    Mutation("hasty failure", "a host with a failed component ends at once", Host, "_leave", _fails_at_once),
    Mutation("boundless lookahead", "a host does not wait for what it reads", lookahead, "_of_host", _boundless),
    Mutation("hasty boundary", "a tick does not wait for hosts that leave", Boundary, "_until_left", _leaves_unseen),
)
