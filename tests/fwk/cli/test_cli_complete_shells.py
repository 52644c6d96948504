"""Completion in real shells: the tab key completes a command line, with and without a run."""

from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path

import pexpect
import pytest

from tests.fwk.cli.cli_processes import PROCS, environment, run, write_files
from tests.harness.runs import PortBlock

TIMEOUT_S = 60
SHELLS = {
    "bash": (["bash", "--norc", "--noprofile", "-i"], 'eval "$(fwk completion bash)"', '{0}() {{ echo "<$*>"; }}'),
    "zsh": (["zsh", "-f", "-i"], 'eval "$(fwk completion zsh)"', '{0}() {{ echo "<$*>" }}'),
    "fish": (
        ["fish", "--no-config", "-i"],
        "set -g fish_autosuggestion_enabled 0; fwk completion fish | source",
        'function {0}; echo "<$argv>"; end',
    ),
}
ALONE = {
    "fwk sto\t": "stop",
    "fwk runs pr\t": "runs prune",
    "fwk check ca\t": "check cards.yaml",
    "fwk check ./launch/ca\t": "check ./launch/cards.yaml",
    "fwk log --lev\twarn\t": "log --level warning",
    "fwk-launch ca\t--hosting si\t": "cards.yaml --hosting single",
}
BESIDE_A_RUN = {
    "fwk restart le\tri\t": "restart left/counter right/counter",
    "fwk bb show left/c\t": "bb show left/count",
    "fwk config set left/counter.la\t7": "config set left/counter.last=7",
    "fwk config get right/counter.la\t": "config get right/counter.last",
    "fwk status --run {name}\t": "status --run {name}-beside",
}


class Shell:
    """Interactive shell with completion, in which `fwk` and `fwk-launch` print their words."""

    def __init__(self, name: str, folder: Path, run_name: str = "") -> None:
        command, setup, words = SHELLS[name]
        env = environment(folder) | {"TERM": "xterm", "PS1": "$ ", "FWK_RUN": run_name, "XDG_CONFIG_HOME": str(folder)}
        options = {"env": env, "cwd": folder, "encoding": "utf-8", "timeout": TIMEOUT_S, "dimensions": (24, 160)}
        self._child = pexpect.spawn(command[0], command[1:], **options)
        for line in (setup, words.format("fwk"), words.format("fwk-launch"), 'echo rea""dy'):
            self._child.sendline(line)
        self._child.expect("ready\r")

    def completed(self, typed: str, wanted: str) -> str:
        """Types words with tab keys, waits after each until the expected text appears, and runs the command."""
        first, *others = typed.split("\t")
        self._child.send(first)
        begun = f"{first} "
        for part in others:
            self._child.send("\t")
            words = begun.split(" ")[:-1]
            added = wanted.split(" ")[len(words) - 2].removeprefix(words[-1]).removesuffix(part)
            self._child.expect_exact(added)
            self._settle()
            self._child.send(part)
            begun = f"{begun[:-1]}{added} {part} "
        self._child.send("\r")
        self._child.expect(r"<([^$*>]*)>\s*[\r\x1b]")
        return str(self._child.match[1])

    def _settle(self) -> None:
        """Reads until the shell has drawn its line."""
        with suppress(pexpect.TIMEOUT):
            while True:
                self._child.read_nonblocking(4096, 0.4)

    def close(self) -> None:
        self._child.close(force=True)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_files(tmp_path, PROCS)
    return tmp_path


@pytest.fixture
def beside(folder: Path, ports: PortBlock) -> Iterator[str]:
    """Name of a run in the background."""
    name = f"cards{ports.bus}-beside"
    command = ["fwk-launch", "cards.yaml", "--run", name, "--bus-port", str(ports.bus), "--detach", "--time", "300"]
    assert run(folder, *command).returncode == 0
    yield name
    run(folder, "fwk", "stop", "--all", "--run", name)


@pytest.mark.slow
@pytest.mark.parametrize("name", SHELLS)
def test_the_tab_key_completes_commands_and_files(folder: Path, needs: Callable[..., None], name: str) -> None:
    needs(name)
    shell = Shell(name, folder)
    assert {typed: shell.completed(typed, wanted) for typed, wanted in ALONE.items()} == ALONE
    shell.close()


@pytest.mark.system
@pytest.mark.parametrize("name", SHELLS)
def test_the_tab_key_completes_names_of_a_run(folder: Path, beside: str, needs: Callable[..., None], name: str) -> None:
    needs(name)
    shell = Shell(name, folder, beside)
    name = beside.removesuffix("-beside")
    wanted = {typed.format(name=name): words.format(name=name) for typed, words in BESIDE_A_RUN.items()}
    assert {typed: shell.completed(typed, words) for typed, words in wanted.items()} == wanted
    shell.close()
