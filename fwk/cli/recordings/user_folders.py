"""Folders of a recorded run with its own modules and message types."""

from collections.abc import Sequence
from pathlib import Path

from fwk.lcm.type_registry import put_first, use_types_of


def use_folders(folders: Sequence[str]) -> None:
    """Makes the modules and message types of these folders available, before installed ones of the same name."""
    for folder in folders:
        use_types_of(Path(folder))
    put_first([str(Path(folder).resolve()) for folder in folders])
