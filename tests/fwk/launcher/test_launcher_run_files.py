"""Deletion of a run's files is noticed, without a run."""

from pathlib import Path

from fwk.launcher.run_files import RunFiles
from fwk.supervisor.options import RunOptions


def test_a_file_in_the_place_of_the_recording_is_no_recording(tmp_path: Path) -> None:
    record, reports = tmp_path / "log.lcm", []  # type: tuple[Path, list[str]]
    record.write_text("of the run")
    files = RunFiles(RunOptions(tmp_path, record=record), reports.append)
    files.message("", b"", 0)
    assert files.deleted == ""
    (tmp_path / "other").write_text("of another program")
    (tmp_path / "other").rename(record)
    files.close()
    files.close()
    assert files.deleted == f"the recording {record} was deleted during the run"
    assert reports == [f"{files.deleted}; files written there are lost"]
