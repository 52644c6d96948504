"""Source file of a component as a concrete syntax tree: its component class, and the meaning of names in it."""

from collections.abc import Iterator
from pathlib import Path

import libcst as cst
from libcst.metadata import MetadataWrapper, PositionProvider

from fwk.model.errors import hint
from fwk.plan.files.launch_file import shown
from fwk.scaffold.changes import ScaffoldError, content
from fwk.scaffold.project import Project

COMPONENT, CONFIG = "fwk.Component", "fwk.Config"


def find_source(project: Project, wanted: str) -> tuple[Path, str]:
    """Returns the file of a component and the name of its class; an empty name stands for the only class.

    Args:
        project: Project with the component.
        wanted: `tracker`, `vision.tracker`, `PACKAGE.tracker` or a path, each with `:Class` where a file has several.

    Raises:
        ScaffoldError: there is no such file.
    """
    module, _, name = wanted.partition(":")
    path = Path(module)
    if path.suffix == ".py" and path.is_file():
        return path, name
    folder = project.root / project.package
    short = module.removeprefix(f"{project.package}.")
    found = folder / f"{short.replace('.', '/')}.py"
    if found.is_file():
        return found, name
    files = sorted(each.relative_to(folder) for each in folder.rglob("*.py") if not each.name.startswith("_"))
    known = [".".join(each.with_suffix("").parts) for each in files]
    raise ScaffoldError(f"no component '{module}' in {shown(folder)}; {hint(short, known)}")


class Source:
    """Parsed file; `module` is replaced with each edit."""

    def __init__(self, path: Path, wanted: str = "") -> None:
        """Parses the file and finds the class.

        Raises:
            ScaffoldError: the file is not valid Python, or has no such component class.
        """
        self.path = path
        self.text = content(path)
        try:
            self.module = cst.parse_module(self.text)
        except cst.ParserSyntaxError as error:
            raise ScaffoldError(f"{shown(path)}:{error.raw_line}: not valid Python: {error.message}") from error
        self.class_name = self._component(wanted)

    def place(self, node: cst.CSTNode) -> str:
        """Returns `FILE:LINE` of a node of the present tree."""
        wrapper = MetadataWrapper(self.module, unsafe_skip_copy=True)
        return f"{shown(self.path)}:{wrapper.resolve(PositionProvider)[node].start.line}"

    def replace(self, old: cst.CSTNode, new: cst.CSTNode) -> None:
        """Replaces a node of the present tree."""
        self.module = cst.ensure_type(self.module.deep_replace(old, new), cst.Module)

    def classes(self) -> dict[str, cst.ClassDef]:
        """Returns the classes of the file by name."""
        return {each.name.value: each for each in self.module.body if isinstance(each, cst.ClassDef)}

    def component(self) -> cst.ClassDef:
        """Returns the component class."""
        return self.classes()[self.class_name]

    def derived(self, class_: cst.ClassDef, base: str) -> bool:
        """Returns whether a class is derived from `base`, directly or through other classes of the file."""
        named = [self.meaning(each.value) for each in class_.bases]
        others = self.classes()
        return base in named or any(
            each in others and others[each] is not class_ and self.derived(others[each], base) for each in named
        )

    def imported(self) -> dict[str, str]:
        """Returns the names that the module imports, with their full names."""
        found: dict[str, str] = {}
        for statement in imports(self.module):
            if isinstance(statement, cst.Import):
                for alias in statement.names:
                    full = dotted(alias.name)
                    found[alias.evaluated_alias or full.partition(".")[0]] = (
                        full if alias.asname else full.partition(".")[0]
                    )
            elif statement.module and not statement.relative and not isinstance(statement.names, cst.ImportStar):
                for alias in statement.names:
                    found[alias.evaluated_alias or alias.evaluated_name] = (
                        f"{dotted(statement.module)}.{alias.evaluated_name}"
                    )
        return found

    def meaning(self, expression: cst.BaseExpression) -> str:
        """Returns an annotation or base class with the full names of what it names, without spaces."""
        names = self.imported()
        if isinstance(expression, cst.SimpleString):
            expression = cst.parse_expression(str(expression.evaluated_value))
        if isinstance(expression, cst.Subscript):
            inner = [each.slice.value for each in expression.slice if isinstance(each.slice, cst.Index)]
            return f"{self.meaning(expression.value)}[{','.join(map(self.meaning, inner))}]"
        if isinstance(expression, cst.Name | cst.Attribute):
            first, point, rest = dotted(expression).partition(".")
            return names.get(first, first) + point + rest
        return self.module.code_for_node(expression).replace(" ", "")

    def short(self, full: str) -> str | None:
        """Returns the shortest way to name `full` with the imports that there are; None if nothing imports it."""
        ways = [
            local + full[len(name) :]
            for local, name in self.imported().items()
            if full == name or full.startswith(f"{name}.")
        ]
        return min(ways, key=len, default=None)

    def _component(self, wanted: str) -> str:
        found = [name for name, each in self.classes().items() if self.derived(each, COMPONENT)]
        if wanted:
            if wanted not in found:
                raise ScaffoldError(f"{shown(self.path)} has no component class '{wanted}'; {hint(wanted, found)}")
            return wanted
        if len(found) != 1:
            names = " or ".join(f"{self.path.stem}:{name}" for name in found)
            reason = f"several component classes; name one: {names}" if found else "no class derived from Component"
            raise ScaffoldError(f"{shown(self.path)} has {reason}")
        return found[0]


def imports(module: cst.Module) -> Iterator[cst.Import | cst.ImportFrom]:
    """Yields the import statements at the top level of a module, also those below `if` and `try`."""
    waiting: list[cst.CSTNode] = list(module.body)
    while waiting:
        node = waiting.pop(0)
        if isinstance(node, cst.Import | cst.ImportFrom):
            yield node
        elif isinstance(node, cst.SimpleStatementLine | cst.If | cst.Try | cst.Else | cst.IndentedBlock):
            waiting[:0] = node.children


def dotted(expression: cst.CSTNode) -> str:
    """Returns `a.b.c` of a name or attribute; other expressions give an empty text."""
    if isinstance(expression, cst.Name):
        return expression.value
    if isinstance(expression, cst.Attribute):
        return f"{dotted(expression.value)}.{expression.attr.value}"
    return ""
