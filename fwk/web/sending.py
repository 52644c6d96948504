"""Forms made from message types, to send messages and requests."""

import json
from collections.abc import Awaitable
from typing import Any

from nicegui import ui

from fwk.control.client import ControlError, RefusedError
from fwk.lcm import messages
from fwk.model.service_channels import OUTSIDE, client_of, service_of
from fwk.web.layout import Frame

_NUMBERS = {"int8_t": int, "int16_t": int, "int32_t": int, "int64_t": int, "byte": int, "double": float, "float": float}
_OWN = ("header", "command")
_ANSWERS_SHOWN = 5


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


class Answers:
    """Lines that say what became of the newest messages sent with forms; they stay, also beside another form."""

    def __init__(self) -> None:
        self._lines = ui.column().classes("w-full gap-1").props('role=status aria-label="answers" data-name=answers')

    async def show(self, name: str, answer: Awaitable[str]) -> None:
        """Adds a line on top, which waits for the answer and then shows it, or the reason of a refusal.

        Args:
            name: the service or channel.
            answer: what to say about it once it is known.
        """
        with self._lines:
            line = ui.label(f"{name}: waits for the answer").classes("fwk-answer")
        line.move(target_index=0)
        for old in self._lines.default_slot.children[_ANSWERS_SHOWN:]:
            old.delete()
        try:
            text, look = f"{name}: {await answer}", "s-running"
        except ControlError as error:
            text, look = str(error), "s-failed"
        line.set_text(text)
        line.classes(look)


async def send_form(frame: Frame, channel: str, answers: Answers) -> None:
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

    async def answer() -> str:
        values = {name: value_of(name, how, plain, field.value) for name, (field, how, plain) in made.items()}
        members = {name: value for name, value in values.items() if value is not None}
        if service:
            return str((await access.call(service, members))["state"])
        await access.send(channel, members)
        return "sent"

    ui.button("send", icon="send", on_click=lambda: answers.show(service or channel, answer())).props(
        "no-caps data-name=send"
    )


def _input(name: str, type_name: str, plain: bool, text: str) -> Any:
    label = f"{name} ({type_name.removeprefix('lcmtypes.')}{'' if plain else ', JSON'})"
    if plain and type_name == "boolean":
        return ui.checkbox(label)
    return ui.input(label, value=text).props("dense outlined").classes("w-full")
