"""The commit that changed what a component writes is found, in a small repository, by the real command."""

import json
import subprocess
from pathlib import Path

import pytest

from fwk.testing.probe import folders_in
from tests.harness.runs import fwk, played

COMPONENT = '''"""Drives on."""

from fwk import Component, Writes
from lcmtypes.robot import odometry_t


class Base(Component):
    stage = "act"
    odometry: Writes[odometry_t]

    def loop(self) -> None:
        self.odometry.value.x_m += 0.1
        self.odometry.write()
'''
VERSIONS = (
    ("Base drives on", "+= 0.1"),
    ("A note is added", "+= 0.1  # ten centimetres"),
    ("Two steps at once", "+= 0.05 * 2"),
    ("A mistake in Python", "+= 0.1 +"),
    ("Base drives faster", "+= 0.2"),
    ("Another note", "+= 0.2  # faster"),
    ("Base slips", "+= 0.2 if self.odometry.value.x_m < 1 else 0.0"),
)


def git(folder: Path, *words: str) -> str:
    identity = ("-c", "user.name=a", "-c", "user.email=a@example.org", "-c", "commit.gpgsign=false")
    return subprocess.run(["git", "-C", folder, *identity, *words], check=True, capture_output=True, text=True).stdout


def files(public_url: str) -> dict[str, str]:
    launch = f'public_url: "{public_url}"\ncomponents:\n  r/base: {{use: "base:Base"}}\n'
    return {"base.py": COMPONENT, "drive.yaml": launch}


@pytest.fixture(scope="module")
def repository(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A repository with a commit a version, of which the first one made the recording `log.lcm`."""
    folder = tmp_path_factory.mktemp("repository")
    played(folder, files, "drive.yaml", "--ticks", "20", "--speed", "max", "--record", "log.lcm")
    git(folder, "init", "--quiet")
    for subject, step in VERSIONS:
        (folder / "base.py").write_text(COMPONENT.replace("+= 0.1", step))
        git(folder, "add", "base.py")
        git(folder, "commit", "--quiet", "--allow-empty", "--message", subject)
    git(folder, "tag", "first", f"HEAD~{len(VERSIONS) - 1}")
    (folder / "base.py").write_text("this is not Python: the user's own files do not count")
    return folder


@pytest.mark.system
def test_the_commit_that_changed_an_output_is_found(repository: Path) -> None:
    said = fwk(repository, "bisect", "log.lcm", "--good", "first", "--bad", "HEAD~1", code=1)
    assert "one of these commits is the first one where 'differs' holds; the others cannot be replayed:" in said
    assert said.count("A mistake in Python") >= 2
    assert said.rstrip().endswith("Base drives faster"), said
    condition = ("--when", "r.odometry.header.tick > 10 and r.odometry.x_m < 1.1", "--json")
    said = fwk(repository, "bisect", "log.lcm", "--good", "HEAD~2", *condition)
    answer = json.JSONDecoder().raw_decode(said[said.index("{") :])[0]
    (commit,) = answer["commits"]
    assert (commit["subject"], commit["tick"]) == ("Base slips", 11)
    assert git(repository, "worktree", "list").count("\n") == 1
    assert git(repository, "log", "-1", "--format=%s").strip() == "Base slips"


@pytest.mark.system
def test_a_search_that_cannot_be_made_is_explained(repository: Path) -> None:
    for words, reason in (
        (["--good", "no-such"], f"error: no commit 'no-such' in {repository}"),
        (
            ["--good", "HEAD~1"],
            "error: --good HEAD~1: the condition holds there too, from tick 1 on: r/odometry: tick 1",
        ),
        (["--good", "HEAD~3", "--when", "r.odometry.y_m >"], "error: --when: 'r.odometry.y_m >': invalid syntax"),
        (["--good", "first", "--when", "r.pose.x_m > 1"], "error: --when: no channel 'r/pose' in the recording"),
        (["--good", "HEAD~3", "--bad", "HEAD"], "error: HEAD~3 cannot be replayed: "),
        (["--good", "first", "--when", "r.odometry.x_m > 9"], "error: --bad HEAD: the condition does not hold there"),
        (["--good", "first", "--repo", "/"], "error: no git repository contains /; name it with --repo"),
    ):
        assert reason in fwk(repository, "bisect", "log.lcm", *words, code=2), reason


def test_folders_of_a_run_are_those_of_the_worktree() -> None:
    found = folders_in(["/home/a/robot/parts", "/usr/lib/other"], Path("/home/a/robot"), Path("/tmp/x/code"))
    assert found == [Path("/tmp/x/code/parts"), Path("/usr/lib/other"), Path("/tmp/x/code")]
