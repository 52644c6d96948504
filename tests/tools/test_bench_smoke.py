"""Two components of fwk, and of the peers without dependencies, in real processes."""

from collections.abc import Callable
from pathlib import Path

import pytest

from fwk.lcm.typegen import generate
from tools.bench import fwk_launch_file, rotation
from tools.bench.own import OwnScenario
from tools.bench.registry import PEERS
from tools.bench.scenarios import Scenario
from tools.bench.shape import Shape

pytestmark = pytest.mark.system


@pytest.fixture(scope="module", autouse=True)
def _types() -> None:
    generate(Path(rotation.__file__).parent / "messages" / "lcmtypes")


@pytest.mark.parametrize(
    ("name", "padding_bytes"),
    [
        ("unix", 100_000),
        ("lcm", 100_000),
        ("lcm_wire", 100_000),  # without padding: below
        ("fwk", 0),
        ("fwk_recorded", 100_000),
    ],
)
def test_a_peer_does_the_work(name: str, padding_bytes: int) -> None:
    scenario = Scenario("two", Shape(2, padding_bytes=padding_bytes))
    runs = rotation.rotate([PEERS[name]], [scenario], 1, 0.2, lambda _: None)
    result = runs[0].result
    assert "error" not in result
    assert len(result["tick_us"]) >= 1
    assert all(tick > 0 for tick in result["tick_us"])
    assert result["stale"] is not None  # both components ended by themselves and left their count
    if name != "lcm":  # liblcm delivers messages in a thread; for the others, messages sent before the tick are there
        assert result["stale"] == 0
    assert result["cpu_us"] > 0
    assert result["switches"] > 0
    assert result["pss_mb"] > 5
    assert 0 < result["first_tick_s"] < 50


def test_plain_sockets_read_exactly_their_channels(leave_out: Callable[[str], None]) -> None:
    if not rotation.isolation():
        leave_out("needs a network namespace, so that nobody else's datagrams are counted: run as root")
    runs = rotation.rotate([PEERS["lcm_wire"]], [Scenario("five", Shape(5))], 1, 0.2, lambda _: None)
    result = runs[0].result
    repeated = result["repeated"] / len(result["tick_us"])  # on a busy machine: a tick and a done each
    assert -0.2 < result["for_nothing"] < 2 * repeated + 0.2
    assert result["stale"] == 0


def test_real_time_gives_an_error_for_every_period() -> None:
    scenario = OwnScenario("fast", "jitter", components=2, stages=1, period_s=0.005)
    result = rotation.rotate_own([scenario], 1, 0.5, lambda _: None)[0].result
    assert "error" not in result
    assert 1 <= len(result["error_us"]) < 120
    assert all(error >= 0 for error in result["error_us"])


def test_a_run_is_watched_from_its_start_to_a_restart(tmp_path: Path) -> None:
    shape = Shape(2, folder=str(tmp_path))
    file = fwk_launch_file.write(shape, shape.save())
    result = rotation.rotate_own([OwnScenario("small", "start", file=file)], 1, 1.0, lambda _: None)[0].result
    assert "error" not in result
    assert result["processes"] >= 2 + 4  # components; launcher, zygote, gateway, display
    assert result["first_tick_s"] > 0
    assert result["restart_s"] > 0
    assert result["pss_mb"] > 20
