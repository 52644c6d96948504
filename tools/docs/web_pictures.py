"""Takes the pictures of the console for the documentation: real pages of a real match, in a headless Chromium.

`make web-pictures` plays a short match, serves the console and calls this program.
"""

import argparse
import shutil
import socket
from pathlib import Path
from urllib.parse import urlsplit

from playwright.sync_api import Browser, Page, sync_playwright

from fwk.clock import monotonic_us, sleep_s

PROGRAM = "chromium-headless-shell"
PICTURES = {
    "web-view": "/view",
    "web-system": "/",
    "web-devices": "/devices?channel=cyan1/image",
    "web-phone": "/view",
}
"""Name of a picture to the page that it shows."""
_WAIT_MS = 60_000.0
_SETTLED_MS = 4_000.0
"""From the first figures of a page to all of it."""


def main() -> None:
    """Writes the pictures into a folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("url", help="address of the console, such as http://127.0.0.1:8460")
    parser.add_argument("run", help="name of the run")
    parser.add_argument("--out", type=Path, default=Path(__file__).parents[2] / "docs", help="folder of the pictures")
    arguments = parser.parse_args()
    program = shutil.which(PROGRAM)
    if program is None:
        raise SystemExit(f"needs {PROGRAM}: apt install {PROGRAM}")
    url = arguments.url.rstrip("/")
    wait_for(url)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        for path in take(browser, url, arguments.run, arguments.out):
            print(path)
        browser.close()


def take(browser: Browser, url: str, run: str, out: Path, settled_ms: float = _SETTLED_MS) -> list[Path]:
    """Writes a picture of each page, so long after its first figures, and returns their paths."""
    made = []
    for name, path in PICTURES.items():
        phone = name.endswith("-phone")
        context = browser.new_context(
            viewport={"width": 390, "height": 760} if phone else {"width": 1280, "height": 800},
            color_scheme="dark" if phone else "light",
        )
        page = context.new_page()
        page.set_default_timeout(_WAIT_MS)
        page.goto(f"{url}{path}{'&' if '?' in path else '?'}run={run}")
        _settle(page, settled_ms)
        made.append(out / f"{name}.png")
        page.screenshot(path=made[-1])
        context.close()
    return made


def wait_for(url: str) -> None:
    """Waits until a server listens at the address of a page."""
    address = urlsplit(url)
    end_us = monotonic_us() + round(_WAIT_MS * 1000)
    while True:
        try:
            socket.create_connection((str(address.hostname), address.port or 80)).close()
            return
        except ConnectionRefusedError:
            if monotonic_us() > end_us:
                raise
            sleep_s(0.1)


def _settle(page: Page, settled_ms: float) -> None:
    """Waits until the page shows the run."""
    page.wait_for_function("document.querySelector('[data-name=clock]').innerText.startsWith('tick')")
    if page.url.partition("?")[0].endswith("/view"):
        page.wait_for_function("document.querySelector('canvas')?.dataset.frames > 10")
    page.wait_for_timeout(settled_ms)


if __name__ == "__main__":
    main()
