"""Modules of a plan's application, their files, and the modules that each component consists of."""

import ast
import sys
from collections.abc import Iterable
from importlib.machinery import PathFinder
from pathlib import Path

from fwk.model.plan import ComponentPlan, Plan
from fwk.plan.files.launch_file import shown

_KEPT = ("fwk", "lcmtypes")
"""Packages that all components share."""


class Application:
    """The modules beside the components and in their packages."""

    def __init__(self, plan: Plan) -> None:
        self._packages = {component.module.partition(".")[0] for component in plan.components} - {*_KEPT}
        self._folders = [Path(folder).resolve() for folder in plan.folders]

    def owns(self, module: str, file: str | None) -> bool:
        """Returns whether a module belongs to the application, not to a library."""
        top = module.partition(".")[0]
        ours = file is not None and any(Path(file).resolve().is_relative_to(folder) for folder in self._folders)
        return top in self._packages or (ours and top not in _KEPT and "site-packages" not in str(file))


class Sources:
    """Source files of the components, found by reading their import statements; nothing is imported."""

    def __init__(self, plan: Plan) -> None:
        self._application = Application(plan)
        self._path = [*plan.folders, *sys.path]
        self._found: dict[str, Path | None] = {}
        self._imports: dict[Path, tuple[int, list[str]]] = {}  # with the time of the file's last change

    def files(self, component: ComponentPlan) -> set[Path]:
        """Returns the files of a component's module and of the application's modules that it imports."""
        found: set[Path] = set()
        waiting, seen = [component.module], set[str]()
        while waiting:
            module = waiting.pop()
            if module in seen:
                continue
            seen.add(module)
            file = self._file(module)
            if file and file.suffix == ".py":
                found.add(file)
                waiting += self._imported(module, file)
        return found

    def _imported(self, module: str, file: Path) -> list[str]:
        """Returns the imports of a file; while the file is not valid Python, its former imports."""
        changed = file.stat().st_mtime_ns if file.exists() else 0
        before = self._imports.get(file, (-1, []))
        if before[0] == changed:
            return before[1]
        try:
            tree = ast.parse(file.read_bytes())
        except (OSError, SyntaxError, ValueError):
            return before[1]
        package = module if file.name == "__init__.py" else module.rpartition(".")[0]
        names = [name for node in ast.walk(tree) for name in _names(node, package)]
        self._found.clear()  # a new import may refer to a new file
        self._imports[file] = (changed, names)
        return names

    def _file(self, module: str) -> Path | None:
        if module not in self._found:
            self._found[module] = self._find(module)
        return self._found[module]

    def _find(self, module: str) -> Path | None:
        path: list[str] | None = self._path
        origin = None
        for end in range(1, module.count(".") + 2):
            name = ".".join(module.split(".")[:end])
            spec = PathFinder.find_spec(name, path)
            if spec is None or not self._application.owns(name, spec.origin):
                return None
            path, origin = spec.submodule_search_locations, spec.origin
            if path is None and name != module:
                return None
        return Path(origin).resolve() if origin else None


def _names(node: ast.AST, package: str) -> Iterable[str]:
    """Returns the modules that a statement may import: `from a import b` means `a` and, if it is a module, `a.b`."""
    if isinstance(node, ast.Import):
        for alias in node.names:
            yield from _with_parents(alias.name)
    elif isinstance(node, ast.ImportFrom):
        above = package.split(".")[: package.count(".") + 2 - node.level] if node.level else []
        base = ".".join([*above, *([node.module] if node.module else [])])
        yield from _with_parents(base)
        for alias in node.names:
            yield f"{base}.{alias.name}"


def _with_parents(module: str) -> Iterable[str]:
    parts = module.split(".")
    for end in range(1, len(parts) + 1):
        yield ".".join(parts[:end])


def mistakes(files: Iterable[Path]) -> list[str]:
    """Returns the files that are not valid Python, each with line and reason."""
    found = []
    for file in sorted(files):
        try:
            ast.parse(file.read_bytes(), str(file))
        except OSError as error:
            found.append(f"{shown(file)}: cannot be read: {error.strerror}")
        except SyntaxError as error:
            line = f":{error.lineno}" if error.lineno else ""
            found.append(f"{shown(file)}{line}: {error.msg}")
        except ValueError as error:
            found.append(f"{shown(file)}: {error}")
    return found
