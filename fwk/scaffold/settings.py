"""Adds settings to a component and removes them; everything else stays as it is."""

import json
import re
from collections.abc import Callable
from dataclasses import dataclass

import libcst as cst

from fwk.model.errors import hint
from fwk.scaffold.changes import ScaffoldError
from fwk.scaffold.class_lines import (
    annotated,
    attributes,
    code_of,
    is_empty,
    is_text,
    lines_of,
    parsed,
    taken,
    uses,
    value_of,
    with_line,
    with_lines,
    without,
)
from fwk.scaffold.imports import add_import, remove_unused
from fwk.scaffold.source import CONFIG, Source

_INDENT = "    "
_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)
_CONFIG = "config"
_TYPES: dict[str, Callable[[str], object]] = {
    "bool": lambda text: {"true": True, "false": False}[text.lower()],
    "float": float,
    "int": int,
    "str": str,
}


@dataclass(frozen=True)
class SettingRequest:
    """A setting to add."""

    name: str
    type: str
    """Python's name of its type: `float`."""
    default: str
    """Default value as a Python expression."""
    meaning: str = ""


def add_setting(source: Source, request: SettingRequest) -> None:
    """Adds a setting to the component's class of settings, which is made if there is none.

    Raises:
        ScaffoldError: the class of settings is in another file, or has another setting of that name.
    """
    if not _NAME.fullmatch(request.name):
        raise ScaffoldError(f"'{request.name}' is not the name of a setting; write one word, such as gain")
    _ensure_settings(source)
    class_ = _settings(source)
    assert class_ is not None
    if (there := attributes(class_).get(request.name)) is not None:
        if (source.meaning(there.annotation.annotation), value_of(source, there)) == (request.type, request.default):
            return
        raise ScaffoldError(taken(source, there, request.name, class_.name.value))
    text = f"{request.name}: {request.type} = {request.default}"
    made = [parsed(source, text)]
    if request.meaning:
        made.append(parsed(source, f'"""{request.meaning}"""'))
    lines = [each for each in lines_of(class_) if not is_empty(each)]
    place = max((at for at, each in enumerate(lines) if annotated(each)), default=-1)
    while place + 1 < len(lines) and is_text(lines[place + 1]):
        place += 1
    if place >= 0 and not any(map(annotated, lines)):
        made[0] = made[0].with_changes(leading_lines=[cst.EmptyLine(indent=False)])
    source.replace(class_, with_lines(class_, [*lines[: place + 1], *made, *lines[place + 1 :]]))


def remove_setting(source: Source, name: str) -> list[str]:
    """Removes a setting with its docstring, if the class of settings has it.

    Returns:
        Places that still use the setting, as `FILE:LINE`.
    """
    class_ = _settings(source)
    there = attributes(class_).get(name) if class_ else None
    if class_ is None or there is None:
        return []
    source.replace(class_, with_lines(class_, without(lines_of(class_), name, with_text=True)))
    if "Field(" in value_of(source, there):
        remove_unused(source, "fwk.Field")
    _remove_made(source)
    return uses(source, f"{_CONFIG}.{name}")


def python_value(kind: str, text: str) -> str:
    """Returns the default of a setting as Python writes it; text needs no quotes.

    Raises:
        ScaffoldError: the value does not fit the type, or no setting can have the type here.
    """
    if kind not in _TYPES:
        raise ScaffoldError(f"a setting cannot be of type '{kind}' here; {hint(kind, _TYPES)}")
    if kind == "str":
        return json.dumps(text.strip("\"'"), ensure_ascii=False)
    try:
        return repr(_TYPES[kind](text))
    except (KeyError, ValueError):
        raise ScaffoldError(f"'{text}' is not a value of type {kind}") from None


def _settings(source: Source) -> cst.ClassDef | None:
    """Returns the component's class of settings; None if the component has none."""
    declared = attributes(source.component()).get(_CONFIG)
    if declared is None:
        return None
    name = source.meaning(declared.annotation.annotation)
    found = source.classes().get(name)
    if found is None or not source.derived(found, CONFIG):
        raise ScaffoldError(
            f"{source.place(declared)}: the settings of {source.class_name}, {name}, are not a class of this file; "
            "edit them where they are"
        )
    return found


def _ensure_settings(source: Source) -> None:
    """Adds an empty class of settings, unless the component has one."""
    if _settings(source) is not None:
        return
    base = add_import(source, "fwk", "Config")
    name = _made_name(source)
    if name in source.classes() or name in source.imported():
        raise ScaffoldError(
            f"{source.path.name} has a '{name}' that {source.class_name} does not use; declare config: {name}"
        )
    component = source.component()
    text = f"class {name}({base}):\n{_INDENT}{_made_docstring(source)}\n"
    made = cst.ensure_type(cst.parse_statement(text, config=source.module.config_for_parsing), cst.ClassDef)
    made = made.with_changes(leading_lines=component.leading_lines)
    below = [cst.EmptyLine(indent=False)] * 2
    body = list(source.module.body)
    place = next(at for at, each in enumerate(body) if each is component)
    lines = with_line(source, lines_of(component), f"{_CONFIG}: {name}")
    changed = with_lines(component, lines).with_changes(leading_lines=below)
    source.module = source.module.with_changes(body=[*body[:place], made, changed, *body[place + 1 :]])


def _remove_made(source: Source) -> None:
    """Removes the class of settings if it is as empty as `_ensure_settings` made it, and nothing else names it."""
    class_, component = _settings(source), source.component()
    name = _made_name(source)
    if class_ is None or class_.name.value != name or source.module.code.count(name) != 2:
        return
    if [code_of(source, each) for each in lines_of(class_)] != [_made_docstring(source)]:
        return
    changed = with_lines(component, without(lines_of(component), _CONFIG))
    source.replace(component, changed.with_changes(leading_lines=class_.leading_lines))
    made = source.classes()[name]
    source.module = source.module.with_changes(body=[each for each in source.module.body if each is not made])
    remove_unused(source, "fwk.Config")


def _made_name(source: Source) -> str:
    return f"{source.class_name}Config"


def _made_docstring(source: Source) -> str:
    return f'"""Settings of {source.class_name}."""'
