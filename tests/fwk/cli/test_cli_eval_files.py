"""`fwk eval` whose folder holds other things than files, or takes none."""

import errno
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from fwk.testing.campaign import Campaign
from fwk.testing.results import FolderError
from tests.fwk.cli.cli_eval_tools import evaluated

MADE: dict[str, Callable[[Path], None]] = {
    "it is no file": os.mkfifo,
    "it is no file ": lambda path: path.symlink_to("/dev/zero"),
    "it is a link to gone, which does not exist": lambda path: path.symlink_to("gone"),
    "Too many levels of symbolic links": lambda path: path.symlink_to(path.name),
    "Is a directory": Path.mkdir,
}


@pytest.mark.timeout(60)
@pytest.mark.parametrize("name", ["seed-9.json", "code.json", "campaign.json"])
@pytest.mark.parametrize("reason", MADE)
def test_what_is_no_file_is_named_and_not_read(launch: Path, reason: str, name: str) -> None:
    folder = launch.parent / "eval-it"
    folder.mkdir()
    MADE[reason](folder / name)
    code, _, said = evaluated(str(launch), "--seeds", "9")
    cure = "move it away, or choose another folder"
    assert (code, said) == (2, f"error: eval-it/{name} cannot be read: {reason.strip()}; {cure}\n")


@pytest.mark.parametrize(
    ("number", "cure"),
    [
        (errno.ENOSPC, "make room for it there, or choose another folder"),
        (errno.EDQUOT, "make room for it there, or choose another folder"),
        (errno.EACCES, "allow yourself to write there, or choose another folder"),
        (errno.EROFS, "choose another folder"),
        (errno.EIO, "choose another folder"),
    ],
)
def test_cure_fits_what_keeps_a_file_from_being_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int, cure: str
) -> None:
    def fail(*_: object) -> None:
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(Path, "replace", fail)
    with pytest.raises(FolderError) as raised:
        Campaign(tmp_path, {})
    assert str(raised.value) == f"{tmp_path}/campaign.json cannot be written: {os.strerror(number)}; {cure}"


def test_folder_that_cannot_be_made_is_told_with_a_cure(launch: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(folder: Path, **_: object) -> None:
        raise OSError(errno.EACCES, os.strerror(errno.EACCES), str(folder))

    monkeypatch.setattr(Path, "mkdir", fail)
    cure = "allow yourself to write there, or choose another folder"
    assert evaluated("it.yaml", "--out", "x/y")[::2] == (2, f"error: --out x/y: Permission denied; {cure}\n")


def test_folder_that_another_campaign_took_meanwhile_is_named(tmp_path: Path) -> None:
    """Two evaluations begin in the same moment: the folder belongs to one, and the other stores no result in it."""
    first = Campaign(tmp_path, {"file": "it", "time_s": 4.0})
    Campaign(tmp_path, {"file": "it", "time_s": 3.0})
    with pytest.raises(FolderError, match="another campaign: --time is 3 there, 4 here; choose"), first.alone():
        pytest.fail("it would play")
