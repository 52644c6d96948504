"""Docstrings that every supported Python compiles: since 3.13 it encodes them."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HALF = re.compile(r"\\[uU](0000)?[dD][89a-fA-F]")
"""How a half letter is written: no source has it as it is, because that is UTF-8."""
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def test_docstrings_hold_no_half_letters() -> None:
    for file in sorted(file for folder in ("fwk", "procs", "tools") for file in (ROOT / folder).rglob("*.py")):
        source = file.read_text()
        if not HALF.search(source):
            continue
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, DOCUMENTED):
                text = ast.get_docstring(node) or ""
                assert text.isascii() or text.encode(errors="ignore").decode() == text, f"{file}: {text}"
