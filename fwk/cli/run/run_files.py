"""Files of a run directory with which a run can be understood and repeated: plan, settings, versions, types."""

import json
import os
import platform
import shutil
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from fwk.cli.run.run_directory import RunDirError
from fwk.display.plan_overview import value_at
from fwk.model.plan import Plan
from fwk.model.plan_document import document_of
from fwk.plan.files.launch_file import INSTALLED

LIBRARIES = ("fwk", "lcm", "numpy", "opencv-python-headless", "pymunk", "filterpy", "pydantic")


def write_run_files(folder: Path, plan: Plan) -> None:
    """Writes `plan.json`, `config.yaml` (settings with origins), `versions.json` and the .lcm sources in `lcmtypes/`.

    Raises:
        RunDirError: a file cannot be written.
    """
    types = folder / "lcmtypes"
    try:
        (folder / "plan.json").write_text(json.dumps(document_of(plan), indent=1))
        (folder / "config.yaml").write_text("".join(f"{line}\n" for line in _settings(plan)))
        (folder / "versions.json").write_text(json.dumps(_versions(), indent=1) + "\n")
        types.mkdir(exist_ok=True)
        for source in _sources(plan):
            shutil.copyfile(source, types / source.name)
    except OSError as error:
        raise RunDirError(f"{error.filename or folder}: cannot write the files of the run: {error.strerror}") from error


def _settings(plan: Plan) -> list[str]:
    return [
        f"{component.name}.{name}: {json.dumps(value_at(component.config, name))}  # {origin}"
        for component in plan.components
        for name, origin in component.origins.items()
    ]


def _versions() -> dict[str, str]:
    found = {"python": platform.python_version(), "system": _system()}
    for library in LIBRARIES:
        try:
            found[library] = version(library)
        except PackageNotFoundError:
            found[library] = "not installed as a package"
    return found


def _system() -> str:
    """Returns what `platform.platform()` does, for which that starts a program."""
    system = os.uname()
    library = os.confstr("CS_GNU_LIBC_VERSION") if "CS_GNU_LIBC_VERSION" in os.confstr_names else None
    return "-".join([system.sysname, system.release, system.machine, f"with-{library or 'another libc'}"])


def _sources(plan: Plan) -> list[Path]:
    """Returns the .lcm files, those of the user last, so that they replace installed ones of the same name."""
    folders = [str(INSTALLED), *reversed(plan.folders)]
    return [source for folder in folders for source in sorted((Path(folder) / "lcmtypes").glob("*.lcm"))]
