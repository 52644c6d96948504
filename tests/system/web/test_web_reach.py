"""Browsers of other machines, and browsers that sleep."""

import re
import ssl
import subprocess
import urllib.error
import urllib.request
from pathlib import Path

import pytest
from playwright.sync_api import expect

from fwk.control.address import supervisor_address
from fwk.control.client import Client
from tests.harness.browser import Console
from tests.harness.garden import Garden

pytestmark = pytest.mark.system


def certificate(folder: Path) -> tuple[str, str]:
    """Makes a certificate for localhost; returns the files of certificate and key."""
    files = str(folder / "robot.pem"), str(folder / "robot.key")
    words = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=localhost"]
    words += ["-addext", "subjectAltName=DNS:localhost", "-out", files[0], "-keyout", files[1]]
    subprocess.run(words, check=True, capture_output=True)
    return files


def test_other_addresses_need_tls_and_a_token(garden: Garden, tmp_path: Path) -> None:
    pem, key = certificate(tmp_path)
    words = ("--address", "0.0.0.0", "--name", "localhost", "--certificate", pem, "--key", key)
    console = Console(garden.folder, *words)
    try:
        links = dict(line.removeprefix("console (").split("): ", 1) for line in console.text.splitlines())
        base = links["steer"].partition("?")[0]
        trusting = urllib.request.HTTPSHandler(context=ssl.create_default_context(cafile=pem))
        opener = urllib.request.build_opener(trusting, urllib.request.HTTPCookieProcessor())
        with pytest.raises(urllib.error.HTTPError, match="403"):
            opener.open(base)
        with pytest.raises(OSError, match=r"reset|closed|Empty"):
            urllib.request.urlopen(base.replace("https:", "http:"), timeout=10)
        with opener.open(links["read"]) as answer:
            assert (answer.status, "token" in answer.url) == (200, False)
        with opener.open(f"{base}drawing?run={garden.name}") as answer:
            assert b"shapes" in answer.read()
        reader = garden.browser.open(f"{links['read']}&run={garden.name}", own=True)
        expect(reader.locator("[data-name=state]")).to_have_text("running")
        expect(reader.locator("[data-name=read-only]")).to_be_visible()
        expect(reader.get_by_role("button", name="pause or resume")).to_have_count(0)
        steerer = garden.browser.open(f"{links['steer']}&run={garden.name}", own=True)
        steerer.get_by_role("button", name="pause or resume").click()
        expect(reader.locator("[data-name=state]")).to_have_text("paused")
    finally:
        assert console.end() == 0


def test_a_browser_that_slept_shows_the_run_again(garden: Garden) -> None:
    page = garden.open("/view?run=garden", own=True)
    expect(page.locator("[data-name=state]")).to_have_text("running")
    browser = page.context.new_cdp_session(page)
    browser.send("Page.setWebLifecycleState", {"state": "frozen"})
    page.context.set_offline(True)
    with Client(supervisor_address(garden.ports.bus)) as run:
        tick = run.ask("pause")["tick"]
    page.context.set_offline(False)
    browser.send("Page.setWebLifecycleState", {"state": "active"})
    expect(page.locator("[data-name=state]")).to_have_text("paused")
    expect(page.locator("[data-name=clock]")).to_contain_text(f"tick {tick} ")
    frames = int(page.locator("canvas").get_attribute("data-frames") or 0)
    page.wait_for_function(f"() => Number(document.querySelector('canvas').dataset.frames) > {frames}")


UNCHANGED = """() => {
    const clock = document.querySelector('[data-name=clock]').innerText;
    if (clock !== window.before) [window.before, window.since] = [clock, performance.now()];
    return clock.startsWith('tick') && performance.now() > window.since + 2500;
}"""
"""Whether the clock of a page has stood still."""


def test_a_page_that_is_opened_behind_others_asks_nothing(garden: Garden) -> None:
    context = garden.browser.browser.new_context()
    context.add_init_script("window.behind = true; Object.defineProperty(document, 'hidden', { get: () => behind })")
    page = context.new_page()
    page.goto(f"{garden.console.url}/view?run={garden.name}")
    page.wait_for_function(UNCHANGED)
    before = page.locator("[data-name=clock]").inner_text()
    assert page.locator("canvas").get_attribute("data-frames") is None
    page.evaluate("window.behind = false; document.dispatchEvent(new Event('visibilitychange'))")
    expect(page.locator("[data-name=clock]")).not_to_have_text(before)
    expect(page.locator("canvas")).to_have_attribute("data-frames", re.compile(r"\d"))
    context.close()
