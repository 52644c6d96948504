"""A watched run records the same bytes; recordings are verified, branched and compared by clicks."""

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
        assert watched.wait() == 0, watched.text
        alone = record(garden, ports, str(tmp_path / "alone.log"))
        alone.until_true(lambda: asked(ports.bus, "speed", speed=0.0), "as fast as possible")
        assert alone.wait() == 0, alone.text
    with_console, without = (Recording(tmp_path / name).messages for name in ("watched.log", "alone.log"))
    assert {channel: len(found) for channel, found in without.items()} == dict.fromkeys(CHANNELS, 80)
    assert with_console == without


def test_a_recording_is_verified_branched_and_compared_by_clicks(garden: Garden) -> None:
    with PortBlock() as ports:
        write_files(garden.folder, {"launch/lawn.yaml": f'{LAUNCH}public_url: "{ports.public_url}"\n'})
        run = Launched(garden.folder, ports, ("lawn.yaml", "--ticks", "40", "--speed", "max"), {})
        assert run.wait() == 0, run.text
    name = run.run_dir.name
    page = garden.browser.open(f"{garden.console.url}/recordings?log={name}&tick=11")
    expect(page.locator("[data-name=tick]")).to_have_text("tick 11")
    expect(page.locator("[data-name=log] > div").last).to_contain_text("grass")
    page.get_by_role("combobox", name="channel").fill("a/scan")
    page.get_by_role("option", name="a/scan").click()
    fields = page.locator("[data-name=fields] tr")
    expect(fields.filter(has_text="header.tick")).to_contain_text("11")
    output = page.locator("[data-name=output]")
    page.get_by_role("button", name="verify").click()
    expect(output).to_contain_text("equal: 120 messages are byte for byte what was recorded")
    job = page.locator("[data-name=job]")
    expect(job).to_contain_text("done")
    page.get_by_label("settings after the branch").fill("a/mower.radius_m=4")
    page.get_by_role("button", name="branch from this tick").click()
    expect(output).to_contain_text("live from tick 12 to tick 40")
    expect(job).to_have_text(re.compile("--then-live.*done"))
    branch = run.run_dir.name
    assert branch != name
    page.get_by_role("combobox", name="other recording").fill(branch)
    page.get_by_role("option", name=branch).click()
    page.get_by_role("button", name="compare").click()
    expect(page.locator("[data-name=output]")).to_contain_text("different: a/place: tick 12")
