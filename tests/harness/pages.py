"""Pages of the documentation that readers follow word for word: files, commands, outputs."""

import re
from pathlib import Path

DOCS = Path(__file__).parents[2] / "docs"
_FILE = re.compile(r"this as `([^`]+)`:\n\n```\w+\n(.*?)```", re.S)
_CONSOLE = re.compile(r"```console\n(.*?)```", re.S)


class Page:
    """A page with files to save and commands to type."""

    def __init__(self, name: str) -> None:
        text = (DOCS / name).read_text()
        self.files: dict[str, str] = dict(_FILE.findall(text))
        """Contents by path."""
        self.steps: list[tuple[str, list[str]]] = []
        """The commands in order, each with its output; `...` stands for any lines."""
        for line in "".join(_CONSOLE.findall(text)).splitlines():
            if line.startswith("$ "):
                self.steps.append((line[2:], []))
            else:
                self.steps[-1][1].append(line)


def shows(output: str, line: str) -> bool:
    """Returns whether a line of a page occurs in the output."""
    wanted = ".*".join(map(re.escape, line.split("...")))
    return any(re.fullmatch(wanted, each) for each in output.splitlines())
