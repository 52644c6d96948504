"""Scenario files of tests."""

from pathlib import Path


def written(folder: Path, text: str) -> Path:
    """Writes a scenario to mine.yaml in the folder."""
    path = folder / "mine.yaml"
    path.write_text(text)
    return path
