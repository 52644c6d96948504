"""`fwk eval` on the workers of a Dask cluster."""

import json
import logging
import os
import re
import socket
import sys
from concurrent.futures import ThreadPoolExecutor
from importlib import import_module
from itertools import count
from pathlib import Path
from threading import Thread
from typing import Any
from unittest.mock import patch

import pytest

from fwk.cli.recordings import evaluate
from fwk.plan.what_ran import hash_of_module
from fwk.testing import executors
from fwk.testing.campaign import Campaign
from fwk.testing.evaluation import Evaluation
from fwk.testing.executors import CampaignError, executor_of
from tests.fwk.cli.cli_eval_parts import measured
from tests.fwk.cli.cli_eval_tools import Queue, evaluated


def test_lost_cluster_is_named(tmp_path: Path) -> None:
    executor = Queue()
    runs = Campaign(tmp_path, {}).play(measured, "it", 1.0, [1, 2], executor)
    assert next(runs) == 1
    assert executor.futures[1].cancel()
    executor.futures[1].set_running_or_notify_cancel()
    with pytest.raises(CampaignError, match="1 of 2 runs failed: seed 2: the connection to the cluster was lost"):
        list(runs)


class Lost:
    """Client of a cluster that plays its first call, and has the workers of each look in turn."""

    def __init__(self, *looks: dict[str, int] | Exception) -> None:
        self.queue, self.looks = Queue(), list(looks)

    def get_executor(self, pure: bool) -> Queue:
        return self.queue

    def nthreads(self, callback_timeout: float) -> dict[str, int]:
        look = self.looks.pop(0) if len(self.looks) > 1 else self.looks[0]
        if isinstance(look, Exception):
            raise look
        return look


@pytest.mark.parametrize(
    ("look", "cause"),
    [
        ({}, "the Dask scheduler at tcp://it had no workers for 0.05 s; start some with: dask worker tcp://it"),
        (TimeoutError(), "the Dask scheduler at tcp://it gave no answer for 0.05 s"),
        (OSError("closed"), "the Dask scheduler at tcp://it gave no answer for 0.05 s"),
    ],
)
def test_runs_without_workers_fail(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, look: Any, cause: str) -> None:
    monkeypatch.setattr(executors, "LOST_S", 0.05)
    monkeypatch.setattr(executors, "_LOOK_S", 0.01)
    clock_us = count(0, 10_000)
    monkeypatch.setattr(executors, "monotonic_us", lambda: next(clock_us))
    client = Lost({"worker": 1}, {}, {"worker": 1}, look)
    with executors._Workers(client, "tcp://it") as workers:
        runs = Campaign(tmp_path, {}).play(measured, "it", 1.0, [1, 2, 3], workers)
        assert next(runs) == 1
        with pytest.raises(CampaignError, match=re.escape(f"2 of 3 runs failed: seeds 2, 3: {cause}")):
            list(runs)
        client.queue.give_up()  # an answer that comes late changes nothing
        assert str(workers.submit(max, 1, 2).exception(5)) == cause
    assert len(client.looks) == 1


def test_workers_fail_and_lose_calls_as_dask_says() -> None:
    client = Lost({"worker": 1})
    with executors._Workers(client, "tcp://it") as workers:
        played, lost, failed = (workers.submit(max, 1, 2) for _ in range(3))
        client.queue.futures[1].cancel()
        client.queue.futures[2].set_exception(ValueError("unlucky"))
    assert played.result(5) == 2
    assert str(lost.exception(5)) == "the connection to the cluster was lost"
    assert str(failed.exception(5)) == "unlucky"


def test_library_of_the_cluster_prints_no_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(executors, "CONNECT_S", 0.1)
    with pytest.raises(CampaignError), executor_of(1, "tcp://127.0.0.1:9"):
        pass
    assert not any(
        logging.getLogger(name).isEnabledFor(logging.ERROR) for name in ("distributed", "distributed.client")
    )


def test_worker_with_other_code_is_named(launch: Path) -> None:
    module = "tests.fwk.cli.cli_eval_parts"
    modules = {module: hash_of_module(module)}
    assert Evaluation(f"{module}:measured", modules=modules)(str(launch), 1.0, 1)["seed"] == 1
    with pytest.raises(CampaignError, match=f"a worker has other code of {module} and 1 more; copy the code"):
        Evaluation(f"{module}:measured", modules={module: "0", "no.such": "1"})(str(launch), 1.0, 1)


def test_worker_keeps_the_code_that_it_used_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(tmp_path))
    file = tmp_path / "cli_eval_changing.py"
    file.write_text("def measured(file, time_s, seed):\n    return {'seed': seed}\n")
    former = {"cli_eval_changing": hash_of_module("cli_eval_changing")}
    assert Evaluation("cli_eval_changing:measured", modules=former)("it", 1.0, 1) == {"seed": 1}
    file.write_text("def measured(file, time_s, seed):\n    return {'seed': -seed}\n")
    now = {"cli_eval_changing": hash_of_module("cli_eval_changing")}
    with pytest.raises(CampaignError, match="a worker has other code of cli_eval_changing"):
        Evaluation("cli_eval_changing:measured", modules=now)("it", 1.0, 1)


