"""A run of 105 components, a console and a browser, for the tests of the console."""

from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import Locator, Page

from fwk.control.address import gateway_address, supervisor_address
from fwk.control.client import Client
from tests.harness.browser import Chromium, Console
from tests.harness.runs import Launched, PortBlock

ROWS = "tbody:not(.q-virtual-scroll__padding) tr"
"""Rows of a table with content: long tables have others that keep the place of rows out of sight."""


@dataclass
class Garden:
    """The run, the console and the browser."""

    folder: Path
    ports: PortBlock
    run: Launched
    console: Console
    browser: Chromium

    @property
    def name(self) -> str:
        """Returns the name of the run, which no other run on this machine has."""
        return f"garden{self.ports.bus}"

    def open(self, path: str = "/?run=garden", **look: object) -> Page:
        """Opens a page of the console."""
        own = path.replace("run=garden", f"run={self.name}")
        return self.browser.open(f"{self.console.url}{own}", **look)  # type: ignore[arg-type]

    def state(self, component: str) -> str:
        """Returns the state of a component."""
        with Client(supervisor_address(self.ports.bus)) as run:
            (found,) = run.ask("status", names=[component])["components"]
        return str(found["state"])

    def tick(self) -> int:
        """Returns the newest tick."""
        with Client(supervisor_address(self.ports.bus)) as run:
            return int(run.ask("speed")["tick"])

    def place(self) -> tuple[float, float]:
        """Returns the place of the mower."""
        with Client(gateway_address(self.ports.bus)) as run:
            value = run.ask("show", channel="a/place")["value"]
        return value["x_m"], value["y_m"]

    def launch(self) -> None:
        """Starts the run again, under its name."""
        self.run = Launched(self.folder, self.ports, ("garden.yaml", "--run", self.name), {})


def row(page: Page, text: str) -> Locator:
    """Returns the row of a table with a cell of this text."""
    return page.locator(ROWS).filter(has=page.get_by_text(text, exact=True))
