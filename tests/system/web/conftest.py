"""Fixture of the tests of the console."""

import shutil
from collections.abc import Callable, Iterator
from typing import NoReturn

import pytest

from fwk.control.address import supervisor_address
from fwk.control.client import Client
from tests.harness.browser import CHROMIUM, Chromium, Console
from tests.harness.garden import Garden
from tests.harness.runs import Launched, PortBlock, write_files
from tests.programs.garden_system import garden_system


@pytest.fixture(scope="package")
def shared_garden(tmp_path_factory: pytest.TempPathFactory, leave_out: Callable[[str], NoReturn]) -> Iterator[Garden]:
    """A run, a console and a browser that the tests of this folder share; later tests may use event loops again."""
    program = shutil.which(CHROMIUM)
    if not program:
        leave_out(f"needs {CHROMIUM}: apt install {CHROMIUM}")
    folder = tmp_path_factory.mktemp("garden")
    with PortBlock(2) as ports, Chromium(program) as browser:
        write_files(folder, garden_system(ports.public_url))
        name = f"garden{ports.bus}"
        run = Launched(folder, ports, ("garden.yaml", "--run", name), {})
        console = Console(folder, "--view", "garden_web", "--run", name)
        made = Garden(folder, ports, run, console, browser)
        yield made
        assert browser.outside == []
        assert browser.mistakes == []
        assert console.end() == 0, console.text
        made.run.end()
        assert "Traceback" not in console.text


@pytest.fixture
def garden(shared_garden: Garden) -> Iterator[Garden]:
    """The shared run; closes the pages of a test, and resumes the run that it may have paused."""
    yield shared_garden
    shared_garden.browser.close_pages()
    with Client(supervisor_address(shared_garden.ports.bus)) as run:
        run.ask("resume")
