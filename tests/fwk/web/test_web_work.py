"""Work that pages do: commands in child processes, settings for later runs, figures of processes."""

import asyncio
import os
import signal
import threading
from pathlib import Path
from typing import Any, cast

import pytest

from fwk.control.client import RefusedError
from fwk.web.access import Role
from fwk.web.file_settings import differing
from fwk.web.job import Job, keep_priority
from fwk.web.pages.runs import launch_files
from fwk.web.run_link import RunLink
from fwk.web.usage import Usage
from fwk.web.view import RunAccess
from lcmtypes.soccer import place_ball_t


def test_a_command_tells_its_output_and_its_end() -> None:
    told: list[str] = []
    job = Job(["python", "-c", "print('half'); import sys; sys.exit('whole')"], told.append)
    assert job.code is None
    assert asyncio.run(job.run()) == job.code == 1
    assert sorted("".join(told).split()) == ["half", "whole"]


def test_a_command_keeps_the_priority_of_the_start() -> None:
    told: list[str] = []
    before = os.getpriority(os.PRIO_PROCESS, 0)

    def run_later() -> None:
        os.nice(3)  # lowers this thread alone
        asyncio.run(
            Job(["python", "-c", "import os; print(os.nice(0), os.getsid(0) == os.getpid())"], told.append).run()
        )

    keep_priority()
    thread = threading.Thread(target=run_later)
    thread.start()
    thread.join()
    assert "".join(told).split() == [str(before), "True"]


def test_a_command_is_ended_as_by_ctrl_c() -> None:
    async def begin_and_end() -> tuple[int, str]:
        told: list[str] = []
        begun = asyncio.Event()

        def take(text: str) -> None:
            told.append(text)
            if "begun\n" in "".join(told):
                begun.set()

        script = (
            "import os, time\ntry:\n os.write(1, b'begun\\n')\n time.sleep(60)\n"
            "except KeyboardInterrupt: os.write(1, b'ended\\n')"
        )
        job = Job(["python", "-c", script], take)
        running = asyncio.ensure_future(job.run())
        await begun.wait()
        job.end()
        return await running, "".join(told)

    handler = signal.signal(signal.SIGINT, signal.SIG_IGN)  # as in the background of a script
    try:
        code, text = asyncio.run(begin_and_end())
    finally:
        signal.signal(signal.SIGINT, handler)
    assert code == 0
    assert text.startswith("begun")
    assert text.endswith("ended\n")


class Run:
    """Stands for the connection to a run."""

    recorded = False

    def __init__(self, file: Path, refuses: bool = False, state: str = "done") -> None:
        self._file = file
        self._refuses = refuses
        self._state = state
        self.asked: list[dict[str, Any]] = []

    async def about(self) -> dict[str, Any]:
        return {"file": str(self._file)}

    async def ask(self, verb: str, **fields: Any) -> dict[str, Any]:
        self.asked.append({"verb": verb, **fields})
        if self._refuses:
            raise RefusedError("too large")
        return {"tick": 7}

    async def message_type(self, channel: str) -> Any:
        assert channel == "world/place_ball@outside"
        return place_ball_t

    async def call(self, name: str, data: bytes, timeout_s: float) -> dict[str, Any]:
        self.asked.append({"name": name, "x_m": place_ball_t.decode(data).x_m, "timeout_s": timeout_s})
        return {"state": self._state, "reason": "the ball is frozen" if self._state == "rejected" else ""}


def access(run: Run, role: Role = Role.STEER) -> RunAccess:
    return RunAccess(cast(RunLink, run), role)


@pytest.mark.parametrize("state", ["done", "accepted", "sent"])
def test_a_call_returns_its_last_answer(state: str) -> None:
    run = Run(Path(), state=state)
    assert asyncio.run(access(run).call("world/place_ball", {"x_m": 2.0}, 3.0))["state"] == state
    assert run.asked == [{"name": "world/place_ball", "x_m": 2.0, "timeout_s": 3.0}]


