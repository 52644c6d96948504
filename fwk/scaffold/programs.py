"""Builds the programs in C of a project."""

import os
import subprocess
import sys
from pathlib import Path

from fwk.scaffold.project import Project

BUILD = "make -C native"


def build_programs(project: Project) -> str:
    """Builds the programs in the folder `native` with the tools of this environment; returns a sentence about it."""
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)])
    command = ["make", "--silent", "-C", "native"]
    try:
        done = subprocess.run(
            command, cwd=project.root, env={**os.environ, "PATH": path}, capture_output=True, text=True, check=False
        )
    except OSError as error:
        return f"not built: make: {error.strerror}; install make and a C compiler, then type: {BUILD}"
    if done.returncode:
        return f"not built: {' '.join((done.stderr or done.stdout).split())}; mend this, then type: {BUILD}"
    return f"built with: {BUILD}"
