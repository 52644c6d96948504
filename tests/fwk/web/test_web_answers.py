"""Answers that browsers share, and how a run is found again."""

import asyncio
from pathlib import Path
from typing import Any

import pytest

from fwk.web.extensions import ExtensionError, Extensions
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


def test_a_view_without_draw_is_refused_at_start(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(tmp_path))
    (tmp_path / "half_lawn.py").write_text("from fwk.web import View\n\n\nclass Lawn(View):\n    title = 'Lawn'\n")
    with pytest.raises(ExtensionError, match=r"^half_lawn: class Lawn does not define draw$"):
        Extensions(("half_lawn",))
