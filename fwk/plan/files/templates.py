"""Lists the components of the files: single ones, and those that robots get from templates."""

from dataclasses import dataclass, field
from typing import Any

from fwk.model.errors import Problems, hint
from fwk.model.names import mistake_in
from fwk.plan.files.launch_file import Files, Layer
from fwk.plan.files.schema import ComponentEntry
from fwk.plan.files.source import Node
from fwk.plan.files.substitution import substitute

_FILLED = ("config", "channels", "providers", "needs", "offset", "command")
"""Keys of a component in whose texts `{key}` is replaced."""


@dataclass
class Asked:
    """A component as the files specify it."""

    name: str
    entry: ComponentEntry
    node: Node
    """The entry in its file, with the texts of the template filled in."""
    values: dict[str, Any]
    config: list[tuple[int, Node]] = field(default_factory=list)
    """Settings, each with the number of its layer; later layers win."""

    @property
    def namespace(self) -> str:
        """Part of the name before the last slash."""
        return self.name.rpartition("/")[0]

    def settings(self) -> list[Node]:
        """Returns the settings in the order of the layers, later ones win."""
        return [node for _, node in sorted(self.config, key=lambda pair: pair[0])]


@dataclass(frozen=True)
class _Template:
    layer: int
    entries: dict[str, ComponentEntry]
    node: Node


def expand(files: Files, problems: Problems) -> list[Asked]:
    """Returns all components, in the order of the files; in a file, single ones before robots."""
    maker = _Maker(files, problems)
    for number, layer in enumerate(files.layers):
        maker.templates(number, layer)
    for number, layer in enumerate(files.layers):
        maker.components(number, layer)
        maker.robots(number, layer)
    return list(maker.made.values())


class _Maker:
    def __init__(self, files: Files, problems: Problems) -> None:
        self._files = files
        self._problems = problems
        self._templates: dict[str, _Template] = {}
        self._robots: dict[str, str] = {}
        self.made: dict[str, Asked] = {}

    def templates(self, number: int, layer: Layer) -> None:
        """Adds the templates of a file."""
        for name, entries in layer.content.templates.items():
            node = layer.node.at("templates", name)
            if name in self._templates:
                first = self._templates[name].node.place
                self._problems.add(node.place, "", f"there is a template '{name}' at {first} already; rename one")
            else:
                self._templates[name] = _Template(number, entries, node)

    def components(self, number: int, layer: Layer) -> None:
        """Adds the single components of a file."""
        for name, entry in layer.content.components.items():
            self._make(name, number, entry, layer.node.at("components", name), {})

    def robots(self, number: int, layer: Layer) -> None:
        """Adds the components of the robots of a file."""
        for robot, entry in layer.content.robots.items():
            node = layer.node.at("robots", robot)
            if robot in self._robots:
                text = f"there is a robot '{robot}' at {self._robots[robot]} already; rename one"
                self._problems.add(node.place, "", text)
                continue
            self._robots[robot] = node.place
            if mistake := mistake_in(robot):
                self._problems.add(node.place, "", mistake)
                self._files.gaps.add("*")
                continue
            short = {short for name in entry.use if name in self._templates for short in self._templates[name].entries}
            for place, name in enumerate(entry.use):
                if name in self._templates:
                    self._fill(robot, self._templates[name], entry.values)
                else:
                    where = node.at("use", place).place
                    self._problems.add(where, robot, f"no template '{name}'; {hint(name, self._templates)}")
                    self._files.gaps.add(robot)
            for component in entry.config:
                settings = node.at("config", component)
                if f"{robot}/{component}" in self.made:
                    asked = self.made[f"{robot}/{component}"]
                    asked.config.append((number, self._filled(settings, asked)))
                elif robot not in self._files.gaps:
                    text = f"robot '{robot}' has no component '{component}'; {hint(component, short)}"
                    self._problems.add(settings.place, robot, text)

    def _fill(self, robot: str, template: _Template, values: dict[str, Any]) -> None:
        for short, entry in template.entries.items():
            self._make(f"{robot}/{short}", template.layer, entry, template.node.at(short), values)

    def _make(self, name: str, layer: int, entry: ComponentEntry, node: Node, values: dict[str, Any]) -> None:
        if mistake := mistake_in(name):
            self._problems.add(node.place, "", mistake)
            self._files.gaps.add("*")
        elif name in self.made:
            first = self.made[name].node.place
            self._problems.add(node.place, name, f"there is a component of this name at {first} already; rename one")
        else:
            namespace = name.rpartition("/")[0]
            number = "".join(filter(str.isdecimal, namespace)) or "0"
            asked = Asked(name, entry, node, {"number": number, **values, "namespace": namespace, "name": name})
            keys = {key: below for key, below in node.value.items() if key in _FILLED}
            filled = self._filled(Node(keys, node.place), asked)
            asked.node = Node({**node.value, **filled.value}, node.place)
            asked.config = [(layer, filled.value["config"])] if "config" in keys else []
            if command := filled.child("command"):
                words = command if isinstance(command.value, list) else Node([command], command.place)
                asked.config.append((layer, Node({"command": words}, node.place)))
            self.made[name] = asked

    def _filled(self, node: Node, asked: Asked) -> Node:
        def report(place: str, text: str) -> None:
            self._problems.add(place, asked.name, text)
            self._files.gaps.add("*")

        return substitute(node, asked.values, report) or Node({}, node.place)
