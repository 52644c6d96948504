"""lcm-spy as a real process decodes every channel.

Its window is a Swing table. A Java agent inside the unchanged program reads that table, so the test checks what a
person would see, without analysing pixels. A screenshot shows that the window was drawn.
"""

from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from fwk.lcm.messages import has_header, type_name
from fwk.lcm.type_registry import by_fingerprint
from tests.clients.bus import Bus, wait_until
from tests.clients.lcm_spy import lcm_spy, read_table, screen
from tests.fwk.recording.recording_made import Entry, write
from tests.harness.runs import PortBlock

pytestmark = pytest.mark.system


def one_of_each_type() -> list[Entry]:
    """Returns three messages of each type, on channels such as `every/soccer.pose_t`."""
    ours = {file.stem for file in (Path(__file__).parents[2] / "lcmtypes").glob("*.lcm")}
    types = [kind for kinds in by_fingerprint().values() for kind in kinds if has_header(kind)]
    types = [kind for kind in types if type_name(kind).partition(".")[0] in ours]  # other tests register more types
    return [(f"every/{type_name(kind)}", kind().encode(), 1) for kind in types for _ in range(3)]


def test_lcm_spy_decodes_every_channel(tmp_path: Path, needs: Callable[..., None], ports: PortBlock) -> None:
    needs("java", "javac", "Xvfb")
    bus, made = Bus(ports.public_url), one_of_each_type()
    channels = {channel for channel, _, _ in made}
    with screen() as display, lcm_spy(bus, display, tmp_path) as seen:
        bus.play(write(tmp_path / "log", [*made, ("foreign", b"not a type of ours", 2)]))
        wait_until(lambda: "foreign" in read_table(seen), "lcm-spy does not show what was played")
        table = read_table(seen)
    assert {name for name in table if name.startswith("every/")} == channels
    assert {name: row["Undecodable"] for name, row in table.items() if name in channels} == dict.fromkeys(channels, "0")
    assert {row["Num Msgs"] for name, row in table.items() if name in channels} == {"3"}
    assert table["every/soccer.world_model_t"]["Type"] == "world_model_t"
    assert table["foreign"]["Undecodable"] == "1"
    assert table["foreign"]["Type"].startswith("??")
    window = cv2.imread(str(tmp_path / "seen" / "screen.png"))
    assert window is not None
    assert len(np.unique(window.reshape(-1, 3), axis=0)) > 10
