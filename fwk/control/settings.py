"""The settings of a run's components: values, origins, and requested changes."""

import dataclasses
import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from itertools import accumulate
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from fwk.component.config import Config
from fwk.component.declaration import declaration
from fwk.component.meanings import meanings_of
from fwk.control.requests import RequestError
from fwk.model.errors import PlanError, Problems
from fwk.model.plan import ComponentPlan, Plan
from fwk.model.selection import dot_for_slash, matches, nearest
from fwk.plan.channel_settings import mistakes_with_channels
from fwk.plan.files.overrides import EXAMPLE, PLACE, RUN_KEYS, SHARED, overrides
from fwk.plan.files.schema import EVERY, OFFSET
from fwk.plan.files.settings import effective
from fwk.plan.files.source import Node

_NOW = "now"
_FIXED = "cannot change during a run; set it in the launch file and restart the run"
_LIMITS = {"gt": "more than", "ge": "at least", "lt": "less than", "le": "at most"}


@dataclass(frozen=True)
class NewSettings:
    """New settings of a component."""

    component: int
    values: dict[str, Any]
    said: dict[str, Any]
    """Changed values by dotted name."""

    @property
    def text(self) -> str:
        """All settings of the component, as JSON."""
        return json.dumps(self.values)


class RunSettings:
    """The effective settings of all components."""

    def __init__(self, plan: Plan) -> None:
        self._plan = plan
        self._values = {component.index: component.config for component in plan.components}
        self._origins = {component.index: dict(component.origins) for component in plan.components}
        self._asked: dict[int, dict[str, Any]] = {}  # by component: settings from the next boundary on
        self._changed: set[int] = set()

    def rows(self, patterns: Sequence[str]) -> list[dict[str, Any]]:
        """Returns name, value, origin, type and meaning of all settings, or of those that match the patterns.

        Raises:
            RequestError: a pattern matches nothing.
        """
        names = [pattern.partition(".")[0] for pattern in patterns] or ["*"]
        concerned = [each for each in self._plan.components if any(matches(each.name, name) for name in names)]
        found = [row for component in concerned for row in self._rows_of(component)]
        for pattern in patterns:
            if not any(_means(pattern, row) for row in found):
                raise RequestError(self._unknown(pattern))
        return [row for row in found if not patterns or any(_means(pattern, row) for pattern in patterns)]

    def changed(self, components: Sequence[int]) -> dict[str, str]:
        """Returns the settings of these components that differ from the plan's: by name, as JSON."""
        some = self._changed.intersection(components)
        return {self._plan.components[index].name: json.dumps(self._values[index]) for index in sorted(some)}

    def check(self, sets: Sequence[str]) -> list[NewSettings]:
        """Returns requested settings of components with `NAME.SETTING=VALUE` added; changes nothing.

        Raises:
            RequestError: with every mistake.
        """
        problems = Problems()
        for text in sets:
            path = text.partition("=")[0]
            if "." not in path:
                right = "values of the run as a whole cannot change" if path in RUN_KEYS else EXAMPLE
                problems.add("", "", f"'{text}' is not NAME.SETTING=VALUE; {right}")
            elif text.startswith(f"{SHARED}."):
                problems.add("", "", f"'{text}' changes nothing; name the components that have it: NAME.SETTING=VALUE")
        typed = overrides([text for text in sets if "." in text.partition("=")[0]], problems)
        changes = typed.at("config").value if typed.child("config") else {}
        names = [component.name for component in self._plan.components]
        for pattern in list(changes):
            if wrong := dot_for_slash(pattern, changes[pattern].value, names):
                problems.add("", "", wrong)
                del changes[pattern]
        found = [
            made
            for component in self._plan.components
            if (made := self._check_component(component, _layers(component.name, changes), problems))
        ]
        for pattern in changes:
            if not any(matches(name, pattern) for name in names):
                problems.add("", "", f"no component '{pattern}'; {nearest(pattern, names)}")
        try:
            problems.stop_if_any()
        except PlanError as error:
            raise RequestError(
                "\n".join(str(problem).removeprefix(f"{PLACE}: ") for problem in error.problems)
            ) from error
        return found

    def ask(self, new: NewSettings) -> None:
        """Notes that a component gets these settings at the next boundary."""
        self._asked[new.component] = new.values

    def take(self, new: NewSettings, origin: str) -> None:
        """Notes that a component has these settings from now on."""
        self._values[new.component] = new.values
        self._asked.pop(new.component, None)
        origins = self._origins[new.component]
        origins |= dict.fromkeys(new.said, origin)
        for name in new.said:  # a mapping that was empty had an origin, too; now its keys have theirs
            for above in accumulate(name.split(".")[:-1], "{}.{}".format):
                origins.pop(above, None)
        self._changed.add(new.component)

    def _check_component(self, component: ComponentPlan, layers: list[Node], problems: Problems) -> NewSettings | None:
        if not layers:
            return None
        kind = _config_class(component)
        for name in (EVERY, OFFSET):  # stand among the settings in launch files only
            if name not in kind.model_fields and any(layer.child(name) for layer in layers):
                problems.add("", component.name, f"'{name}' {_FIXED}")
                return None
        texts: list[str] = []
        now = _node(self._asked.get(component.index, self._values[component.index]))
        values, origins = effective(kind, [now, *layers], "", lambda _, text: texts.append(text))
        said = {name: _value(values, name) for name, origin in origins.items() if origin != _NOW}
        empty = dict.fromkeys(path for layer in layers for path in _empty_mappings(layer)) if not texts else {}
        texts += [
            f"'{path}={{}}' changes nothing, because its keys keep their values; write {path}.{next(iter(keys))}=VALUE"
            for path in empty
            if isinstance(keys := _value(values, path), dict) and keys
        ]
        texts += [
            f"'{name}' {_FIXED}"
            for name, value in said.items()
            if not _described(kind, name)["editable"] and value != _value(self._values[component.index], name)
        ]
        names = [channel.name for channel in self._plan.channels]
        texts = texts or [text for _, text in mistakes_with_channels(kind, values, component.channels, names)]
        for text in texts:
            problems.add("", component.name, text)
        if texts:
            return None
        return NewSettings(component.index, values, said)

    def _rows_of(self, component: ComponentPlan) -> list[dict[str, Any]]:
        values, kind = self._values[component.index], _config_class(component)
        return [
            {
                "component": component.name,
                "setting": name,
                "value": _value(values, name),
                "origin": origin,
                **_described(kind, name),
            }
            for name, origin in self._origins[component.index].items()
        ]

    def _unknown(self, pattern: str) -> str:
        """Returns what is wrong with a pattern that matches no setting."""
        name, _, setting = pattern.partition(".")
        meant = [each for each in self._plan.components if matches(each.name, name)]
        own = dict.fromkeys(dotted for each in meant for dotted in self._origins[each.index])
        if wrong := dot_for_slash(name, setting.split(".")[:1], [each.name for each in meant]):
            return wrong
        if setting and own:
            return f"no setting '{pattern}'; {nearest(setting, list(own))}"
        if meant:
            return f"'{name}' has no settings"
        of = (f"{each.name}.{dotted}" for each in self._plan.components for dotted in self._origins[each.index])
        whole = next((each for each in of if each.endswith(f".{pattern}")), "")
        names = [each.name for each in self._plan.components if self._origins[each.index]]
        right = f"did you mean '{whole}'?" if whole else nearest(name, names)
        return f"no component '{name}'; {right}"