@pytest.mark.parametrize("file", ["it.yaml", "soccer-truth.yaml"])
def test_launch_file_is_told_as_workers_find_it(launch: Path, monkeypatch: pytest.MonkeyPatch, file: str) -> None:
    """Workers run in folders of their own, so that a path from the folder of the command would lead nowhere."""
    told: list[str] = []

    class Workers(ThreadPoolExecutor):
        def submit(self, work: Any, /, *words: Any, **named: Any) -> Any:
            told.append(words[0])
            return super().submit(dict, seed=words[2])

    monkeypatch.setattr(evaluate, "executor_of", lambda *_: Workers(1))
    evaluated(file, "--seeds", "1", "--cluster", "tcp://it")
    assert told == [str(launch) if file == "it.yaml" else "soccer-truth.yaml"]


@pytest.mark.slow
@patch.dict(os.environ)  # a cluster of this process sets variables for its workers
def test_two_dask_workers_play_the_seeds(launch: Path) -> None:
    distributed: Any = import_module("distributed")
    with distributed.Client(n_workers=2, threads_per_worker=1, dashboard_address="127.0.0.1:0") as client:
        address = client.scheduler.address
        assert evaluated(str(launch), "--seeds", "1..4", "--cluster", address)[:2] == (0, "1 2 3 4\n")
        code, _, said = evaluated(str(launch), "--seeds", "12..13", "--cluster", address)
        assert (code, "seed 13: ValueError: an unlucky seed" in said) == (1, True)
    results = [json.loads((launch.parent / f"eval-it/seed-{seed}.json").read_text()) for seed in (1, 2, 3, 4, 12)]
    assert len({result["process"] for result in results} - {os.getpid()}) == 2


@pytest.mark.slow
@patch.dict(os.environ)
def test_cluster_without_workers_is_named(launch: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(executors, "CONNECT_S", 1.0)
    distributed: Any = import_module("distributed")
    with distributed.Client(n_workers=0, dashboard_address="127.0.0.1:0") as client:
        address = client.scheduler.address
        code, _, said = evaluated(str(launch), "--seeds", "1", "--cluster", address)
    assert (code, f"{address} has no workers; start some with: dask worker {address}" in said) == (1, True)


def test_address_that_needs_certificates_is_refused(launch: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(executors, "CONNECT_S", 0.1)
    code, _, said = evaluated(str(launch), "--seeds", "1", "--cluster", "tls://127.0.0.1:9")
    assert (code, "no Dask scheduler at tls://127.0.0.1:9: TLS expects" in said) == (1, True)


def test_address_without_a_scheduler_is_named(launch: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(executors, "CONNECT_S", 0.1)
    code, _, said = evaluated(str(launch), "--seeds", "1", "--cluster", "tcp://127.0.0.1:9")
    assert (code, "no Dask scheduler at tcp://127.0.0.1:9" in said) == (1, True)


@pytest.mark.parametrize("address", ["nonsense", "tcp://127.0.0.1", "tcp://127.0.0.1:9/"])
def test_text_that_is_no_address_is_told_what_one_is(launch: Path, address: str) -> None:
    code, _, said = evaluated(str(launch), "--seeds", "1", "--cluster", address)
    assert (code, f"no Dask scheduler at {address}: " in said) == (1, True)
    assert said.endswith("; write its address, such as tcp://192.168.1.5:8786\n")


def greet(server: socket.socket, greeting: bytes) -> None:
    """Greets a caller, and hears it until it leaves."""
    caller, _ = server.accept()
    with caller:
        caller.sendall(greeting)
        while caller.recv(65_536):
            pass


@pytest.mark.parametrize("greeting", [b"", b"HTTP/1.1 400 Bad Request"])
def test_other_program_at_the_address_is_named(launch: Path, monkeypatch: pytest.MonkeyPatch, greeting: bytes) -> None:
    monkeypatch.setattr(executors, "CONNECT_S", 0.5)
    with socket.create_server(("127.0.0.1", 0)) as server:
        other = Thread(target=greet, args=(server, greeting), daemon=True)
        other.start()
        address = f"tcp://127.0.0.1:{server.getsockname()[1]}"
        code, _, said = evaluated(str(launch), "--seeds", "1", "--cluster", address)
        other.join(10)
    assert (code, f"no Dask scheduler at {address}: another program answers" in said) == (1, True)


def test_missing_dask_is_named_with_the_line_to_type(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    right = "a cluster needs Dask, which is not installed; type: pip install 'fwk[eval]'"
    with pytest.raises(CampaignError, match=re.escape(right)), executor_of(1, "tcp://127.0.0.1:9"):
        pass
