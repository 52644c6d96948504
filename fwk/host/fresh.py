"""Forgets the application's modules, so that the next import reads their files again."""

import importlib
import sys
from pathlib import Path

from fwk.plan.model import Plan

_KEPT = ("fwk", "lcmtypes")
"""What processes have in common stays as it is."""


def forget_modules(plan: Plan) -> None:
    """Forgets every module that lies beside the plan's components, and all modules of their packages.

    To be called in a new process before it has imported anything of its own: objects of the forgotten classes would
    not be instances of the new ones.
    """
    packages = {component.module.partition(".")[0] for component in plan.components} - {*_KEPT}
    folders = [Path(folder).resolve() for folder in plan.folders]
    for name, module in list(sys.modules.items()):
        top = name.partition(".")[0]
        file = getattr(module, "__file__", None)
        ours = file is not None and any(Path(file).resolve().is_relative_to(folder) for folder in folders)
        if top in packages or (ours and top not in _KEPT and "site-packages" not in str(file)):
            del sys.modules[name]
    importlib.invalidate_caches()