def _means(pattern: str, row: dict[str, Any]) -> bool:
    component, _, setting = pattern.partition(".")
    own = str(row["setting"])
    return matches(row["component"], component) and (not setting or own == setting or own.startswith(f"{setting}."))


def _empty_mappings(node: Node, path: str = "") -> Iterator[str]:
    """Yields the dotted names of all settings that are {}."""
    if node.value == {}:
        yield path
    elif isinstance(node.value, dict):
        for key, below in node.value.items():
            yield from _empty_mappings(below, f"{path}.{key}" if path else key)


def _layers(name: str, changes: dict[str, Node]) -> list[Node]:
    return [node for pattern, node in changes.items() if matches(name, pattern)]


def _config_class(component: ComponentPlan) -> type[Config]:
    return _config_of(component.module, component.class_name)


@cache
def _config_of(module: str, class_name: str) -> type[Config]:
    return declaration(getattr(import_module(module), class_name)).config


def _node(value: Any) -> Node:
    if isinstance(value, dict):
        return Node({key: _node(below) for key, below in value.items()}, _NOW)
    return Node([_node(below) for below in value] if isinstance(value, list) else value, _NOW)


def _value(values: Any, dotted: str) -> Any:
    for key in dotted.split("."):
        values = values.get(key) if isinstance(values, dict) else None
    return values


@cache
def _described(kind: type[Config], dotted: str) -> dict[str, Any]:
    """Returns type, range and meaning of a setting, and whether it can be changed during the run."""
    annotation: Any = kind
    meaning, limits, editable = "", "", True
    for key in dotted.split("."):
        annotation, meaning, limits, fixed = _field(annotation, key)
        editable = editable and not fixed
    meaning = " ".join(meaning.split())
    return {"type": _type_name(annotation), "range": limits, "meaning": meaning, "editable": editable}


def _type_name(annotation: Any) -> str:
    """Returns a type as launch files have it, without checks and defaults: `tuple[int, int] | None`."""
    kind, parts = get_origin(annotation), get_args(annotation)
    if kind is Literal:
        return " | ".join(map(str, parts))
    if kind is Annotated:
        return _type_name(parts[0])
    if kind in (Union, UnionType):
        return " | ".join(map(_type_name, parts))
    if annotation in (None, NoneType, ...):
        return {None: "any", NoneType: "None"}.get(annotation, "...")
    name = getattr(kind or annotation, "__name__", str(annotation))
    return f"{name}[{', '.join(map(_type_name, parts))}]" if parts else name


def _field(kind: Any, key: str) -> tuple[Any, str, str, bool]:
    """Returns type, meaning and range of a field of settings, or of a dataclass in them, and whether it is fixed."""
    if isinstance(kind, type) and issubclass(kind, BaseModel) and key in kind.model_fields:
        found = kind.model_fields[key]
        meaning = found.description or meanings_of(kind).get(key, "")
        limits = _range([*found.metadata, *_limits_in(found.annotation)])
        return found.annotation, meaning, limits, bool(found.frozen)
    if isinstance(kind, type) and dataclasses.is_dataclass(kind):
        return get_type_hints(kind).get(key), meanings_of(kind).get(key, ""), "", False
    return None, "", "", False


def _limits_in(annotation: Any) -> Iterator[Any]:
    """Yields the limits that an optional type states itself, as `Annotated[float, Field(ge=0.0)] | None` does."""
    parts = get_args(annotation)
    if get_origin(annotation) is Annotated:
        for each in parts[1:]:
            yield from each.metadata if isinstance(each, FieldInfo) else (each,)
    elif get_origin(annotation) in (Union, UnionType):
        for part in parts:
            yield from _limits_in(part)


def _range(limits: Iterable[Any]) -> str:
    """Returns the limits of a number in words, such as `at least 0, less than 1`; empty: it has none."""
    return ", ".join(
        f"{word} {getattr(each, name)}" for each in limits for name, word in _LIMITS.items() if hasattr(each, name)
    )
