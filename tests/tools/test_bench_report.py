"""Tables, JSON and the generated part of the page."""

from pathlib import Path

import pytest

from tools.bench import report, tables
from tools.bench.environments import CORE
from tools.bench.figures import Run, Runs, Spread
from tools.bench.own import OwnScenario
from tools.bench.record import Record
from tools.bench.registry import Peer
from tools.bench.scenarios import growth, variations

PEERS = [Peer("lcm", "bare LCM", CORE, "lcm-gen", udp=True, bare=True), Peer("unix", "Unix", CORE, "lcm-gen")]


OWN = [
    OwnScenario("100 Hz", "jitter", components=20, period_s=0.01),
    OwnScenario("soccer.yaml", "start", file="soccer.yaml"),
]


def result(*tick_us: float) -> dict[str, object]:
    return {
        "tick_us": list(tick_us),
        "cpu_us": 700.0,
        "switches": 36.4,
        "for_nothing": -0.01,
        "stale": 3,
        "repeated": 0,
        "threads": 17,
        "pss_mb": 59.3,
        "first_tick_s": 0.2,
    }


def runs() -> list[Run]:
    made = []
    for number in range(3):
        made.append(Run(number, "lcm", "N=5", result(1000 + number)))
        made.append(Run(number, "unix", "N=5", result(500 + number)))
        made.append(Run(number, "lcm", "N=5, loss 1 %", result(*[1000.0] * 9, 11000.0)))
    made.append(Run(0, "unix", "N=5, 64 KiB", {"error": "no first tick"}))
    return made


def test_markdown_keeps_its_columns() -> None:
    lines = tables.markdown(["a", "b"], [["x|y", "1"], ["z", "2"]]).splitlines()
    assert lines == ["| a | b |", "| --- | ---: |", "| x\\|y | 1 |", "| z | 2 |"]


def test_milliseconds_have_three_digits_and_the_spread() -> None:
    assert tables.milliseconds(Spread(1520, 480, 17_100, 3)) == "1.52 (0.48-17.1)"
    assert tables.milliseconds(Spread(112_000, 99_900, 250_000, 3)) == "112 (99.9-250)"
    assert tables.milliseconds(None) == "-"


def test_errors_name_no_folder_of_the_machine() -> None:
    said = "spawning `/home/me/fwk/build/bench-peers/python` in `/tmp/bench-b3d36`; \x1b[32mINFO\x1b[0m at /dev/null"
    made = [*runs(), Run(1, "unix", "N=5", {"error": said})]
    written = report.text(Record({}, {}, ["lcm", "unix"], [5], [5], False, made))
    assert (
        "- Unix datagrams, N=5: spawning `.../build/bench-peers/python` in `.../bench-b3d36`; INFO at /dev/null"
        in written
    )


def test_tick_table_gives_the_ratio_to_bare_lcm() -> None:
    table = tables.tick_table(Runs(runs()), PEERS, growth((5,)))
    assert "| bare LCM | 1.00 (1.00-1.00) x1.00 |" in table
    assert "| Unix | 0.50 (0.50-0.50) x0.50 |" in table


def test_under_loss_the_mean_is_quoted_and_failures_are_marked() -> None:
    table = tables.tick_table(Runs(runs()), PEERS, variations((5,)))
    assert "| bare LCM | - | - | 2.00 (2.00-2.00) | - |" in table
    assert "| Unix | - | failed | - | - |" in table


def test_the_cost_table_shows_measured_peers_only() -> None:
    table = tables.cost_table(Runs(runs()), PEERS, growth((5,))[0])
    assert (
        "| bare LCM | 1.00 (1.00-1.00) | 1.00 (1.00-1.00) | 0.70 (0.70-0.70) | 36 | 0 | 3 | 0 | 17 | 59 | 0.20 |"
        in table
    )
    assert len(table.splitlines()) == 4
    assert len(tables.cost_table(Runs(runs()), PEERS, growth((80,))[0]).splitlines()) == 2


def test_tables_of_fwk_alone() -> None:
    measured = Runs(
        [
            Run(0, "fwk", "100 Hz", {"error_us": [*([100.0] * 98), 2000.0, 3000.0]}),
            Run(0, "fwk", "soccer.yaml", {"first_tick_s": 2.5, "pss_mb": 900.2, "processes": 109, "restart_s": 0.3}),
        ]
    )
    assert "| 100 Hz | 0.10 (0.10-0.10) | 2.00 (2.00-2.00) | 3.00 (3.00-3.00) |" in tables.jitter_table(
        measured, OWN[:1]
    )
    expected = "| soccer.yaml | 109 (109-109) | 2.50 (2.50-2.50) | 900 (900-900) | 0.30 (0.30-0.30) |"
    assert expected in tables.start_table(measured, OWN[1:])
    assert "| soccer.yaml | - | - | - | - |" in tables.start_table(Runs([]), OWN[1:])


def record() -> Record:
    return Record({"command": "bench"}, {"Zenoh": "not installed"}, ["lcm", "unix"], [5], [5], True, runs())


def test_the_page_names_missing_and_failed_measurements() -> None:
    page = report.text(record())
    assert "- command: bench" in page
    assert "- Zenoh: not installed" in page
    assert "- Unix datagrams, N=5, 64 KiB: no first tick" in page


def test_insert_replaces_the_generated_part_only(tmp_path: Path) -> None:
    page = tmp_path / "numbers.md"
    page.write_text(f"before\n{report.BEGIN}\nold\n{report.END}\nafter\n")
    report.insert(page, "new")
    report.insert(page, "newer")
    assert page.read_text() == f"before\n{report.BEGIN}\n\nnewer\n\n{report.END}\nafter\n"


@pytest.mark.parametrize("text", ["", f"{report.BEGIN}\n", f"{report.END}\n{report.BEGIN}\n"])
def test_insert_refuses_a_page_without_its_markers(tmp_path: Path, text: str) -> None:
    page = tmp_path / "numbers.md"
    page.write_text(text)
    with pytest.raises(ValueError, match=r"numbers\.md: needs one line"):
        report.insert(page, "new")
    assert page.read_text() == text


def test_a_record_survives_its_file(tmp_path: Path) -> None:
    path = tmp_path / "deep" / "numbers.json"
    record().save(path)
    assert Record.read(path) == record()
