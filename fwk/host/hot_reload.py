"""Imports the application's modules anew for components that are reloaded, and holds what the plan was made of."""

import importlib
import sys
from collections.abc import Mapping

from fwk.component.declaration import Declaration, declaration
from fwk.component.port import DeclarationError, Port
from fwk.lcm import messages
from fwk.model.plan import ComponentPlan, Plan
from fwk.plan.files.source_files import Application


def forget_modules(plan: Plan, host: int) -> Mapping[str, Declaration]:
    """Forgets every module that lies beside the plan's components, and all modules of their packages, so that the next
    import reads their files again. Gives what the classes of the host's components said before, by their names.

    To be called in a new process before it has imported anything of its own: objects of the forgotten classes would
    not be instances of the new ones.
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


def check_unchanged(component: ComponentPlan, stages: tuple[str, ...], before: Declaration, now: Declaration) -> None:
    """Whether the changed class of a component still says what the plan says of it.

    Raises:
        DeclarationError: it needs another plan.
    """
    followed = {*before.stages} == {*stages} and component.rate_hz == before.rate_hz  # and not the launch file's own
    was, says = _of_the_plan(before, followed), _of_the_plan(now, followed)
    changed = [what for what in was | says if was.get(what) != says.get(what)]
    if changed:
        what = changed[0]
        raise DeclarationError(
            f"{component.module}: {what} of its class was {was.get(what, 'nothing')} when the run began and is now "
            f"{says.get(what, 'nothing')}; start the run again"
        )


def _of_the_plan(declared: Declaration, stages: bool) -> dict[str, str]:
    """What others rely on; a process takes settings, histories and its own aspects from the class as it is."""
    words = {f"'{port.attribute}'": _port(port) for port in declared.ports}
    words |= {f"'{attribute}'": aspect for attribute, aspect in declared.aspects.items() if aspect == "time_source"}
    words |= {f"'{attribute}'": aspect.__name__ for attribute, aspect in declared.asks.items()}
    words["'provides'"] = ", ".join(aspect.__name__ for aspect in declared.provides) or "nothing"
    if stages:
        words["the stage"] = ", ".join(declared.stages) or f"none, at {declared.rate_hz} Hz"
    return words


def _port(port: Port) -> str:
    types = [kind for kind in (port.message_type, port.reply_type) if kind]
    return f"{port.kind} {' and '.join(map(messages.type_name, types))} of {port.channel}"
