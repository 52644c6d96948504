"""JSON Schema of launch files with the settings and ports of the components, for editors that complete and check."""

from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from fwk.component.config import Config
from fwk.component.declaration import Declaration
from fwk.component.meanings import DocumentedSchema
from fwk.model.errors import Problems
from fwk.plan.classes import UnusableError, components_in, find_class, imported
from fwk.plan.files.folders import folders_of, join
from fwk.plan.files.launch_file import Files, find_launch_file, read_files
from fwk.plan.files.schema import EVERY, OFFSET, ComponentEntry, HostFile, LaunchFile
from fwk.plan.files.templates import Asked, expand
from fwk.plan.packages import component_packages

Schema = dict[str, Any]

_DIALECT = "https://json-schema.org/draft/2020-12/schema"
_REF = "#/$defs/"
_MARK = {"type": "string", "pattern": r"\{[A-Za-z_]\w*\}"}  # `{team}` in a template becomes a value later


def schema_of_files(host_specific: bool = False) -> Schema:
    """Returns the schema of launch files that use the components found from the working directory.

    Raises:
        PlanError: message types found there cannot be generated.
    """
    problems = Problems()
    folders = folders_of([Path.cwd()])
    join(folders, problems)
    problems.stop_if_any()
    return _Made(_found(folders), [], host_specific).schema


def schema_of_file(file: str, host_specific: bool = False) -> Schema:
    """Returns the schema of one launch file, or of its host file, with the names of its components.

    Raises:
        PlanError: the file cannot be read.
    """
    problems = Problems()
    path = find_launch_file(file, problems)
    problems.stop_if_any()
    assert path
    files = read_files(path, problems)
    folders = folders_of(files.folders)
    join(folders, problems)
    asked = expand(files, problems)
    problems.stop_if_any()
    used = {use: found for use in _uses(files) if (found := _class(use, folders))}
    return _Made(_found(folders) | used, asked, host_specific).schema


def schema_of_component(use: str) -> Schema:
    """Returns the schema of the settings of a component's class.

    Raises:
        PlanError: message types found there cannot be generated.
        UnusableError: there is no such class.
    """
    problems = Problems()
    folders = folders_of([Path.cwd()])
    join(folders, problems)
    problems.stop_if_any()
    found = find_class(use, folders)
    return {"$schema": _DIALECT, "title": use, **found.config.model_json_schema(schema_generator=DocumentedSchema)}


def _uses(files: Files) -> Iterable[str]:
    for layer in files.layers:
        yield from (entry.use for entry in layer.content.components.values())
        for template in layer.content.templates.values():
            yield from (entry.use for entry in template.values())


def _found(folders: Sequence[str]) -> dict[str, Declaration]:
    """Returns the components of the announced packages, as `use` names them."""
    found = {}
    roots = [root for package in component_packages() for root in imported(package, folders).__path__]
    for module in _modules(roots):
        if alone := _class(module, folders):
            found[module] = alone
        else:
            uses = (f"{module}:{name}" for name in _names(module, folders))
            found |= {use: each for use in uses if (each := _class(use, folders))}
    return found


def _modules(roots: Iterable[str]) -> list[str]:
    """Returns the names of the modules of a package except tests; subfolders need no `__init__.py`."""
    files = ((Path(root), file) for root in roots for file in sorted(Path(root).rglob("*.py")))
    return [
        ".".join((root.name, *file.relative_to(root).with_suffix("").parts))
        for root, file in files
        if not file.name.startswith("test_") and "/." not in str(file)
    ]


def _names(module: str, folders: Sequence[str]) -> list[str]:
    try:
        return list(components_in(imported(module, folders)))
    except UnusableError:
        return []


def _class(use: str, folders: Sequence[str]) -> Declaration | None:
    try:
        return find_class(use, folders)
    except UnusableError:  # an editor continues without; `fwk check` reports the mistake
        return None


