"""Forgets the application's modules, so that the next import reads their files again."""

import importlib
import sys

from fwk.plan.application import Application
from fwk.plan.model import Plan


def forget_modules(plan: Plan) -> None:
    """Forgets every module that lies beside the plan's components, and all modules of their packages.

    To be called in a new process before it has imported anything of its own: objects of the forgotten classes would
    not be instances of the new ones.
    """
    application = Application(plan)
    for name, module in list(sys.modules.items()):
        if application.owns(name, getattr(module, "__file__", None)):
            del sys.modules[name]
    importlib.invalidate_caches()
