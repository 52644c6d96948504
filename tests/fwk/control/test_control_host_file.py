"""Settings are kept whole or not at all, whatever happens to the disk or the process."""

import os
import resource
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from fwk.clock import sleep_s
from fwk.control.host_file import KeepError, Kept, forget, keep
from fwk.control.yaml_edit import read

OLD = "# mine\nconfig:\n  a/b:\n    gain: 1  # why\n"


def test_values_are_kept_as_typed(tmp_path: Path) -> None:
    file = tmp_path / "soccer.host.yaml"
    keep(file, [Kept.of("a/b.gain=0.5"), Kept.of("*/c.inner.names=[x, y]")])
    keep(file, [Kept.of("a/b.gain=0.7")])
    assert read(file.read_text()) == {"config": {"a/b": {"gain": 0.7}, "*/c": {"inner": {"names": ["x", "y"]}}}}


def test_comments_mode_and_links_stay(tmp_path: Path) -> None:
    real, file = tmp_path / "real.yaml", tmp_path / "soccer.host.yaml"
    real.write_text(OLD)
    real.chmod(0o640)
    file.symlink_to(real)
    keep(file, [Kept.of("a/b.gain=2")])
    assert real.read_text() == OLD.replace("gain: 1", "gain: 2")
    assert real.stat().st_mode & 0o777 == 0o640
    assert file.is_symlink()


def test_kept_settings_are_forgotten_all_or_nothing(tmp_path: Path) -> None:
    file = tmp_path / "soccer.host.yaml"
    file.write_text(OLD)
    keep(file, [Kept.of("a/b.other=2"), Kept.of("*/c.inner.deep=3")])
    with pytest.raises(KeepError, match=r"soccer\.host\.yaml: there is no 'a/b\.nonsense'"):
        forget(file, ["a/b.other", "a/b.nonsense"])
    assert read(file.read_text())["config"]["a/b"] == {"gain": 1, "other": 2}
    forget(file, ["a/b.other", "*/c.inner.deep"])
    assert file.read_text() == OLD


def test_a_file_whose_last_setting_is_forgotten_is_removed(tmp_path: Path) -> None:
    file = tmp_path / "a.host.yaml"
    keep(file, [Kept("a/b", "gain", 0.5)])
    forget(file, ["a/b.gain"])
    assert list(tmp_path.iterdir()) == []
    file.write_text("# mine\nconfig: {a/b: {gain: 1}}\n")
    forget(file, ["a/b.gain"])
    assert file.read_text() == "# mine\n"


def test_a_file_of_one_tab_counts_as_empty(tmp_path: Path) -> None:
    file = tmp_path / "soccer.host.yaml"
    file.write_text("\t")
    keep(file, [Kept.of("a/b.gain=1")])
    assert read(file.read_text()) == {"config": {"a/b": {"gain": 1}}}


def test_a_full_disk_leaves_the_old_file(tmp_path: Path) -> None:
    file = tmp_path / "soccer.host.yaml"
    file.write_text(OLD)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (10, limits[1]))
    try:
        with pytest.raises(KeepError, match=r"soccer\.host\.yaml: cannot be written: File too large; it is unchanged"):
            keep(file, [Kept.of("a/b.other=12345678")])
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert file.read_text() == OLD
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.timeout(60)
@pytest.mark.parametrize("linked", [False, True])
def test_what_is_no_ordinary_file_is_neither_read_nor_replaced(tmp_path: Path, linked: bool) -> None:
    pipe, file = tmp_path / "pipe", tmp_path / "soccer.host.yaml"
    os.mkfifo(pipe if linked else file)
    if linked:
        file.symlink_to(pipe)
    with pytest.raises(KeepError, match="it is not an ordinary file; move it away"):
        keep(file, [Kept.of("a/b.gain=1")])
    with pytest.raises(KeepError, match="it is not an ordinary file; move it away"):
        forget(file, ["a/b.gain"])
    assert file.is_fifo()


def test_a_missing_folder_is_named(tmp_path: Path) -> None:
    with pytest.raises(KeepError, match="No such file or directory"):
        keep(tmp_path / "gone" / "soccer.host.yaml", [Kept.of("a/b.gain=1")])


def test_the_later_of_two_equal_keys_wins_and_is_named(tmp_path: Path) -> None:
    file = tmp_path / "soccer.host.yaml"
    file.write_text('config:\n  a/b: {gain: 1}\n  "*/b": {gain: 3}\n')
    with pytest.raises(KeepError, match=r"'\*/b' further down sets 3 for 'gain' and wins"):
        keep(file, [Kept.of("a/b.gain=2")])
    assert "{gain: 1}" in file.read_text()


WRITER = """
import itertools, sys
from pathlib import Path
from fwk.control.host_file import Kept, keep
for number in itertools.count(1):
    keep(Path(sys.argv[1]), [Kept("a/b", "gain", number), Kept("a/b", "twice", 2 * number)])
    print(number, flush=True)
"""


def test_kill_9_loses_nothing_that_was_acknowledged(tmp_path: Path) -> None:
    file = tmp_path / "soccer.host.yaml"
    file.write_text(OLD)
    for delay_s in (0.0, 0.003, 0.011):
        with subprocess.Popen([sys.executable, "-c", WRITER, str(file)], stdout=subprocess.PIPE, text=True) as writer:
            assert writer.stdout
            acknowledged = int(writer.stdout.readline())
            sleep_s(delay_s)
            os.kill(writer.pid, signal.SIGKILL)
            acknowledged = max([acknowledged, *map(int, writer.stdout.read().split())])
        kept = read(file.read_text())["config"]["a/b"]
        assert kept["gain"] >= acknowledged
        assert kept["twice"] == 2 * kept["gain"]
    assert file.read_text().startswith("# mine\n")