class _Made:
    def __init__(self, classes: Mapping[str, Declaration], asked: Sequence[Asked], host_specific: bool) -> None:
        model = HostFile if host_specific else LaunchFile
        self.schema: Schema = {"$schema": _DIALECT, **model.model_json_schema(schema_generator=DocumentedSchema)}
        self._defs: Schema = self.schema.setdefault("$defs", {})
        self._settings = {use: self._settings_of(use, found) for use, found in sorted(classes.items())}
        self._asked = asked
        if asked:
            self.schema["properties"]["config"] = self._by_pattern()
        if not host_specific:
            self._complete_entries(classes)
            self._complete_robots()

    def _settings_of(self, use: str, found: Declaration) -> Schema:
        """Adds the settings of a class to the definitions; returns a reference to them."""
        self._defs |= _definitions_of(use, found.config)
        return {"$ref": f"{_REF}{use}"}

    def _complete_entries(self, classes: Mapping[str, Declaration]) -> None:
        """Makes the schema of `config` and `channels` depend on the class that a component uses."""
        entry = self._defs["ComponentEntry"]
        entry["properties"]["use"]["examples"] = sorted(classes)
        entry["allOf"] = [
            {
                "if": {"properties": {"use": {"const": use}}, "required": ["use"]},
                "then": {"properties": {"config": self._settings[use], "channels": _ports(found)}},
            }
            for use, found in sorted(classes.items())
        ]

    def _complete_robots(self) -> None:
        by_short: dict[str, list[str]] = {}
        for each in self._asked:
            by_short.setdefault(each.name.rpartition("/")[2], []).append(each.entry.use)
        if by_short:
            known = {short: self._any_of(uses) for short, uses in sorted(by_short.items())}
            self._defs["RobotEntry"]["properties"]["config"] = {"type": "object", "properties": known}

    def _by_pattern(self) -> Schema:
        """Returns the schema of settings by name, namespace or pattern; those of a pattern fit all its components."""
        meant: dict[str, list[str]] = {}
        for each in self._asked:
            namespace, _, short = each.name.rpartition("/")
            for pattern in (each.name, namespace, f"*/{short}"):
                meant.setdefault(pattern, []).append(each.entry.use)
        return {
            "type": "object",
            "properties": {pattern: self._all_of(uses) for pattern, uses in sorted(meant.items()) if pattern},
            "patternProperties": {r"[*?\[]": {"type": "object"}},
            "additionalProperties": False,
        }

    def _all_of(self, uses: Iterable[str]) -> Schema:
        return _joined("allOf", [self._settings[use] for use in dict.fromkeys(uses) if use in self._settings])

    def _any_of(self, uses: Iterable[str]) -> Schema:
        return _joined("anyOf", [self._settings[use] for use in dict.fromkeys(uses) if use in self._settings])


@lru_cache(maxsize=256)
def _definitions_of(use: str, config: type[Config]) -> Schema:
    """Returns the settings of a class and the types in them, made once for all files, to be read only."""
    made = config.model_json_schema(ref_template=f"{_REF}{use}.{{model}}", schema_generator=DocumentedSchema)
    below = {f"{use}.{name}": _partial(each) for name, each in made.pop("$defs", {}).items()}
    own = _partial(made)
    own["properties"] = {**_turns(), **own.get("properties", {})}
    return {**below, use: own}


@lru_cache(maxsize=1)
def _turns() -> Schema:
    """Returns the schemas of `every` and `offset`, which may stand among settings, to be read only."""
    keys = ComponentEntry.model_json_schema(schema_generator=DocumentedSchema)["properties"]
    return {name: keys[name] for name in (EVERY, OFFSET)}


def _joined(word: str, schemas: list[Schema]) -> Schema:
    if not schemas:
        return {"type": "object"}
    return schemas[0] if len(schemas) == 1 else {word: schemas}


def _ports(found: Declaration) -> Schema:
    return {
        "type": "object",
        "properties": {port.attribute: {"type": "string"} for port in found.ports},
        "additionalProperties": False,
    }


def _partial(schema: Schema) -> Schema:
    """Returns the schema of one layer: no setting is required, and `{key}` may stand for a value."""
    made = {key: value for key, value in schema.items() if key != "required"}
    if "properties" in made:
        made["properties"] = {name: _or_mark(below) for name, below in made["properties"].items()}
    return made


def _or_mark(schema: Schema) -> Schema:
    if schema.get("type") in ("string", "object", "array") or "$ref" in schema:
        return schema
    about: Schema = {key: schema[key] for key in ("title", "description", "default") if key in schema}
    return {**about, "anyOf": [{key: value for key, value in schema.items() if key not in about}, _MARK]}
