"""Docstrings that every supported Python compiles: since 3.13 it encodes them."""

import ast
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def test_docstrings_hold_no_half_letters() -> None:
    for file in sorted(file for folder in ("fwk", "procs", "tools") for file in (ROOT / folder).rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, DOCUMENTED):
                text = ast.get_docstring(node) or ""
                assert text.isascii() or text.encode(errors="ignore").decode() == text, f"{file}: {text}"
