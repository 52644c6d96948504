"""A recording in parts whose gateway is killed in a run with a choice of channels, and the tools on its rest."""

import json
import os
import signal
from pathlib import Path

import pytest

from fwk.clock import US_PER_S
from fwk.lcm.log_file import is_compressed
from fwk.lcm.log_parts import parts_of
from fwk.recording.log_info import log_info
from tests.harness.fixtures import Launch
from tests.harness.runs import PortBlock, fwk
from tests.programs.control_system import Steered, write_system

pytestmark = pytest.mark.system

LOST_S = 1.5  # the recorder flushes once a second


def test_a_killed_recorder_leaves_all_but_the_last_second(launch: Launch, tmp_path: Path, ports: PortBlock) -> None:
    write_system(tmp_path, ports)
    parts = ("--record", "log.lcm", "--record-split", "0.4s", "--record-compress")
    run = Steered(launch("small.yaml", "--speed", "1", "--record-exclude", "r/seen", *parts), ports)
    run.fwk("note", "here it begins")
    period_us = run.ask("run")["period_us"]
    run.ticks_pass(2 * US_PER_S // period_us)
    fwk(tmp_path, "cut", "log.lcm", "--last", "1", "--out", "just_now.lcm")
    tick = run.tick
    os.kill(run.launched.gateway(), signal.SIGKILL)
    assert run.launched.wait() != 0
    assert "recorded, without a replay: without r/seen" in run.launched.text
    assert is_compressed(parts_of(tmp_path / "log.lcm")[0])
    assert len(parts_of(tmp_path / "log.lcm")) >= 4
    told = json.loads(fwk(tmp_path, "repair", "log.lcm", "--out", "whole.lcm", "--json"))
    assert told["last_tick"] >= tick - LOST_S * US_PER_S / period_us
    assert told["lost_events"] == 0
    info = log_info(tmp_path / "whole.lcm")
    assert (info.from_index, [note.text for note in info.notes]) == (True, ["here it begins"])
    assert {"r/imu", "r/pose"} <= set(info.channels)
    assert "r/seen" not in info.channels
    fwk(tmp_path, "cut", "log.lcm", "--from", "here it begins", "--out", "part.lcm")
    begin, end = log_info(tmp_path / "part.lcm").ticks or (0, 0)
    assert (begin - info.notes[0].tick in (0, 1), end) == (True, told["last_tick"]), (
        "a note may follow its tick's record"
    )
    assert log_info(tmp_path / "just_now.lcm").duration_s >= 1
    refused = fwk(tmp_path, "replay", "whole.lcm", code=2)
    assert "whole.lcm: cannot be replayed: it is a part of a recording (without r/seen)" in refused
