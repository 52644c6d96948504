"""Forms made from message types, to send messages and requests."""

import json
from typing import Any

from nicegui import ui

from fwk.control.client import ControlError, RefusedError
from fwk.lcm import messages
from fwk.model.service_channels import OUTSIDE, client_of, service_of
from fwk.web.layout import Frame

_NUMBERS = {"int8_t": int, "int16_t": int, "int32_t": int, "int64_t": int, "byte": int, "double": float, "float": float}
_OWN = ("header", "command")


class FieldError(RefusedError):
    """A field of a form has a value that its type cannot have."""


def fields_of(kind: Any) -> dict[str, tuple[str, bool]]:
    """Returns the fields of a form: by name the type, and whether the field is a single plain value.

    Header and command are filled in by the run; counts follow from the lists.
    """
    counts = {size for sizes in kind.__dimensions__ for size in sizes or () if isinstance(size, str)}
    return {
        name: (type_name, not sizes and (type_name in _NUMBERS or type_name in ("string", "boolean")))
        for name, type_name, sizes in zip(kind.__slots__, kind.__typenames__, kind.__dimensions__, strict=True)
        if name not in _OWN and name not in counts
    }


def examples_of(kind: Any) -> dict[str, str]:
    """Returns the text with which each field that is not a single plain value begins: its empty value, in JSON."""
    empty = messages.to_dict(kind())
    wanted = [name for name, (type_name, plain) in fields_of(kind).items() if not plain and type_name != "byte"]
    return {name: json.dumps(empty[name]) for name in wanted}


def value_of(name: str, type_name: str, plain: bool, typed: Any) -> Any:
    """Returns the value of a field as the message needs it.

    Raises:
        FieldError: the text is not a value of the type.
    """
    if plain and type_name in ("string", "boolean"):
        return typed
    try:
        if plain:
            return _NUMBERS[type_name](str(typed).strip() or "0")
        value = json.loads(typed or "null")
    except (ValueError, RecursionError) as error:
        right = f"a number of type {type_name}" if plain else "JSON, such as [1, 2]"
        raise FieldError(f"{name}: '{typed}' is not {right}") from error
    if type_name == "byte" and isinstance(value, list):
        try:
            return bytes(value)
        except (ValueError, TypeError) as error:
            raise FieldError(f"{name}: bytes are numbers from 0 to 255") from error
    return value


async def send_form(frame: Frame, channel: str) -> None:
    """Makes the form of a channel that may be written from outside, or of a service; otherwise nothing."""
    link, access = frame.link, frame.access
    if not frame.may_steer:
        return
    service = service_of(channel) if client_of(channel) == OUTSIDE else ""
    try:
        row = next((row for row in await link.channels() if row["channel"] == channel), None)
        if row is None or not (row["outside"] or service):
            return
        kind = await link.message_type(channel)
    except ControlError as error:
        ui.label(str(error))
        return
    examples = examples_of(kind)
    made = {name: (_input(name, *how, examples.get(name, "")), *how) for name, how in fields_of(kind).items()}

    async def send() -> None:
        try:
            values = {name: value_of(name, how, plain, field.value) for name, (field, how, plain) in made.items()}
        except FieldError as error:
            ui.notify(str(error), type="negative")
            return
        members = {name: value for name, value in values.items() if value is not None}
        if service:
            answer = await frame.do(access.call(service, members))
            if answer:
                ui.notify(f"{service}: {answer['state']}", type="positive")
        else:
            await frame.do(access.send(channel, members), f"{channel}: sent")

    ui.button("send", icon="send", on_click=send).props("no-caps").props("data-name=send")


def _input(name: str, type_name: str, plain: bool, text: str) -> Any:
    label = f"{name} ({type_name.removeprefix('lcmtypes.')}{'' if plain else ', JSON'})"
    if plain and type_name == "boolean":
        return ui.checkbox(label)
    return ui.input(label, value=text).props("dense outlined").classes("w-full")
