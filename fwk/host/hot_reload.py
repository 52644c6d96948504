"""Imports the application's modules anew for components that are reloaded."""

import importlib
import sys
from collections.abc import Mapping

from fwk.component.declaration import Declaration, declaration
from fwk.model.plan import Plan
from fwk.plan.files.source_files import Application


def forget_modules(plan: Plan, host: int) -> Mapping[str, Declaration]:
    """Forgets all modules of the application, so that the next import reads their files again.

    These are the modules beside the plan's components and in their packages. Must be called in a new process before it
    imports anything of its own: objects of the forgotten classes are not instances of the new ones.

    Returns:
        What the classes of the host's components declared before, by component.
    """
    application = Application(plan)
    components = [plan.components[index] for index in plan.hosts[host].components]
    before = {
        component.name: declaration(getattr(sys.modules[component.module], component.class_name))
        for component in components
    }
    for name, module in list(sys.modules.items()):
        if application.owns(name, getattr(module, "__file__", None)):
            del sys.modules[name]
    importlib.invalidate_caches()
    return before