@pytest.mark.parametrize(
    ("state", "said"), [("rejected", "rejected: the ball is frozen"), ("failed", "failed"), ("expired", "expired")]
)
def test_a_call_that_is_not_carried_out_is_an_error(state: str, said: str) -> None:
    with pytest.raises(RefusedError, match=f"^world/place_ball: {said}$"):
        asyncio.run(access(Run(Path(), state=state)).call("world/place_ball", {"x_m": 2.0}))


MOWER = """
from typing import Annotated

from fwk import Alike, Component, Config

class MowerConfig(Config):
    radius_m: float = 3.0
    lawn_m2: Annotated[float, Alike] = 50.0

class Mower(Component):
    stage = "act"
    config: MowerConfig
"""


@pytest.fixture
def garden(tmp_path: Path) -> Path:
    (tmp_path / "mower.py").write_text(MOWER)
    file = tmp_path / "garden.yaml"
    file.write_text("components: {a/mower: {use: mower}, b/mower: {use: mower}}\n")
    return file


def test_settings_are_kept_for_later_runs_of_this_machine(garden: Path, tmp_path: Path) -> None:
    run = Run(garden)
    asyncio.run(access(run).set(["a/mower.radius_m=3.5"], save=True))
    assert "radius_m: 3.5" in (tmp_path / "garden.host.yaml").read_text()
    assert [each.get("check", False) for each in run.asked] == [True, False]
    assert run.asked[1]["origin"].endswith("garden.host.yaml")


def test_settings_that_a_later_run_refuses_are_not_kept(garden: Path, tmp_path: Path) -> None:
    run = Run(garden)
    with pytest.raises(RefusedError, match=r"(?s)all components have to agree.*the next run would refuse it"):
        asyncio.run(access(run).set(["a/mower.lawn_m2=60"], save=True))
    assert [each["check"] for each in run.asked] == [True]
    assert not (tmp_path / "garden.host.yaml").exists()
    asyncio.run(access(run).set(["*/mower.lawn_m2=60"], save=True))
    assert "lawn_m2: 60" in (tmp_path / "garden.host.yaml").read_text()


def test_refused_settings_are_not_kept(tmp_path: Path) -> None:
    run = Run(tmp_path / "garden.yaml", refuses=True)
    with pytest.raises(RefusedError, match="too large"):
        asyncio.run(access(run).set(["a/mower.radius_m=50"], save=True))
    with pytest.raises(RefusedError, match="for reading only"):
        asyncio.run(access(run, Role.READ).set(["a/mower.radius_m=3"], save=True))
    assert list(tmp_path.iterdir()) == []
    assert len(run.asked) == 1


def test_settings_that_differ_from_the_launch_file_are_found() -> None:
    rows = [{"component": "a/b", "setting": name, "value": 1.0} for name in ("same", "other", "new")]
    found = differing(rows, {("a/b", "same"): 1.0, ("a/b", "other"): 2.0})
    assert found == [{"component": "a/b", "setting": "other", "value": 1.0, "in_file": 2.0}]


def test_processes_have_figures_as_long_as_they_exist() -> None:
    usage = Usage()
    assert usage.measure([os.getpid()])[os.getpid()].cpu_percent > 0.0  # the mean, as long as no other is known
    found = usage.measure([os.getpid(), 0, 2**22 + 1])
    assert [*found] == [os.getpid()]
    assert found[os.getpid()].memory_mb > 5


def test_launch_files_are_listed_without_those_of_hosts(tmp_path: Path) -> None:
    (tmp_path / "launch").mkdir()
    for name in ("b.yaml", "a.yaml", "a.host.yaml", "notes.txt"):
        (tmp_path / "launch" / name).touch()
    assert launch_files(tmp_path) == ["a.yaml", "b.yaml"]
    assert launch_files(tmp_path / "nowhere") == []
