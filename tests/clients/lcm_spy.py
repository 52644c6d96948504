"""lcm-spy on a virtual screen, and the table that its window shows."""

import atexit
import csv
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from zipfile import ZipFile

from tests.clients.bus import Bus, process

FWK_SPY = "import typer; from fwk.cli.look.spy import spy; typer.run(spy)"
_SHORT = "-XX:TieredStopAtLevel=1 -XX:+UseSerialGC"
"""Options of Java with which a program that ends soon uses less processor time."""
Table = dict[str, dict[str, str]]
"""Rows of the window by channel."""


@contextmanager
def screen() -> Iterator[str]:
    """Starts a virtual screen; its name is the value of DISPLAY."""
    with process(["Xvfb", "-displayfd", "1", "-screen", "0", "1024x768x24", "-nolisten", "tcp"]) as server:
        assert server.stdout
        number = next(line.strip() for line in server.stdout if line.strip().isdigit())  # another process may be faster
        yield f":{number}"


@contextmanager
def lcm_spy(bus: Bus, display: str, folder: Path) -> Iterator[Path]:
    """Starts lcm-spy and waits until it listens; returns the folder for `read_table`."""
    (folder / "seen").mkdir()
    environment = {
        **os.environ,
        "DISPLAY": display,
        "XDG_CACHE_HOME": str(_workshop() / "cache"),
        "LCM_JVM_OPT": f"-Xmx256m {_SHORT} -javaagent:{_agent()}={folder / 'seen'}",
    }
    with process([sys.executable, "-c", FWK_SPY, "--url", bus.url], environment):
        bus.publish_until(lambda: "fwk/probe" in read_table(folder / "seen"))
        yield folder / "seen"


def read_table(folder: Path) -> Table:
    """Returns the newest table that the window shows."""
    path = folder / "table.tsv"
    if not path.exists():
        return {}
    with open(path, newline="") as file:
        return {row["Channel"]: row for row in csv.DictReader(file, delimiter="\t")}


@cache
def _workshop() -> Path:
    """Returns a folder for what all tests of a process need to build only once."""
    folder = Path(tempfile.mkdtemp(prefix="lcm-spy-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


@cache
def _agent() -> Path:
    folder = _workshop() / "agent"
    folder.mkdir()
    source = Path(__file__).with_name("SpyTable.java")
    subprocess.run(["javac", *(f"-J{option}" for option in _SHORT.split()), "-d", folder, source], check=True)
    with ZipFile(folder / "agent.jar", "w") as jar:
        jar.writestr("META-INF/MANIFEST.MF", "Premain-Class: SpyTable\n")
        for each in folder.glob("*.class"):
            jar.write(each, each.name)
    return folder / "agent.jar"
