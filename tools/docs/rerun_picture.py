"""Takes the picture of `fwk view` in the documentation: Rerun's web page, drawn by a headless Chromium.

`make rerun-picture` records a match and calls this program.
"""

import argparse
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from playwright.sync_api import sync_playwright

from fwk.program import FAILED, complain
from tools.docs.web_pictures import page_url, wait_for

CHROMIUM = "/usr/bin/chromium-headless-shell"
GRAPHICS = ("--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
"""Options of a Chromium that draws in three dimensions without a graphics card."""
_WIDTH_PX, _HEIGHT_PX = 1200, 750
_LOOKS = 12
_WAIT_MS = 120_000.0


def main() -> None:
    """Writes docs/rerun.png."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("url", type=page_url, help="the address that 'fwk view --web' prints")
    arguments = parser.parse_args()
    if not Path(CHROMIUM).exists():
        complain(f"there is no {CHROMIUM}; type: apt install {Path(CHROMIUM).name}")
        raise SystemExit(FAILED)
    wait_for(arguments.url)
    picture = picture_of(arguments.url, b"\x30\x80\x3c")
    cv2.imwrite(str(Path(__file__).parents[2] / "docs" / "rerun.png"), picture)


def picture_of(url: str, colour: bytes, share: float = 0.02) -> NDArray[np.uint8]:
    """Returns a picture of the page once a colour fills a share of it; the last picture, if it never does.

    Args:
        url: the page.
        colour: red, green and blue of what is waited for.
        share: least share of all pixels.

    Returns:
        height x width x 3: blue, green, red.
    """
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=list(GRAPHICS))
        page = browser.new_page(viewport={"width": _WIDTH_PX, "height": _HEIGHT_PX})
        page.goto(url, timeout=_WAIT_MS)
        for _ in range(_LOOKS):
            data = page.screenshot(timeout=_WAIT_MS)
            picture = np.asarray(cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR), np.uint8)
            if share_of(picture, colour) >= share:
                break
            page.wait_for_timeout(2000)
        browser.close()
    return picture


def share_of(picture: NDArray[np.uint8], colour: bytes) -> float:
    """Returns the share of the pixels that have about this colour."""
    away = np.abs(picture[:, :, ::-1].astype(int) - np.frombuffer(colour, np.uint8)).max(axis=2)
    return float((away < 24).mean())


if __name__ == "__main__":
    main()
