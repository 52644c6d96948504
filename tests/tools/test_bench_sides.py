"""The loops of supervisor and component, with transports made of lists."""

from collections import deque
from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

import pytest

from tools.bench import supervise
from tools.bench.component import run
from tools.bench.sample import Sample
from tools.bench.shape import LAST_WARM_UP_TICK, Shape
from tools.bench.sides import STOP
from tools.bench.supervise import NoAnswerError, measure, run_tick


class Ring:
    """Components that answer at once, except that the first `lose` ticks or answers are lost."""

    def __init__(self, shape: Shape, lose: int = 0) -> None:
        self.shape = shape
        self.lose = lose
        self.begun: list[tuple[int, int]] = []
        self.answers: deque[tuple[int, int]] = deque()

    def begin(self, stage: int, tick: int) -> None:
        self.begun.append((stage, tick))
        for index in self.shape.members(stage):
            if self.lose:
                self.lose -= 1
            else:
                self.answers.append((index, tick))

    def done(self, timeout_s: float) -> tuple[int, int] | None:
        return self.answers.popleft() if self.answers else None

    def close(self) -> None: ...


def test_a_tick_is_all_stages_in_order() -> None:
    ring = Ring(Shape(7))
    assert run_tick(ring, ring.shape, 3) == 0
    assert ring.begun == [(stage, 3) for stage in range(5)]


def test_stages_without_components_are_left_out() -> None:
    ring = Ring(Shape(2))
    run_tick(ring, ring.shape, 1)
    assert ring.begun == [(0, 1), (1, 1)]


def test_a_lost_answer_repeats_its_stage_only() -> None:
    ring = Ring(Shape(10), lose=1)
    assert run_tick(ring, ring.shape, 1) == 1
    assert ring.begun == [(0, 1), (0, 1), (1, 1), (2, 1), (3, 1), (4, 1)]


def test_an_answer_to_an_older_tick_does_not_count() -> None:
    ring = Ring(Shape(1))
    ring.answers.append((0, 1))
    ring.lose = 1
    assert run_tick(ring, ring.shape, 2) == 1


def test_silence_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(supervise, "_GIVE_UP_S", 0.0)
    ring = Ring(Shape(5), lose=10**9)
    with pytest.raises(NoAnswerError, match="tick 9, stage 0: no answer from 1 components: c0"):
        run_tick(ring, ring.shape, 9)


def test_measure_stops_at_its_number_of_ticks_or_its_time() -> None:
    ring = Ring(Shape(1))
    assert len(measure(ring, ring.shape, 100, 7, 60.0)["tick_us"]) == 7
    assert ring.begun[0] == (0, 101)
    assert len(measure(ring, ring.shape, 107, 10**6, 0.0)["tick_us"]) < 10**6


class Script:
    """A component's side with scripted ticks and inputs."""

    def __init__(self, ticks: Sequence[int], source_ticks: Sequence[int | None]) -> None:
        self.ticks = deque(ticks)
        self.source_ticks = deque(source_ticks)
        self.published: list[Any] = []
        self.answered: list[int] = []

    def tick(self) -> int:
        return self.ticks.popleft()

    def inputs(self) -> list[Any]:
        tick = self.source_ticks.popleft()
        return [SimpleNamespace(header=SimpleNamespace(tick=tick), x_m=2.0, y_m=3.0) if tick is not None else None]

    def new_sample(self) -> Sample:
        return SimpleNamespace(header=SimpleNamespace())

    def publish(self, sample: Any) -> None:
        self.published.append(sample)

    def done(self, tick: int) -> None:
        self.answered.append(tick)

    def close(self) -> None: ...


T = LAST_WARM_UP_TICK


def test_a_repeated_tick_is_answered_again_and_not_run_again() -> None:
    side = Script([T + 1, T + 1, T + 2, STOP], [T + 1, T + 2])
    assert run(side, Shape(5), 1) == (2, 0)
    assert side.answered == [T + 1, T + 1, T + 2]
    assert [sample.header.tick for sample in side.published] == [T + 1, T + 2]


def test_output_depends_on_input() -> None:
    side = Script([T + 1, STOP], [T + 1])
    run(side, Shape(5, padding_bytes=7), 1)
    written = side.published[0]
    assert (written.x_m, written.y_m, written.n_padding, written.padding) == (3.0, 2.0, 7, bytes(7))


def test_stale_inputs_are_counted_but_not_in_the_warm_up() -> None:
    side = Script([1, T + 1, T + 2, T + 3, STOP], [None, T, None, T + 3])
    assert run(side, Shape(5), 1) == (4, 2)
