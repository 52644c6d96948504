"""Python in the documentation compiles, imports what exists, and names modules that exist."""

import ast
import re
from importlib import import_module
from pathlib import Path

import pytest
import yaml

from tests.docs.docs_pages import PAGES, ROOT, Block, blocks, spans, tutorial_files

_MODULE = re.compile(r"(?:fwk|procs|tools)(?:\.\w+)+")
_FILE = re.compile(r"(?:fwk|procs|tests|tools|launch|lcmtypes|docs)(?:/[\w.-]+)+/?")
_CHANNELS_AND_LOGS = re.compile(r"fwk/[a-z_]+|fwk\.log(\.\w+)?")  # `fwk/tick` is a channel, `fwk.log` a text log


def of_language(*languages: str) -> list[Block]:
    return [block for page in PAGES for block in blocks(page) if block.language in languages]


def place(block: Block) -> str:
    return f"{block.page}:{block.line}"


@pytest.mark.parametrize("block", of_language("python"), ids=place)
def test_python_compiles_and_imports_what_exists(block: Block) -> None:
    tree = ast.parse(block.text, place(block))
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[0] == "fwk":
            module = import_module(node.module or "")
            missing = [name.name for name in node.names if not hasattr(module, name.name)]
            assert not missing, f"{place(block)}: {node.module} has no {missing}"


@pytest.mark.parametrize("block", of_language("yaml"), ids=place)
def test_yaml_can_be_read(block: Block) -> None:
    assert yaml.safe_load(block.text) is not None or block.text.startswith("#")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_modules_and_files_in_prose_exist(page: Path) -> None:
    assert not [span for span in spans(page) if not exists(span)]


@pytest.mark.parametrize(
    ("span", "there"),
    [
        ("fwk/clock.py", True),
        ("fwk/clok.py", False),
        ("fwk.clock", True),
        ("fwk.testing.Bench", True),
        ("fwk.testing.Bensh", False),
        ("fwk.nowhere", False),
        ("fwk.h", True),
        ("fwk/tick", True),
        ("lcmtypes/core.lcm", True),
        ("lcmtypes/cor.lcm", False),
    ],
)
def test_a_name_that_does_not_exist_is_noticed(span: str, there: bool) -> None:
    assert exists(span) is there


def exists(span: str) -> bool:
    """Returns whether the file or module that a code span names exists; true for every other span."""
    if _CHANNELS_AND_LOGS.fullmatch(span):
        return True
    if _FILE.fullmatch(span):
        return (ROOT / span).exists() or span in tutorial_files()
    return not _MODULE.fullmatch(span) or _module_exists(span)


def _module_exists(name: str) -> bool:
    """Returns whether `name` is a module of this repository or of a tutorial, or an attribute of such a module."""
    path = name.replace(".", "/")
    if (ROOT / "fwk/scaffold/native" / name).exists():
        return True
    if (ROOT / f"{path}.py").exists() or (ROOT / path).is_dir() or f"{path}.py" in tutorial_files():
        return True
    module, _, attribute = name.rpartition(".")
    try:
        return hasattr(import_module(module), attribute)
    except ImportError:
        return False
