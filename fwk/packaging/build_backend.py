"""The project's build backend: setuptools, with the LCM types generated first and no leftovers of earlier builds."""

import importlib
import shutil
import sys
from pathlib import Path
from typing import Any

from setuptools import build_meta

ROOT = Path(__file__).resolve().parents[2]

get_requires_for_build_wheel = build_meta.get_requires_for_build_wheel
get_requires_for_build_editable = build_meta.get_requires_for_build_editable
get_requires_for_build_sdist = build_meta.get_requires_for_build_sdist
prepare_metadata_for_build_wheel = build_meta.prepare_metadata_for_build_wheel
prepare_metadata_for_build_editable = build_meta.prepare_metadata_for_build_editable
build_sdist = build_meta.build_sdist

Settings = dict[str, Any] | None


def build_wheel(wheel_directory: str, config_settings: Settings = None, metadata_directory: str | None = None) -> str:
    """Builds the wheel; setuptools would put files of an earlier build that no longer exist into it."""
    _generate_types()
    for leftover in ("lib", "bdist.*"):
        for folder in (ROOT / "build").glob(leftover):
            shutil.rmtree(folder)
    return str(build_meta.build_wheel(wheel_directory, config_settings, metadata_directory))


def build_editable(
    wheel_directory: str, config_settings: Settings = None, metadata_directory: str | None = None
) -> str:
    """Builds the wheel that points to this checkout."""
    _generate_types()
    return str(build_meta.build_editable(wheel_directory, config_settings, metadata_directory))


def _generate_types() -> None:
    sys.path.insert(0, str(ROOT))
    try:
        generate = importlib.import_module("fwk.lcm.typegen").generate
        generate(ROOT / "lcmtypes")
    finally:
        sys.path.remove(str(ROOT))
