"""lcm-spy, really started, decodes every channel.

Its window is a Swing table, so a Java agent inside the unchanged program reads that table: what is checked is what a
person would see, without guessing from pixels. A screenshot shows that the window was drawn.
"""

import csv
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest

from fwk.lcm.messages import has_header, type_name
from fwk.lcm.type_registry import by_fingerprint
from tests.clients.bus import Bus, process, wait_until
from tests.fwk.recording.recording_made import Entry, write
from tests.harness.runs import PortBlock

pytestmark = pytest.mark.system
FWK_SPY = "import typer; from fwk.cli.look.spy import spy; typer.run(spy)"
Table = dict[str, dict[str, str]]


def one_of_each_type() -> list[Entry]:
    """Channel `every/soccer.pose_t` and so on, three messages each."""
    ours = {file.stem for file in (Path(__file__).parents[2] / "lcmtypes").glob("*.lcm")}
    types = [kind for kinds in by_fingerprint().values() for kind in kinds if has_header(kind)]
    types = [kind for kind in types if type_name(kind).partition(".")[0] in ours]  # other tests know more types
    return [(f"every/{type_name(kind)}", kind().encode(), 1) for kind in types for _ in range(3)]


@pytest.fixture
def display(needs: Callable[..., None]) -> Iterator[str]:
    """A screen that nobody looks at."""
    needs("Xvfb")
    with process(["Xvfb", "-displayfd", "1", "-screen", "0", "1024x768x24", "-nolisten", "tcp"]) as server:
        assert server.stdout
        number = next(line.strip() for line in server.stdout if line.strip().isdigit())  # others may take one before it
        yield f":{number}"


def build_agent(folder: Path) -> Path:
    source = Path(__file__).with_name("SpyTable.java")
    subprocess.run(["javac", "-d", folder, source], check=True)
    (folder / "manifest").write_text("Premain-Class: SpyTable\n")
    subprocess.run(["jar", "cfm", folder / "agent.jar", folder / "manifest", "-C", folder, "."], check=True)
    return folder / "agent.jar"


def read_table(folder: Path) -> Table:
    path = folder / "table.tsv"
    if not path.exists():
        return {}
    with open(path, newline="") as file:
        return {row["Channel"]: row for row in csv.DictReader(file, delimiter="\t")}


def test_lcm_spy_decodes_every_channel(
    tmp_path: Path, needs: Callable[..., None], display: str, ports: PortBlock
) -> None:
    needs("java", "javac", "jar")
    bus, made = Bus(ports.public_url), one_of_each_type()
    channels = {channel for channel, _, _ in made}
    (tmp_path / "seen").mkdir()
    (tmp_path / "agent").mkdir()
    environment = {
        **os.environ,
        "DISPLAY": display,
        "XDG_CACHE_HOME": str(tmp_path / "cache"),
        "LCM_JVM_OPT": f"-Xmx256m -javaagent:{build_agent(tmp_path / 'agent')}={tmp_path / 'seen'}",
    }
    with process([sys.executable, "-c", FWK_SPY, "--url", bus.url], environment):
        bus.publish_until(lambda: "fwk/probe" in read_table(tmp_path / "seen"))
        bus.play(write(tmp_path / "log", [*made, ("foreign", b"no type of ours", 2)]))
        wait_until(lambda: "foreign" in read_table(tmp_path / "seen"), "lcm-spy does not show what was played")
        table = read_table(tmp_path / "seen")
    assert {name for name in table if name.startswith("every/")} == channels
    assert {name: row["Undecodable"] for name, row in table.items() if name in channels} == dict.fromkeys(channels, "0")
    assert {row["Num Msgs"] for name, row in table.items() if name in channels} == {"3"}
    assert table["every/soccer.world_model_t"]["Type"] == "world_model_t"
    assert table["foreign"]["Undecodable"] == "1"
    assert table["foreign"]["Type"].startswith("??")
    screen = cv2.imread(str(tmp_path / "seen" / "screen.png"))
    assert screen is not None
    assert len(np.unique(screen.reshape(-1, 3), axis=0)) > 10
