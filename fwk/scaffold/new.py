"""Makes projects and components: each function returns the files to write."""

import re
from collections.abc import Sequence
from pathlib import Path

from fwk.control.yaml_edit import EditError, read, with_value
from fwk.model.errors import hint
from fwk.plan.files.launch_file import FOLDER, shown
from fwk.scaffold.changes import Change, ScaffoldError, content, edited
from fwk.scaffold.project import Project, check_module_is_free, check_name, check_types_are_free, package_of
from fwk.scaffold.templates import class_name, component_template, kinds, names_in, project_files

_NAMESPACE = re.compile(r"[A-Za-z_][\w-]*", re.ASCII)
_README, _HEADING = "README.md", "## Components"


def new_project(name: str, folder: Path) -> list[Change]:
    """Returns the files of a project with two components, a message type, a launch file and tests.

    Raises:
        ScaffoldError: the name cannot be used, or the folder is a file.
    """
    check_name(name, "a project")
    check_types_are_free(name, folder)
    if folder.exists() and not folder.is_dir():
        raise ScaffoldError(f"{shown(folder)} is a file; choose another folder with --folder")
    return [Change(folder / path, text) for path, text in project_files(name, package_of(folder)).items()]


def new_component(
    project: Project, name: str, kind: str = "stages", launch: str | None = None, namespace: str | None = None
) -> list[Change]:
    """Returns the files of a component with its settings, types and test, and the edits of launch file and README.

    Args:
        project: Project that gets the component.
        name: Name of the component and of its module.
        kind: One of `kinds()`.
        launch: Name of the launch file; None: the only one.
        namespace: Namespace in the launch file; None: the first one there.

    Raises:
        ScaffoldError: a name cannot be used, or the launch file has an entry of that name.
    """
    check_name(name, "a component")
    if kind not in kinds():
        raise ScaffoldError(f"no kind of component '{kind}'; {hint(kind, kinds())}")
    if {name, class_name(name)} & names_in(kind):
        raise ScaffoldError(f"components use the name '{name}' themselves; choose another one, such as {name}_part")
    check_types_are_free(name, project.root)
    check_module_is_free(name, project.package)
    file = project.launch_file(launch)
    text = content(file)
    template = component_template(kind, name, project.package, namespace or _first_namespace(file, text))
    made = [Change(project.root / path, each) for path, each in template.files.items()]
    return [*made, edited(file, with_entries(file, text, template.launch)), *_readme(project.root, template.readme)]


def new_launch(project: Project, name: str, modules: Sequence[str] = (), namespace: str = "robot") -> list[Change]:
    """Returns a launch file with these modules, by default all modules of the project's package.

    Raises:
        ScaffoldError: the name cannot be used, or a module does not exist.
    """
    check_name(name, "a launch file")
    package = project.package
    known = sorted(each.stem for each in (project.root / package).glob("*.py") if not each.name.startswith("_"))
    wanted = [each.removeprefix(f"{package}.") for each in modules] or known
    for each in wanted:
        if each.partition(":")[0] not in known:
            raise ScaffoldError(f"no module '{package}.{each}' in {shown(project.root)}; {hint(each, known)}")
    lines = [f"name: {name}", "period_s: 0.05", "components:"]
    lines += [f"  {_checked(namespace)}/{each.partition(':')[0]}: {{use: {package}.{each}}}" for each in wanted]
    return [Change(project.root / FOLDER / f"{name}.yaml", "\n".join(lines) + "\n")]


def with_entries(file: Path, text: str, entries: dict[str, dict[str, object]]) -> str:
    """Returns the text of a launch file with further entries; all other lines stay as they are.

    Raises:
        ScaffoldError: the file has another entry of that name, or cannot be edited.
    """
    try:
        before = read(text)
        for section, named in entries.items():
            for name, value in named.items():
                there = (before.get(section) or {}).get(name)
                if there is not None and there != value:
                    raise ScaffoldError(f"{shown(file)}: {section} has '{name}' already; choose another name")
                text = with_value(text, (section, name), value) if there is None else text
    except EditError as error:
        raise ScaffoldError(f"{shown(file)}: {error}") from error
    return text


def _first_namespace(file: Path, text: str) -> str:
    try:
        components = read(text).get("components") or {}
    except (EditError, AttributeError):
        raise ScaffoldError(f"{shown(file)} cannot be read; 'fwk check {file.name}' names the mistake") from None
    return next((name.partition("/")[0] for name in components if "/" in name), "robot")


def _checked(namespace: str) -> str:
    if not _NAMESPACE.fullmatch(namespace):
        raise ScaffoldError(f"'{namespace}' is not a namespace; write one word, such as robot")
    return namespace


def _readme(root: Path, lines: Sequence[str]) -> list[Change]:
    """Adds lines at the end of the table of components; a README without that table stays as it is."""
    path = root / _README
    if not path.is_file():
        return []
    text = content(path)
    head, heading, below = text.partition(f"{_HEADING}\n")
    rows = list(re.finditer(r"^\|.*\n", below.partition("\n## ")[0], re.M))
    missing = [line for line in lines if line not in below]
    if not heading or not rows or not missing:
        return []
    end = rows[-1].end()
    return [edited(path, head + heading + below[:end] + "".join(f"{line}\n" for line in missing) + below[end:])]
