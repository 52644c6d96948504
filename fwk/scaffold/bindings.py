"""Generates the message types of a project and of the framework for C, C++ and Java."""

import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import lcm

from fwk.lcm.lcm_file import Struct
from fwk.lcm.typegen import lcm_gen
from fwk.model.errors import hint
from fwk.scaffold.changes import ScaffoldError
from fwk.scaffold.project import Project
from fwk.scaffold.types import known_types, type_folders

_HEADER = Path(__file__).with_name("native") / "fwk.h"
_OPTIONS = {
    "c": ("--c", "--c-no-pubsub", "--c-cpath", "{folder}", "--c-hpath", "{folder}"),
    "cpp": ("--cpp", "--cpp-hpath", "{folder}"),
    "java": ("--java", "--jpath", "{folder}"),
}
_MADE = "made"
LANGUAGES = tuple(_OPTIONS)
_WHEEL = Path(lcm.__file__).parent.parent


def generate_bindings(project: Project, language: str, folder: Path, packages: Sequence[str] = ()) -> list[Path]:
    """Writes the types for a language into a folder, for C and C++ also fwk.h; returns the files that it holds then.

    Args:
        project: Project whose types are written, with all types that they contain.
        language: One of `LANGUAGES`.
        folder: Folder to write to.
        packages: Installed packages whose types are written, too.

    Raises:
        ScaffoldError: the language or a package is not known, an .lcm file has mistakes, or lcm-gen cannot be run.
    """
    if language not in _OPTIONS:
        raise ScaffoldError(f"no types for '{language}'; {hint(language, _OPTIONS)}")
    wanted = _wanted(project, packages)
    options = [each.format(folder=_MADE) for each in _OPTIONS[language]]
    command = [str(lcm_gen()), *options, *sorted({str(each.file) for each in wanted.values()})]
    with tempfile.TemporaryDirectory() as made:
        (Path(made) / _MADE).mkdir()
        try:
            done = subprocess.run(command, cwd=made, capture_output=True, text=True, check=False)
        except OSError as error:
            raise ScaffoldError(f"cannot run {command[0]}: {error.strerror}") from error
        if done.returncode:
            raise ScaffoldError(f"lcm-gen: {' '.join((done.stderr or done.stdout).split())}")
        _copy(Path(made) / _MADE, folder, wanted)
    if language != "java":
        shutil.copyfile(_HEADER, folder / _HEADER.name)
    return sorted(path for path in folder.rglob("*") if path.is_file())


def _wanted(project: Project, packages: Sequence[str]) -> dict[str, Struct]:
    """Returns the structs of the project and of `packages`, and all structs that they contain, by full name."""
    known = known_types(project)
    own = type_folders(project)[0]
    names = {struct.package for struct in known.values()}
    for each in packages:
        if each not in names:
            raise ScaffoldError(f"no package of message types '{each}'; {hint(each, names)}")
    waiting = [name for name, each in known.items() if each.file.is_relative_to(own) or each.package in packages]
    wanted: dict[str, Struct] = {}
    while waiting:
        name = waiting.pop()
        if name in known and name not in wanted:
            wanted[name] = known[name]
            waiting += [known[name].full_type(member) for member in known[name].members]
    return wanted


def _copy(made: Path, folder: Path, wanted: Mapping[str, Struct]) -> None:
    """Copies the files of the wanted structs; lcm-gen makes those of whole packages."""
    names = {name.replace(".", separator) for name in wanted for separator in "_/"}
    for path in sorted(made.rglob("*")):
        place = path.relative_to(made)
        if path.is_file() and str(place.with_suffix("")) in names:
            (folder / place).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, folder / place)


def compile_line(language: str, folder: Path) -> str:
    """Returns a command that compiles a program with the types in a folder."""
    include = f"-I{folder} -I{_WHEEL / 'include'}"
    return {
        "c": f"cc -O2 {include} -o program program.c {folder}/*.c",
        "cpp": f"c++ -O2 {include} -o program program.cpp",
        "java": f'javac -cp "$(fwk spy --jar)" -d {folder} $(find {folder} -name "*.java")',
    }[language]
