"""Finds lines of source code that make a component's outputs differ from run to run, by the syntax alone."""

import ast
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

_TIME = "reads the machine's clock"
_RANDOM = "draws unseeded random numbers"
_THREADS = "starts threads or processes, whose order varies"
_ORDER = "depends on the order of a set"
_PROCESS = "depends on the process: its number, addresses, and hashes of texts"
_ENVIRONMENT = "reads environment variables"
_FILES = "depends on the order of files in a folder"
_CALLS = {
    **dict.fromkeys(("time.time", "time.monotonic", "time.perf_counter", "time.process_time"), _TIME),
    **dict.fromkeys(("time.time_ns", "time.monotonic_ns", "time.perf_counter_ns", "time.process_time_ns"), _TIME),
    **dict.fromkeys(("datetime.datetime.now", "datetime.datetime.utcnow", "datetime.datetime.today"), _TIME),
    **dict.fromkeys(("datetime.date.today", "time.gmtime", "time.localtime"), _TIME),
    **dict.fromkeys(("os.urandom", "uuid.uuid1", "uuid.uuid4", "random.SystemRandom"), _RANDOM),
    **dict.fromkeys(("threading.Thread", "threading.Timer", "_thread.start_new_thread"), _THREADS),
    **dict.fromkeys(("multiprocessing.Process", "multiprocessing.Pool"), _THREADS),
    **dict.fromkeys(("concurrent.futures.ThreadPoolExecutor", "concurrent.futures.ProcessPoolExecutor"), _THREADS),
    **dict.fromkeys(("os.listdir", "os.scandir", "os.walk", "glob.glob", "glob.iglob"), _FILES),
    **dict.fromkeys(("id", "hash", "os.getpid"), _PROCESS),
    **dict.fromkeys(("os.getenv", "os.environ.get"), _ENVIRONMENT),
}
_SEEDED = ("random.Random", "numpy.random.default_rng", "numpy.random.RandomState", "numpy.random.SeedSequence")
"""Generators that are unseeded only without arguments."""
_HARMLESS = ("random.seed", "numpy.random.seed", "numpy.random.Generator", "numpy.random.PCG64")
_IN_ORDER = ("list", "tuple", "enumerate", "iter", "zip", "map", "next", "sum")
"""Functions whose result depends on the order of what they are given; a sum does by the rounding."""
_MAKE_SETS = ("union", "intersection", "difference", "symmetric_difference", "copy")
"""Methods of a set that return a set."""


@dataclass(frozen=True)
class Cause:
    """A line that may make outputs differ."""

    file: str
    line: int
    reason: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.reason}"


def causes(module: str, files: Mapping[str, str]) -> list[Cause]:
    """Returns the causes in a module and in the modules that it imports, each reason once a file.

    Args:
        module: name of the component's module.
        files: files of the application's modules, by name; no other module is looked at.
    """
    found: dict[tuple[str, str], Cause] = {}
    waiting, seen = [module], {module}
    while waiting:
        name = waiting.pop(0)
        try:
            tree = ast.parse(Path(files[name]).read_bytes())
        except (KeyError, OSError, SyntaxError, ValueError):
            continue
        for line, reason in sorted(_Lines(tree).found()):
            found.setdefault((files[name], reason), Cause(files[name], line, reason))
        imported = [each for each in _imports(tree, name) if each in files and each not in seen]
        seen.update(imported)
        waiting += imported
    return list(found.values())


class _Lines:
    """The lines of a module with a cause."""

    def __init__(self, tree: ast.Module) -> None:
        self._tree = tree
        self._names = dict(_aliases(tree))
        self._sets = {target for target, value in _assigned(tree) if self._is_set(value, known=False)}
        self._sets -= {target for target, value in _assigned(tree) if not self._is_set(value, known=False)}

    def found(self) -> Iterator[tuple[int, str]]:
        for node in ast.walk(self._tree):
            if isinstance(node, ast.Call):
                if reason := self._call(node):
                    yield node.lineno, reason
                if self._takes_order(node):
                    yield node.lineno, _ORDER
            elif isinstance(node, ast.Starred) and self._is_set(node.value):
                yield node.lineno, _ORDER
            elif isinstance(node, (ast.For, ast.comprehension)) and self._is_set(node.iter):
                yield node.iter.lineno, _ORDER
            elif isinstance(node, ast.Subscript) and self._dotted(node.value) == "os.environ":
                yield node.lineno, _ENVIRONMENT

    def _call(self, node: ast.Call) -> str:
        name = self._dotted(node.func)
        if name in _CALLS:
            return _CALLS[name]
        if name in _SEEDED:
            return "" if node.args or node.keywords else _RANDOM
        if name.startswith(("random.", "numpy.random.", "secrets.")) and name not in _HARMLESS:
            return _RANDOM
        return ""

    def _takes_order(self, node: ast.Call) -> bool:
        """Returns whether the result of a call depends on the order of a set."""
        method = node.func.attr if isinstance(node.func, ast.Attribute) else ""
        if method == "pop" and isinstance(node.func, ast.Attribute):
            return not node.args and self._is_set(node.func.value)
        return (method == "join" or self._dotted(node.func) in _IN_ORDER) and any(map(self._is_set, node.args))

    def _is_set(self, node: ast.expr, known: bool = True) -> bool:
        if isinstance(node, ast.BinOp) and isinstance(node.op, (ast.BitOr, ast.BitAnd, ast.Sub, ast.BitXor)):
            return self._is_set(node.left, known)
        if isinstance(node, ast.Call):
            if isinstance(node.func, ast.Attribute) and node.func.attr in _MAKE_SETS:
                return self._is_set(node.func.value, known)
            return self._dotted(node.func) in ("set", "frozenset")
        if known and isinstance(node, (ast.Name, ast.Attribute)):
            return ast.unparse(node) in self._sets
        return isinstance(node, (ast.Set, ast.SetComp))

    def _dotted(self, node: ast.expr) -> str:
        """Returns the full name of what is called, such as `numpy.random.rand`."""
        parts: list[str] = []
        while isinstance(node, ast.Attribute):
            parts.insert(0, node.attr)
            node = node.value
        if not isinstance(node, ast.Name):
            return ""
        return ".".join([self._names.get(node.id, node.id), *parts])


def _aliases(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """Yields the names that imports bind, each with what it stands for."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for each in node.names:
                yield (each.asname, each.name) if each.asname else (each.name.partition(".")[0],) * 2
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            for each in node.names:
                yield each.asname or each.name, f"{node.module}.{each.name}"


def _assigned(tree: ast.Module) -> Iterator[tuple[str, ast.expr]]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign):
            yield from ((ast.unparse(target), node.value) for target in node.targets)
        elif isinstance(node, ast.AnnAssign) and node.value:
            yield ast.unparse(node.target), node.value


def _imports(tree: ast.Module, module: str) -> Iterable[str]:
    """Yields the full names of all modules that a module may import."""
    package = module.rpartition(".")[0]
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (each.name for each in node.names)
        elif isinstance(node, ast.ImportFrom):
            outer = package.rsplit(".", node.level - 1)[0] if node.level else ""
            base = ".".join(filter(None, (outer, node.module)))
            yield base
            yield from (f"{base}.{each.name}" for each in node.names)
