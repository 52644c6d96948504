"""Replay and comparison say first if they do not run what the recorded run ran."""

import json
import os
import subprocess
from pathlib import Path

import pytest

from tests.harness import commands
from tests.harness.commands import BIN
from tests.harness.fixtures import Launch
from tests.harness.runs import TIMEOUT_S, PortBlock, write_files
from tests.programs.dynamic_channels_system import market

pytestmark = pytest.mark.system

KERNEL = "OPENBLAS_CORETYPE"


def done(folder: Path, *words: str, kernel: str = "") -> subprocess.CompletedProcess[str]:
    """Runs a command of `fwk` to its end."""
    env = {**os.environ, "HOME": str(folder), **({KERNEL: kernel} if kernel else {})}
    return commands.run([str(BIN / "fwk"), *words], folder, env, 2 * TIMEOUT_S)


def said(folder: Path, *words: str, kernel: str = "") -> str:
    """Returns what a command writes to its standard error."""
    return done(folder, *words, kernel=kernel).stderr


def test_another_kernel_or_module_is_named_first(tmp_path: Path, ports: PortBlock, launch: Launch) -> None:
    write_files(tmp_path, market(ports.public_url))
    run = launch("market.yaml", "--ticks", "5", "--record", "a.lcm")
    assert run.wait() == 0, run.text
    assert said(tmp_path, "replay", "a.lcm", "--verify") == ""
    text = said(tmp_path, "replay", "a.lcm", "--verify", kernel="Prescott")
    assert text.startswith("a.lcm: the run ran with the BLAS kernel "), text
    code = tmp_path / "traders.py"
    code.write_text(code.read_text() + "\n# changed\n")
    text = said(tmp_path, "replay", "a.lcm", "--verify")
    assert text == f"a.lcm: traders is not the module that ran: {code} was changed\n"
    answer = json.loads(done(tmp_path, "replay", "a.lcm", "--verify", "--json").stdout)
    assert (answer["equal"], answer["notes"]) == (True, [f"traders is not the module that ran: {code} was changed"])
    assert launch("market.yaml", "--ticks", "5", "--record", "b.lcm").wait() == 0
    answer = json.loads(done(tmp_path, "compare", "a.lcm", "b.lcm", "--json").stdout)
    assert answer["equal"]
    (note,) = answer["notes"]
    assert note.startswith(f"traders was not the same module in both runs: {code} with hash ")


def test_compare_names_different_kernels_first(
    tmp_path: Path, ports: PortBlock, launch: Launch, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_files(tmp_path, market(ports.public_url))
    for name, kernel in (("a", "Prescott"), ("b", "Haswell")):
        monkeypatch.setenv(KERNEL, kernel)
        run = launch("market.yaml", "--ticks", "3", "--record", f"{name}.lcm")
        assert run.wait() == 0, run.text
    text = said(tmp_path, "compare", "a.lcm", "b.lcm")
    assert "a.lcm ran with the BLAS kernel " in text, text
