"""A recording of protocol version 1 is replayed, compared, listed and exported like one of today."""

import json
import shutil
from collections import Counter
from pathlib import Path

import pytest

from fwk.lcm.event_log import LogReader, LogWriter
from fwk.lcm.typegen import generate
from fwk.model.plan_document import VERSION, document_of, plan_from
from fwk.model.tick_events import (
    ChannelsChanged,
    FinalDone,
    HostLost,
    HostStarted,
    HostStopped,
    IterationDone,
    MainLoopGiven,
    OutsideTaken,
    StageBegun,
    StageDone,
    TickTold,
)
from fwk.recording.replay.recording import Recording, RecordingError
from fwk.recording.versions import read_plan
from lcmtypes import core_v1
from lcmtypes.core import plan_t, protocol_t
from tests.harness.runs import fwk, replayed

OLD = Path(__file__).parents[2] / "data" / "recording_v1"
TICKS = 40


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the recorded application's folder, in another location than the original."""
    folder = Path(shutil.copytree(OLD, tmp_path / "workshop"))
    generate(folder / "lcmtypes")
    monkeypatch.setenv("PYTHONPATH", str(folder))
    return folder


def test_an_old_recording_replays_byte_for_byte(folder: Path) -> None:
    assert "equal: 519 messages" in replayed(folder)
    assert "equal: " in replayed(folder, "--only", "a/watcher", "--only", "a/reader")


@pytest.mark.slow
def test_a_changed_component_differs_from_an_old_recording(folder: Path) -> None:
    source = folder / "workshop.py"
    source.write_text(source.read_text().replace("self.reading.value.gain = self.config.gain", "pass"))
    assert "a/reading: tick 1, stage 1" in replayed(folder, "--only", "a/meter", code=1)


def test_an_old_recording_holds_the_events_of_today() -> None:
    recording = Recording(OLD / "log.lcm")
    ticks = list(recording.ticks())
    assert (recording.version, len(ticks)) == (1, TICKS)
    counts = Counter(type(event) for tick in ticks for event in tick.events)
    assert counts[TickTold] == TICKS
    assert counts[StageDone] > counts[StageBegun] > 3 * TICKS
    assert counts[IterationDone] > TICKS
    assert counts[OutsideTaken] == 1
    assert counts[HostStarted] == 8 + 2
    assert counts[HostLost] == counts[HostStopped] == counts[FinalDone] == 1
    assert counts[MainLoopGiven] == 2
    assert counts[ChannelsChanged] >= 3
    assert sum(len(tick.record.settings) for tick in ticks) == 1


@pytest.mark.slow
def test_old_recordings_are_listed_and_compared(folder: Path) -> None:
    said = fwk(folder, "log-info", "log.lcm")
    assert "core_v1.tick_record_t" in said
    assert "workshop.reading_t" in said
    listed = json.loads(fwk(folder, "log-info", "log.lcm", "--json"))["channels"]
    assert [name for name, each in listed.items() if each["undecodable"]] == []
    shutil.copy(folder / "log.lcm", folder / "same.lcm")
    assert "equal" in fwk(folder, "compare", "log.lcm", "same.lcm")


def test_a_recorded_plan_may_use_former_names_of_types() -> None:
    recorded = core_v1.plan_t.decode(next(iter(LogReader(OLD / "log.lcm"))).data)
    content = json.loads(recorded.json)
    content["channels"][0]["type_name"] = "robot.frame_t"
    content["outside"] = {"a/picture": "robot.picture_t"}
    old = core_v1.plan_t(json=json.dumps(content))
    plan, version = read_plan(old.encode())
    assert (plan.channels[0].type_name, plan.outside, version) == ("core.frame_t", {"a/picture": "core.picture_t"}, 1)


def test_a_plan_of_a_newer_version_is_refused() -> None:
    content = document_of(Recording(OLD / "log.lcm").plan)
    assert content["version"] == VERSION
    with pytest.raises(
        ValueError, match=f"the plan has version {VERSION + 1}; this program reads versions 1 to {VERSION}"
    ):
        plan_from({**content, "version": VERSION + 1})


@pytest.mark.parametrize("key", ["stages", "components", "channels", "hosts"])
def test_a_damaged_plan_is_refused(key: str) -> None:
    content = document_of(Recording(OLD / "log.lcm").plan)
    with pytest.raises(ValueError, match=key):
        plan_from({**content, key: 7})


def test_a_recording_of_a_newer_version_is_refused(tmp_path: Path) -> None:
    plan = plan_t()
    plan.version, plan.json = protocol_t.VERSION + 1, json.dumps({})
    with LogWriter(tmp_path / "new.lcm", print) as log:
        log.append("fwk/plan", plan.encode(), 0)
    with pytest.raises(RecordingError, match=rf"protocol version {plan.version}; this program reads versions 1 to "):
        Recording(tmp_path / "new.lcm")


def test_the_old_recording_is_small_and_of_version_one() -> None:
    log = OLD / "log.lcm"
    assert log.stat().st_size < 200_000
    assert next(iter(LogReader(log))).channel == "fwk/plan"
