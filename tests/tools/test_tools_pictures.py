"""Pictures of the documentation are drawn from recordings."""

import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from fwk.display.view import View
from tests.fwk.cli.cli_runs import MATCH, packet, plan, status
from tests.fwk.recording.recording_made import entries, write
from tools.docs.pictures import display, main, packets


def test_the_display_is_a_picture_without_other_files() -> None:
    view = View(plan())
    view.take(packet("fwk/status", status(MATCH, 77)))
    picture = display(view, "fwk-launch match.yaml")
    text = "".join(ET.fromstring(picture).itertext()).replace("\xa0", " ")
    assert "tick 77" in text
    assert "q quit" in text
    assert "url(http" not in picture


def test_packets_end_with_the_tick_that_was_asked_for(tmp_path: Path) -> None:
    """Whether the next status comes early or late."""
    made = entries(ticks=20, robots=1)
    expected = [channel.encode() + b"\0" + data for channel, data, _ in made[: 9 * 3]]
    for at in (24, 33, 54):
        log = write(tmp_path / f"log{at}", [*made[:at], ("fwk/status", status(MATCH, 15).encode(), 0), *made[at:]])
        assert [*packets(log, 9)] == expected, at


@pytest.mark.parametrize("made", [False, True])
def test_what_is_no_recording_is_named(
    made: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    log = tmp_path / "log.lcm"
    if made:
        log.write_bytes(b"no log")
    monkeypatch.setattr("sys.argv", ["pictures", str(log)])
    with pytest.raises(SystemExit, match="2"):
        main()
    assert str(log) in capsys.readouterr().err
