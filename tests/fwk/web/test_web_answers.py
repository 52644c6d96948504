"""Answers that browsers share, and how a run is found again."""

import asyncio
from pathlib import Path
from typing import Any

import pytest

from fwk.web.extensions import ExtensionError, Extensions
from fwk.web.pace import PaceMeter
from fwk.web.run_link import NotRunningError, Runs
from fwk.web.shared import Shared


def test_a_question_is_asked_once_in_a_time() -> None:
    now_us = 0
    asked: list[int] = []

    async def make() -> int:
        asked.append(now_us)
        await asyncio.sleep(0)
        return len(asked)

    async def browsers() -> None:
        nonlocal now_us
        shared = Shared(lambda: now_us)
        assert await asyncio.gather(*(shared.get("state", 0.5, make) for _ in range(10))) == [1] * 10
        now_us = 499_999
        assert await shared.get("state", 0.5, make) == 1
        assert await shared.get("other", 0.5, make) == 2
        now_us = 500_000
        assert await shared.get("state", 0.5, make) == 3

    asyncio.run(browsers())
    assert asked == [0, 499_999, 500_000]


def test_a_mistake_is_an_answer_and_is_asked_again_later() -> None:
    now_us = 0

    async def fail() -> None:
        raise ValueError(now_us)

    async def browsers() -> None:
        nonlocal now_us
        shared = Shared(lambda: now_us)
        for moment_us, said in ((0, "0"), (100, "0"), (1_000_000, "1000000")):
            now_us = moment_us
            with pytest.raises(ValueError, match=f"^{said}$"):
                await shared.get("state", 1.0, fail)

    asyncio.run(browsers())


def test_a_browser_that_leaves_does_not_cancel_the_others() -> None:
    async def browsers() -> None:
        shared = Shared(lambda: 0)
        gate = asyncio.Event()

        async def make() -> str:
            await gate.wait()
            return "here"

        first, second = (asyncio.ensure_future(shared.get("state", 1.0, make)) for _ in range(2))
        await asyncio.sleep(0)
        first.cancel()
        gate.set()
        assert await second == "here"

    asyncio.run(browsers())


def test_runs_are_told_apart_by_name_or_by_port() -> None:
    runs: dict[int, dict[str, Any]] = {
        1: {"name": "red", "plan": "match"},
        2: {"name": "", "plan": "match"},
        3: {"name": "", "plan": "match"},
    }

    async def browser() -> None:
        found = Runs(Shared(), lambda: runs)
        assert list(await found.all()) == ["red", "2", "3"]
        assert (await found.link("red").about())["plan"] == "match"
        with pytest.raises(NotRunningError, match="'blue' does not run"):
            await found.link("blue").about()

    asyncio.run(browser())


def test_a_run_that_answers_late_still_runs() -> None:
    looks = iter([{1: {"name": "red", "plan": "match"}, 2: {"name": "blue", "plan": "match"}}, {}, {}])
    ports = iter([[1, 2], [2]])
    now_us = 0

    async def browser() -> None:
        nonlocal now_us
        found = Runs(Shared(lambda: now_us), lambda: next(looks), lambda: next(ports))
        assert list(await found.all()) == ["red", "blue"]
        now_us += 1_000_000
        assert list(await found.all()) == ["red", "blue"]
        now_us += 1_000_000
        assert list(await found.all()) == ["blue"]

    asyncio.run(browser())


def lags(*answers: tuple[float, float, float, bool]) -> bool:
    """Tells whether a run lags that has said these: at a time in seconds its logical time, desired speed, and pause."""
    meter = PaceMeter()
    for now_s, time_s, pace, paused in answers:
        said = {"time_us": round(time_s * 1e6), "pace": pace, "paused": paused}
        meter.note(said, round(now_s * 1e6))
        meter.note(said, round(now_s * 1e6) + 900_000)  # a page asks again and gets the answer that is kept
    return meter.lags


@pytest.mark.parametrize(
    ("answers", "expected"),
    [
        ([], False),
        ([(0, 0, 1, False), (0.5, 0.1, 1, False)], False),
        ([(0, 0, 1, False), (2, 1.85, 1, False)], False),
        ([(0, 0, 1, False), (2, 1.75, 1, False)], True),
        ([(0, 0, 1, False), (3.5, 3.5, 1, False), (4, 3.8, 1, False)], False),  # a tick or two late
        ([(0, 0, 1, False), (9, 1, 1, False), (13, 5, 1, False)], False),  # it was late once
        ([(0, 0, 2, False), (2, 2, 2, False)], True),
        ([(0, 0, 2, False), (2, 2, 2, False), (3, 3, 0.5, False)], False),  # it is asked for less now
        ([(0, 0, 0, False)], True),
        ([(0, 0, 1, False), (2, 0.5, 1, True)], False),
        ([(0, 9, 1, False), (2, 0, 1, False)], False),  # it has started again
    ],
)
def test_a_run_lags_that_is_behind_for_seconds(answers: list[Any], expected: bool) -> None:
    assert lags(*answers) == expected


def test_a_view_without_draw_is_refused_at_start(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(tmp_path))
    (tmp_path / "half_lawn.py").write_text("from fwk.web import View\n\n\nclass Lawn(View):\n    title = 'Lawn'\n")
    with pytest.raises(ExtensionError, match=r"^half_lawn: class Lawn does not define draw$"):
        Extensions(("half_lawn",))
