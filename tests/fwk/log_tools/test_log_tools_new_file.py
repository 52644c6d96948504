"""New files of tools."""

import os
from pathlib import Path

import pytest

from fwk.lcm.event_log import LogError
from fwk.log_tools.new_file import new_file


@pytest.mark.parametrize("replace", [False, True])
@pytest.mark.parametrize("linked", [False, True])
def test_pipe_or_device_is_never_replaced(tmp_path: Path, replace: bool, linked: bool) -> None:
    pipe, path = tmp_path / "pipe", tmp_path / "table.csv"
    os.mkfifo(pipe if linked else path)
    if linked:
        path.symlink_to(pipe)
    refused = pytest.raises(LogError, match=r"table\.csv: not an ordinary file; choose another name")
    with refused, new_file(path, replace) as part:
        part.write_text("a")
    assert path.is_fifo()
    assert path.is_symlink() is linked
    assert not (tmp_path / ".table.csv.part").exists()
