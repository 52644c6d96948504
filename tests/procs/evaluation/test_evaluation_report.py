"""The report of an evaluation: table for people, spreadsheet and program, and a picture."""

import csv
import json
import subprocess
import sys
from pathlib import Path

import cv2
import pytest

from procs.evaluation.match import measured, report
from procs.evaluation.table import MEASURES

SECONDS = 4.5


@pytest.mark.slow
def test_report_of_two_short_pieces(tmp_path: Path) -> None:
    pieces = [json.loads(json.dumps(measured("soccer-1v1.yaml", SECONDS, seed))) for seed in (1, 2)]
    text = report(pieces, tmp_path)
    with (tmp_path / "table.csv").open() as file:
        rows = {row["name"]: row for row in csv.DictReader(file)}
    plain = {row["name"]: row for row in json.loads((tmp_path / "table.json").read_text())}
    assert rows.keys() == plain.keys()
    assert float(rows["pose, position"]["value"]) == plain["pose, position"]["value"] > 0.0
    assert plain["pose, position"]["low"] <= plain["pose, position"]["value"] <= plain["pose, position"]["high"]
    assert "pose, position" in text
    picture = cv2.imread(str(tmp_path / "measures.png"))
    assert picture is not None
    assert picture.std() > 1.0


def test_piece_without_a_tick_fails() -> None:
    with pytest.raises(ValueError, match=r"^--time 0\.01 is shorter than a tick; it should be 0\.04 s at least$"):
        measured("soccer-truth.yaml", 0.01, 1)


def test_piece_without_a_simulator_says_what_is_missing(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(
        "name: mine\ncomponents: {cyan1/camera: {use: procs.drivers.camera_driver, config: {source: pictures}}}\n"
    )
    with pytest.raises(ValueError, match=r"no component writes world/ground_truth, .* include msl-field\.yaml"):
        measured(str(file), 1.0, 1)


def test_report_without_matplotlib_names_the_line_to_type(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    text = report([{each.name: [] for each in MEASURES}], tmp_path)
    assert text.endswith("no picture: matplotlib is not installed; type: pip install 'fwk[eval]'")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["table.csv", "table.json"]


def test_measures_without_a_value_are_left_out(tmp_path: Path) -> None:
    piece: dict[str, list[float] | list[list[float]]] = {each.name: [] for each in MEASURES}
    piece |= {"ball known": [1.0], "pose jumps": [[0.0, 0.0]]}
    text = report([piece], tmp_path)
    assert [row["name"] for row in json.loads((tmp_path / "table.json").read_text())] == ["ball known"]
    assert "pose jumps" not in text


def test_results_of_former_code_can_be_reported(tmp_path: Path) -> None:
    text = report([{"ball known": [1.0, 0.0], "a measure of last year": [3.0]}], tmp_path)
    assert [row["name"] for row in json.loads((tmp_path / "table.json").read_text())] == ["ball known"]
    assert "last year" not in text


def test_a_match_starts_without_the_drawing_library() -> None:
    program = "import sys, procs.evaluation.match; print('matplotlib' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"
