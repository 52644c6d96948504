"""Lost datagrams and tiny buffers leave no trace in lockstep."""

import shutil
import subprocess
from pathlib import Path

import pytest

from tests.faults.aftermath import Aftermath
from tests.faults.conftest import RUN, TICKS, WAITS, until_it_waits
from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording, difference
from tests.harness.runs import PortBlock, write_files

pytestmark = pytest.mark.system

SMALL = {"FWK_TEST_BUFFER_BYTES": "8192"}


def lossy(share: str) -> tuple[tuple[str, ...], dict[str, str]]:
    """Environment that loses datagrams: in the kernel (network namespace), else at the senders."""
    drop = f"iptables -A INPUT -i lo -p udp -m statistic --mode random --probability {share} -j DROP"
    shell = ("unshare", "-rn", "sh", "-c", f'ip link set lo up && {drop} && exec "$0" "$@"')
    if shutil.which("unshare") and not subprocess.run([*shell, "true"], capture_output=True, check=False).returncode:
        return shell, SMALL
    return (), {"FWK_TEST_LOSS": share, **SMALL}


@pytest.mark.parametrize("share", ["0.05", pytest.param("0.2", marks=pytest.mark.slow)])
def test_lost_datagrams_and_tiny_buffers_change_nothing(
    launch: Launch, traced: Path, undisturbed: Path, after: Aftermath, share: str
) -> None:
    wrapper, env = lossy(share)
    run = launch(*RUN, "--ticks", str(TICKS), *WAITS, env=env, wrapper=wrapper)
    until_it_waits(run)
    after.note(run)
    (traced / "go-on").touch()
    recording = after.check(run, equal_to=undisturbed, replays=False)
    assert recording.gaps() == {}
    assert "lost 0" in run.text
    assert "fetched" in run.text


LAUNCH = """
name: restarted
speed: max
public_url: {url}
components:
  r/talker: {{use: "restarted:Talker"}}
  r/listener: {{use: "restarted:Listener"}}
"""


def test_a_leaving_writer_first_answers_all_fetches(launch: Launch, tmp_path: Path, ports: PortBlock) -> None:
    files = {**sources("restarted.py", "weather.py"), "it.yaml": LAUNCH.format(url=ports.public_url)}
    write_files(tmp_path, files)
    for loss in ("0", "0.3"):
        run = launch("it.yaml", "--ticks", "60", "--record", f"{loss}.lcm", env={"FWK_TEST_LOSS": loss})
        assert run.wait() == 0, run.text
        assert "lost 0" in run.text
    assert len(Recording(tmp_path / "0.lcm").messages["r/imu"]) > 80
    assert difference(tmp_path / "0.lcm", tmp_path / "0.3.lcm") == ""
