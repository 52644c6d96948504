"""Programs in C and with JSON lines as components of a run: the same bytes, recorded, watched, restarted."""

import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import lcm
import psutil
import pytest

from fwk.scaffold.bindings import generate_bindings
from fwk.scaffold.project import Project
from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.runs import fwk, replayed, write_files

pytestmark = pytest.mark.system
CLIENTS = Path(__file__).parents[2] / "clients"
ENTRY = "reads: {step: walk.step_t}, writes: {sum: walk.step_t}, channels: {step: r/step}"


def system(folder: Path, url: str, **entries: str) -> None:
    """Writes a system of a walker and of these programs, each in a namespace of its own."""
    lines = [f"  {name}/adder: {{{entry}, {ENTRY}}}" for name, entry in entries.items()]
    plan = ["name: walk", f"public_url: {url}", "components:", "  r/walker: {use: walker}", *lines, ""]
    write_files(folder, {**sources("walker.py", "adder.py", "lcmtypes/walk.lcm"), "launch/walk.yaml": "\n".join(plan)})
    for name in ("walker.py", "adder.py"):
        (folder / name).replace(folder / "launch" / name)


def test_programs_write_the_same_bytes_in_every_run(tmp_path: Path, launch: Launch, needs: Callable[..., None]) -> None:
    needs("cc")
    services = "serves: {ask: [walk.ask_t, walk.told_t]}, calls: {other: [walk.ask_t, walk.told_t]}, stage: act"
    python = f"command: [{sys.executable}, ./adder.py, '-1', asks], {services}, config: {{repeatable: true}}"
    native = f"command: ./adder, {services}, config: {{coding: lcm, settings: {{a: 1}}}}"
    system(tmp_path, '""', c=native, json=python)
    file = tmp_path / "launch" / "walk.yaml"
    c, json = "channels: {other: json/ask, step: r/step}", "channels: {other: c/ask, step: r/step}"
    text = file.read_text().replace("channels: {step: r/step}", c, 1).replace("channels: {step: r/step}", json, 1)
    file.write_text(text)
    generate_bindings(Project(tmp_path), "c", tmp_path / "types")
    include = Path(lcm.__file__).parent.parent / "include"
    flags = [
        "-Wall",
        "-Wextra",
        "-Werror",
        "-std=c99",
        "-D_POSIX_C_SOURCE=200809L",
        f"-I{tmp_path}/types",
        f"-I{include}",
    ]
    types = [*map(str, (tmp_path / "types").glob("*.c"))]
    assert len(types) == 6
    subprocess.run(["cc", *flags, "-o", tmp_path / "adder", CLIENTS / "adder.c", *types], check=True)
    for log, hosting in (("a.log", "process"), ("b.log", "single")):
        run = launch("walk.yaml", "--ticks", "20", "--speed", "max", "--record", log, "--hosting", hosting)
        assert run.wait() == 0, run.text
        assert 'c/adder, {"a": 1}, 50000 us' in run.text
        assert "call 1: state 2, 26, " in run.text
        assert "call 3: state 3, 0, negative" in run.text
        assert "call 1: done, 26.0, " in run.text
        assert "call 3: rejected, None, negative" in run.text
    assert "equal: " in fwk(tmp_path, "compare", "a.log", "b.log")
    said = replayed(tmp_path, log="a.log")
    assert "not replayed: c/adder: it runs the program './adder'" in said
    assert "json/adder" not in said


def test_a_program_that_ends_is_started_again_and_leaves_nothing(tmp_path: Path, launch: Launch) -> None:
    system(tmp_path, '""', a=f"command: [{sys.executable}, ./adder.py, '5'], stage: act, restart: {{backoff_s: 0}}")
    run = launch("walk.yaml", "--speed", "10", "--record", "log.lcm")
    run.until("ended with exit code 3 and without an answer")
    run.until_true(lambda: bool(programs(run.processes())), "the program of the second life")
    (program,) = programs(run.processes())
    os.kill(program.ppid(), signal.SIGKILL)
    run.until_true(lambda: not program.is_running(), "the end of the program with its host")
    run.signal(signal.SIGINT)
    assert run.wait() in (0, 1), run.text
    replayed(tmp_path)


def programs(processes: list[psutil.Process]) -> list[psutil.Process]:
    """Returns the processes that run the program in Python."""
    found = []
    for each in processes:
        try:
            if "adder.py" in " ".join(each.cmdline()):
                found.append(each)
        except psutil.Error:
            continue
    return found
