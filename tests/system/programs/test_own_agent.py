"""The agent on the page about soccer plays from a reader's folder, beside the robots of the project."""

import runpy
from pathlib import Path

import pytest

from fwk.testing import Bench
from lcmtypes.core import answer_t
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.pages import Page
from tests.harness.runs import write_files

pytestmark = pytest.mark.system
PLAYED_S = "12"
"""The kick-off may be taken 6 s after the start; from then on an agent fetches the ball."""


def test_agent_of_the_page_plays(tmp_path: Path, launch: Launch) -> None:
    page = Page("soccer.md")
    assert set(page.files) == {"procs/my_team/agent.py", "my-match.yaml"}
    write_files(tmp_path, page.files)
    arguments = "--time", PLAYED_S, "--speed", "max", "--hosting", "single", "--record", "log.lcm"
    run = launch("my-match.yaml", *arguments)
    assert run.wait() == 0, run.text
    states = Recording(tmp_path / "log.lcm").decoded("magenta1/skill_status")
    assert {"stop", "get_ball"} <= {state.skill for state in states}, "the skiller obeys the reader's agent"


def test_agent_of_the_page_asks_again_after_a_failure(tmp_path: Path) -> None:
    write_files(tmp_path, Page("soccer.md").files)
    agent = runpy.run_path(str(tmp_path / "procs/my_team/agent.py"))
    bench = Bench(agent["MyAgent"], "magenta1/agent")
    for tick in range(3):
        bench.port("world_model").put(localized=True)
        bench.iterate()
        if tick == 0:
            bench.owner_of("skill").answer(answer_t.FAILED, "the ball is unknown")
    assert [command.skill for command in bench.skill.sent] == ["get_ball"] * 2
