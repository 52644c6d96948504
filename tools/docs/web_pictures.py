"""Takes the pictures of the console for the documentation: real pages of a real match, in a headless Chromium.

`make web-pictures` plays a short match, serves the console and calls this program.
"""

import argparse
import shutil
import socket
from pathlib import Path
from urllib.parse import urlsplit

from playwright.sync_api import Page, sync_playwright

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
    for path in take(arguments.url.rstrip("/"), arguments.run, arguments.out):
        print(path)


def take(url: str, run: str, out: Path, pictures: dict[str, str] = PICTURES) -> list[Path]:
    """Writes a picture of each page and returns their paths.

    Raises:
        FileNotFoundError: no Chromium is installed.
    """
    program = shutil.which(PROGRAM)
    if program is None:
        raise FileNotFoundError(f"needs {PROGRAM}: apt install {PROGRAM}")
    wait_for(url)
    made = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        for name, path in pictures.items():
            phone = name.endswith("-phone")
            context = browser.new_context(
                viewport={"width": 390, "height": 760} if phone else {"width": 1280, "height": 800},
                color_scheme="dark" if phone else "light",
            )
            page = context.new_page()
            page.set_default_timeout(_WAIT_MS)
            page.goto(f"{url}{path}{'&' if '?' in path else '?'}run={run}")
            _settle(page)
            made.append(out / f"{name}.png")
            page.screenshot(path=made[-1])
            context.close()
        browser.close()
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


def _settle(page: Page) -> None:
    """Waits until the page shows the run."""
    page.wait_for_function("document.querySelector('[data-name=clock]').innerText.startsWith('tick')")
    if page.url.partition("?")[0].endswith("/view"):
        page.wait_for_function("document.querySelector('canvas')?.dataset.frames > 40")
    page.wait_for_timeout(_SETTLED_MS)


if __name__ == "__main__":
    main()
