"""A run records the same bytes, whether or not a console watches it."""

import re
from pathlib import Path

import pytest
from playwright.sync_api import expect

from fwk.control.address import supervisor_address
from fwk.control.client import Client, ControlError
from tests.harness.garden import Garden
from tests.harness.logs import Recording
from tests.harness.runs import Launched, PortBlock, write_files

pytestmark = pytest.mark.system

LAUNCH = """
name: lawn
period_s: 0.1
components:
  a/mower: { use: "garden_parts:Mower" }
  a/eye: { use: "garden_parts:Eye" }
  a/watcher: { use: "garden_parts:Watcher" }
  a/probe: { use: "garden_parts:Probe" }
outside: { garden/wish: garden.wish_t, garden/stick: robot.joystick_t }
"""
CHANNELS = ("a/image", "a/place", "a/scan")
PAGES = ("/view", "/", "/board", "/log", "/settings", "/devices")


def record(garden: Garden, ports: PortBlock, file: str) -> Launched:
    arguments = ("lawn.yaml", "--run", f"lawn{ports.bus}", "--record", file, "--ticks", "80", "--seed", "3")
    return Launched(garden.folder, ports, arguments, {})


def asked(port: int, verb: str, **fields: float) -> bool:
    """Sends a request to the run; returns whether it has begun already."""
    try:
        with Client(supervisor_address(port)) as run:
            return bool(run.ask(verb, **fields)["ok"])
    except ControlError:
        return False


def test_a_watched_run_records_the_same_bytes(garden: Garden, tmp_path: Path) -> None:
    with PortBlock() as ports:
        write_files(garden.folder, {"launch/lawn.yaml": f'{LAUNCH}public_url: "{ports.public_url}"\n'})
        pages = {path: garden.browser.open(f"{garden.console.url}{path}?run=lawn{ports.bus}") for path in PAGES}
        for page in pages.values():
            expect(page.locator("[data-name=banner]")).to_contain_text("does not run")
        watched = record(garden, ports, str(tmp_path / "watched.log"))
        watched.until_true(lambda: asked(ports.bus, "pause"), "paused")
        for page in pages.values():
            expect(page.locator("[data-name=state]")).to_have_text("paused")
        pages["/"].get_by_role("button", name="pause or resume").click()
        expect(pages["/view"].locator("canvas")).to_have_attribute("data-frames", re.compile(r"\d\d"))
        assert watched.wait() == 0
        alone = record(garden, ports, str(tmp_path / "alone.log"))
        alone.until_true(lambda: asked(ports.bus, "speed", speed=0.0), "as fast as possible")
        assert alone.wait() == 0
    with_console, without = (Recording(tmp_path / name).messages for name in ("watched.log", "alone.log"))
    assert {channel: len(found) for channel, found in without.items()} == dict.fromkeys(CHANNELS, 80)
    assert with_console == without
