"""A headless browser for tests of the console: the Chromium of the machine, driven with real clicks."""

import os
import signal
import subprocess
from functools import partial
from pathlib import Path
from typing import Self

from playwright.sync_api import Browser, BrowserContext, Page, Playwright, expect, sync_playwright

from fwk.host.process import die_with_parent
from tests.harness.commands import BIN
from tests.harness.runs import pause

CHROMIUM = "chromium-headless-shell"
_WAIT_MS = 60_000.0


class Console:
    """One `fwk web` process; its first line of output names the address."""

    def __init__(self, folder: Path, *words: str, python_path: str = "") -> None:
        self._output = folder / f"console-{len(list(folder.glob('console-*')))}.txt"
        environment = {**os.environ, "HOME": str(folder), "PYTHONPATH": python_path, "PYTHONUNBUFFERED": "1"}
        with open(self._output, "wb") as output:
            self.process = subprocess.Popen(
                [str(BIN / "fwk"), "web", "--port", "0", "--normal-priority", *words],
                cwd=folder,
                env=environment,
                stdout=output,
                stderr=subprocess.STDOUT,
                preexec_fn=partial(die_with_parent, os.getpid(), signal.SIGTERM),
            )
        while self.process.poll() is None and "console (" not in self.text:
            pause()
        assert "console (" in self.text, self.text

    @property
    def text(self) -> str:
        """Returns the output so far."""
        return self._output.read_text(errors="replace")

    @property
    def url(self) -> str:
        """Returns the first link, without a slash at its end."""
        return self.text.split(": ", 1)[1].split("\n", 1)[0].rstrip("/")

    def end(self) -> int:
        """Ends it as Ctrl-C does; returns the exit code."""
        self.process.send_signal(signal.SIGINT)
        try:
            return self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise


class Chromium:
    """The browser; pages note requests to other machines and mistakes of scripts."""

    def __init__(self, program: str) -> None:
        self._playwright: Playwright = sync_playwright().start()
        self.browser: Browser = self._playwright.chromium.launch(executable_path=program, args=["--no-sandbox"])
        expect.set_options(timeout=_WAIT_MS)
        self._looks: dict[tuple[int, int, str], BrowserContext] = {}
        self.outside: list[str] = []
        self.mistakes: list[str] = []

    def open(
        self, url: str, width_px: int = 1280, height_px: int = 800, scheme: str = "light", own: bool = False
    ) -> Page:
        """Opens a page; pages of one look share cache and cookies, unless the page gets a browser of its `own`."""
        look = (width_px, height_px, scheme)
        context = self._looks.get(look) if not own else None
        if context is None:
            context = self._new_context(*look)
            if not own:
                self._looks[look] = context
        page = context.new_page()
        page.set_default_timeout(_WAIT_MS)
        host = url.split("/")[2]
        page.on("request", lambda request: self._note(request.url, host))
        page.on("pageerror", lambda error: self.mistakes.append(str(error)))
        page.goto(url)
        return page

    def _new_context(self, width_px: int, height_px: int, scheme: str) -> BrowserContext:
        return self.browser.new_context(
            viewport={"width": width_px, "height": height_px},
            color_scheme="dark" if scheme == "dark" else "light",
            ignore_https_errors=True,
            reduced_motion="reduce",  # menus that open at once, also on a busy machine
        )

    def _note(self, url: str, own: str) -> None:
        if not url.startswith(("data:", "blob:")) and own not in url:
            self.outside.append(url)

    def close_pages(self) -> None:
        """Closes all pages."""
        for context in self.browser.contexts:
            if context not in self._looks.values():
                context.close()
                continue
            for page in context.pages:
                page.close()

    def close(self) -> None:
        """Ends the browser."""
        self.browser.close()
        self._playwright.stop()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
