"""`fwk eval` that is interrupted or killed: its runs end with it, and it says what is left."""

import json
import os
import signal
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import psutil
import pytest

from fwk.testing.campaign import Campaign
from tests.fwk.cli.cli_eval_tools import LAUNCH, evaluated
from tests.harness.commands import BIN
from tests.harness.terminals import Child

KILLED = """
import os, signal
from fwk.testing.executors import executor_of
with executor_of(1) as workers:
    print(workers.submit(os.getpid).result(), flush=True)
    workers.submit(signal.pause).result()
"""


def test_runs_of_a_killed_evaluation_end_with_it() -> None:
    with subprocess.Popen([sys.executable, "-c", KILLED], stdout=subprocess.PIPE, text=True) as killed:
        assert killed.stdout
        worker = psutil.Process(int(killed.stdout.readline()))
        killed.kill()
    worker.wait(10)


INTERRUPTED = """
import os, signal, sys, threading
from pathlib import Path
from fwk.testing.campaign import Campaign
from fwk.testing.executors import executor_of
signal.signal(signal.SIGINT, signal.default_int_handler)
def work(file, time_s, seed):
    return signal.pause() if seed else os.getpid()
with executor_of(1) as workers:
    for _ in Campaign(Path(sys.argv[1]), {}).play(work, "it", 1.0, range(8), workers):
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
"""


def test_ctrl_c_does_not_wait_for_runs_that_have_begun(tmp_path: Path) -> None:
    words = [sys.executable, "-c", INTERRUPTED, str(tmp_path)]
    done = subprocess.run(words, capture_output=True, text=True, timeout=30)
    assert done.stderr.endswith("KeyboardInterrupt\n")
    assert "InvalidStateError" not in done.stderr
    assert not psutil.pid_exists(json.loads((tmp_path / "seed-0.json").read_text()))


def test_ctrl_c_while_a_result_is_written_leaves_no_part(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(_: int) -> None:
        raise KeyboardInterrupt

    campaign = Campaign(tmp_path, {})
    monkeypatch.setattr("os.fsync", interrupt)
    with ThreadPoolExecutor(1) as executor, pytest.raises(KeyboardInterrupt):
        list(campaign.play(lambda *_: [1.0], "it", 1.0, [1], executor))
    assert [file.name for file in tmp_path.iterdir()] == ["campaign.json"]


def test_ctrl_c_leaves_no_result_without_its_code(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A result without it would count as one of the code at hand, whatever becomes of the code."""
    campaign, keep, kept = Campaign(tmp_path, {}, code="old"), os.fsync, list[int]()

    def interrupt(file: int) -> None:
        if kept:
            raise KeyboardInterrupt
        kept.append(file)
        keep(file)

    monkeypatch.setattr("os.fsync", interrupt)
    with ThreadPoolExecutor(1) as executor, pytest.raises(KeyboardInterrupt):
        list(campaign.play(lambda *_: [1.0], "it", 1.0, [1], executor))
    monkeypatch.undo()
    later = Campaign(tmp_path, {}, code="new")
    assert later.missing([1]) + later.of_other_code([1]) == [1]


def test_interrupted_evaluation_says_what_is_left(launch: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    play = Campaign.play

    def interrupted(*words: Any) -> Any:
        yield next(play(*words))
        raise KeyboardInterrupt

    monkeypatch.setattr(Campaign, "play", interrupted)
    code, _, said = evaluated(str(launch), "--seeds", "1..3", "--jobs", "1")
    assert (code, "note: 1 of 3 runs have results; the same command plays the others" in said) == (130, True)


HANGING = """
import signal
from fwk import Component
class Idle(Component):
    stage = "act"
    def loop(self) -> None: pass
def measured(file, time_s, seed):
    return signal.pause() if seed == 2 else {"seed": seed}
def report(results, folder): return ""
"""


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_signal_ends_an_evaluation_as_ctrl_c_does(launch: Path, number: int) -> None:
    launch.write_text(LAUNCH.replace("tests.fwk.cli.cli_eval_parts", "hanging"))
    launch.with_name("hanging.py").write_text(HANGING)
    child = Child(launch.parent, [str(BIN / "fwk"), "eval", launch.name, "--seeds", "1..2", "--jobs", "1"])
    try:
        child.expect_exact("50%")
        os.kill(child.pid, number)
        child.expect_exact("\x1b[?25h")  # shows the cursor
        child.expect_exact("note: 1 of 2 runs have results; the same command plays the others")
        assert child.wait() == 130
    finally:
        child.close()
