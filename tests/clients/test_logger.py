"""lcm-logplayer plays recordings of fwk, and the log that lcm-logger makes of them compares equal."""

from pathlib import Path

import pytest

from fwk.lcm.event_log import LogWriter
from fwk.lcm.log_parts import part_path
from fwk.recording.compare import compare
from fwk.recording.log_info import log_info
from tests.clients.bus import Bus
from tests.fwk.recording.recording_made import entries, write
from tests.harness.runs import PortBlock

pytestmark = pytest.mark.system


@pytest.mark.core
def test_lcm_logger_hears_our_log_from_lcm_logplayer(tmp_path: Path, ports: PortBlock) -> None:
    bus, played = Bus(ports.public_url), write(tmp_path / "played", entries(ticks=20))
    with bus.logger(tmp_path / "heard"):
        bus.play(played)
    assert compare(played, tmp_path / "heard") is None
    assert log_info(tmp_path / "heard").channels["cyan1/odometry"].lost == 0


def test_lcm_logplayer_plays_a_part_of_a_recording(tmp_path: Path, ports: PortBlock) -> None:
    bus, played = Bus(ports.public_url), tmp_path / "played"
    with LogWriter(played, pytest.fail) as log:
        for number, each in enumerate(entries(ticks=20)):
            if number == 50:
                log.split()
            log.append(*each)
    with bus.logger(tmp_path / "heard"):
        bus.play(part_path(played, 1))
    assert compare(part_path(played, 1), tmp_path / "heard") is None


def test_compare_names_channels_that_were_not_played(tmp_path: Path, ports: PortBlock) -> None:
    bus, played = Bus(ports.public_url), write(tmp_path / "played", entries(ticks=10))
    with bus.logger(tmp_path / "heard"):
        bus.play(played, "--regexp=cyan1/.*")
    assert "cyan2/odometry: tick 1" in str(compare(played, tmp_path / "heard"))
    assert compare(played, tmp_path / "heard", common=True) is None


def test_a_log_that_was_played_twice_compares_equal(tmp_path: Path, ports: PortBlock) -> None:
    bus, played = Bus(ports.public_url), write(tmp_path / "played", entries(ticks=10))
    with bus.logger(tmp_path / "heard"):
        bus.play(played)
        bus.play(played)
    assert compare(played, tmp_path / "heard") is None
