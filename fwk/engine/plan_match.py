"""Checks a component's class against the plan that was made from an earlier state of its file."""

from collections.abc import Mapping
from typing import Any

from pydantic import ValidationError

from fwk.component.config import Config
from fwk.component.declaration import Declaration
from fwk.component.port import DeclarationError, Port
from fwk.lcm import messages
from fwk.model.plan import ComponentPlan


def check_ports(component: ComponentPlan, declared: Declaration) -> None:
    """Checks that the class declares the plan's ports.

    Raises:
        DeclarationError: it declares others.
    """
    if {port.attribute for port in declared.ports} != set(component.channels):
        raise DeclarationError(f"{component.module}: its ports are no longer those of the plan; start the run again")


def config_of(component: ComponentPlan, declared: Declaration, settings: Mapping[str, Any]) -> Config:
    """Returns the settings of a component as its class declares them.

    Raises:
        DeclarationError: the class declares others.
    """
    try:
        return declared.config.model_validate(settings)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        wrong = f"'{'.'.join(map(str, first['loc']))}': {first['msg']}"
        raise DeclarationError(f"{component.module}: the run's settings do not fit its class: {wrong}") from error


def check_unchanged(component: ComponentPlan, stages: tuple[str, ...], before: Declaration, now: Declaration) -> None:
    """Checks that a class that was read again still declares what the plan was made of.

    Raises:
        DeclarationError: the change needs another plan.
    """
    followed = {*before.stages} == {*stages} and component.rate_hz == before.rate_hz  # not the launch file's own stages
    was, says = _in_the_plan(before, followed), _in_the_plan(now, followed)
    if (component.every, component.offset) == (before.every, before.offset):  # not the launch file's own
        was["'every'"], says["'every'"] = _turns(before), _turns(now)
    changed = [what for what in was | says if was.get(what) != says.get(what)]
    if changed:
        what = changed[0]
        raise DeclarationError(
            f"{component.module}: {what} of its class was {was.get(what, 'nothing')} when the run began and is now "
            f"{says.get(what, 'nothing')}; start the run again"
        )


def _in_the_plan(declared: Declaration, stages: bool) -> dict[str, str]:
    """Describes what other processes rely on; settings, histories and the process's own aspects may change."""
    words = {f"'{port.attribute}'": _described(port) for port in declared.ports}
    words |= {f"'{attribute}'": aspect for attribute, aspect in declared.aspects.items() if aspect == "time_source"}
    words |= {f"'{attribute}'": aspect.__name__ for attribute, aspect in declared.asks.items()}
    words["'provides'"] = ", ".join(aspect.__name__ for aspect in declared.provides) or "nothing"
    if stages:
        words["the stage"] = ", ".join(declared.stages) or f"none, at {declared.rate_hz} Hz"
    return words


def _turns(declared: Declaration) -> str:
    return f"{declared.every} with the offset {declared.offset}"


def _described(port: Port) -> str:
    types = [kind for kind in (port.message_type, port.reply_type) if kind]
    return f"{'each ' if port.each else ''}{port.kind} {' and '.join(map(messages.type_name, types))} of {port.channel}"
