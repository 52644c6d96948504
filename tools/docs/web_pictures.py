"""Takes the pictures of the console for the documentation: real pages of a real match, in a headless Chromium.

`make web-pictures` plays a short match, serves the console and calls this program.
"""

import argparse
import shutil
import socket
from contextlib import suppress
from pathlib import Path
from urllib.parse import urlsplit

from playwright.sync_api import Browser, Page, sync_playwright

from fwk.clock import monotonic_us, sleep_s
from fwk.program import BAD_INPUT, FAILED, complain

PROGRAM = "chromium-headless-shell"
PICTURES = {
    "web-view": "/view",
    "web-system": "/",
    "web-devices": "/devices?channel=cyan1/image",
    "web-phone": "/view",
}
"""Name of a picture to the page that it shows."""
_PORTS = {"http": 80, "https": 443}
_WAIT_MS = 60_000.0
_SETTLED_MS = 4_000.0
"""From the first figures of a page to all of it."""


def main() -> None:
    """Writes the pictures into a folder."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("url", type=page_url, help="address of the console, such as http://127.0.0.1:8460")
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


def page_url(text: str) -> str:
    """Returns the address of a page.

    Raises:
        ArgumentTypeError: the text is none.
    """
    with suppress(ValueError):  # of an impossible port
        address = urlsplit(text)
        if address.scheme in ("http", "https") and address.hostname and address.port != 0:
            return text
    raise argparse.ArgumentTypeError(f"'{text}' is not the address of a page, such as http://127.0.0.1:8460")


def wait_for(url: str, longest_s: float = _WAIT_MS / 1000) -> None:
    """Waits until a server listens at the address of a page.

    Raises:
        SystemExit: the machine cannot be reached, or no server listens for so long; the error says which.
    """
    address = urlsplit(url)
    end_us = monotonic_us() + round(longest_s * 1e6)
    while True:
        try:
            port = address.port or _PORTS[address.scheme]
            socket.create_connection((str(address.hostname), port), longest_s).close()
            return
        except ConnectionRefusedError:
            if monotonic_us() > end_us:
                complain(f"no server listens at {url} for {longest_s:g} s; start the one whose page is shown")
                raise SystemExit(FAILED) from None
            sleep_s(0.1)
        except (OSError, UnicodeError) as error:
            complain(f"{url} cannot be reached: {error}")
            raise SystemExit(BAD_INPUT) from None


def _settle(page: Page, settled_ms: float) -> None:
    """Waits until the page shows the run."""
    page.wait_for_function("document.querySelector('[data-name=clock]').innerText.startsWith('tick')")
    if page.url.partition("?")[0].endswith("/view"):
        page.wait_for_function("document.querySelector('canvas')?.dataset.frames > 10")
    page.wait_for_timeout(settled_ms)


if __name__ == "__main__":
    main()
