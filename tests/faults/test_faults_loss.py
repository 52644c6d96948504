"""Datagrams get lost, and buffers are far too small: lockstep shows nothing of it."""

import shutil
import subprocess
from pathlib import Path

import pytest

from tests.faults.conftest import RUN, TICKS
from tests.faults.faults_after import Aftermath
from tests.system.conftest import Launch

pytestmark = pytest.mark.system

SMALL = {"FWK_TEST_BUFFER_BYTES": "8192"}


def lossy(share: str) -> tuple[tuple[str, ...], dict[str, str]]:
    """What makes datagrams get lost: a network of its own in the kernel, or the senders where that is not allowed."""
    drop = f"iptables -A INPUT -i lo -p udp -m statistic --mode random --probability {share} -j DROP"
    shell = ("unshare", "-rn", "sh", "-c", f'ip link set lo up && {drop} && exec "$0" "$@"')
    if shutil.which("unshare") and not subprocess.run([*shell, "true"], capture_output=True, check=False).returncode:
        return shell, SMALL
    return (), {"FWK_TEST_LOSS": share, **SMALL}


@pytest.mark.parametrize("share", ["0.05", pytest.param("0.2", marks=pytest.mark.slow)])
def test_lost_datagrams_and_buffers_of_8_kib_change_nothing(
    launch: Launch, traced: Path, undisturbed: Path, after: Aftermath, share: str
) -> None:
    wrapper, env = lossy(share)
    run = launch(*RUN, "--ticks", str(TICKS), env=env, wrapper=wrapper)
    run.until_ticks("f/player", 2)
    after.note(run)
    recording = after.check(run, equal_to=undisturbed, replays=False)
    assert recording.gaps() == {}
    assert "lost 0" in run.text
    assert "fetched" in run.text
