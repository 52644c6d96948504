"""The project around a folder: its root, its package of components, its launch files, and names that are free in it."""

import keyword
import pkgutil
import re
import unicodedata
from dataclasses import dataclass
from pathlib import Path

import lcmtypes
from fwk.model.errors import hint
from fwk.plan.files.launch_file import FOLDER, HOST_SUFFIX, INSTALLED, shown
from fwk.plan.packages import component_packages
from fwk.scaffold.changes import ScaffoldError

NAME_MAX = 24
_DEFAULT_PACKAGE = "parts"
_NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
_UMLAUTS = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss"})
_HUMP = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")

_WORDS = """
abstract alignas alignof auto bool boolean byte catch char const constexpr decltype default delete do double enum
explicit export extends extern final float friend goto implements inline instanceof int interface long mutable
namespace native new noexcept nullptr operator package private protected public register short signed sizeof
static strictfp struct super switch synchronized template this throw throws transient typedef typeid typename
union unsigned using virtual void volatile
"""
_RESERVED = frozenset(_WORDS.split())
"""Words of C++ and Java that cannot name a package of message types there."""


def package_of(root: Path) -> str:
    """Returns the package of a project's components: the first announced one, or `parts`."""
    packages = component_packages() or (_DEFAULT_PACKAGE,)
    there = [each for each in (*packages, _DEFAULT_PACKAGE) if (root / each).is_dir()]
    return (there or packages)[0]


@dataclass(frozen=True)
class Project:
    """A folder with launch files, message types, and a package of components."""

    root: Path

    @property
    def package(self) -> str:
        """Name of the package of components."""
        return package_of(self.root)

    @property
    def launch_files(self) -> list[Path]:
        """All launch files of the project, by name."""
        return sorted(each for each in (self.root / FOLDER).glob("*.yaml") if not each.name.endswith(HOST_SUFFIX))

    def launch_file(self, wanted: str | None) -> Path:
        """Returns the launch file of that name, or the only one.

        Raises:
            ScaffoldError: there is no such file, or a choice is needed.
        """
        names = [each.name for each in self.launch_files]
        if wanted is None:
            if len(names) == 1:
                return self.launch_files[0]
            right = "choose one with --launch" if names else "make one: fwk new launch NAME"
            raise ScaffoldError(f"{shown(self.root / FOLDER)} has {_listed(names)}; {right}")
        name = Path(wanted).name
        for each in self.launch_files:
            if name in (each.name, each.stem):
                return each
        raise ScaffoldError(f"no launch file '{wanted}' in {shown(self.root / FOLDER)}; {hint(name, names)}")


def _listed(names: list[str]) -> str:
    return f"several launch files: {', '.join(names)}" if names else "no launch file"


def project_at(folder: Path) -> Project:
    """Returns the project that contains a folder.

    Raises:
        ScaffoldError: neither the folder nor one above has a folder `launch`.
    """
    for each in (folder.absolute(), *folder.absolute().parents):
        if (each / FOLDER).is_dir():
            return Project(each)
    raise ScaffoldError(
        f"{folder.absolute()} is not in a project: no folder '{FOLDER}' here or above; make one: fwk new project NAME"
    )


def check_name(name: str, what: str) -> str:
    """Returns a name of lower-case words.

    Raises:
        ScaffoldError: the name is not a lower-case identifier, is a keyword of Python, or is too long.
    """
    if not _NAME.fullmatch(name):
        raise ScaffoldError(f"'{name}' is not the name of {what}; write lower-case words, such as {_nearest(name)}")
    if _is_keyword(name):
        raise ScaffoldError(f"'{name}' is a keyword of Python; choose another name for {what}")
    if len(name) > NAME_MAX:
        raise ScaffoldError(f"'{name}' has {len(name)} characters; the name of {what} has at most {NAME_MAX}")
    return name


def _nearest(name: str) -> str:
    """Returns a name of lower-case words that is like another text."""
    letters = unicodedata.normalize("NFKD", _HUMP.sub("_", name).lower().translate(_UMLAUTS))
    ascii_letters = "".join(each for each in letters if not unicodedata.combining(each))
    right = re.sub(r"[^a-z0-9]+", "_", ascii_letters).strip("_0123456789")
    return f"{right}_part" if _is_keyword(right) else right[:NAME_MAX].rstrip("_") or "ball_tracker"


def _is_keyword(name: str) -> bool:
    return keyword.iskeyword(name) or keyword.issoftkeyword(name)


def check_types_are_free(name: str, root: Path) -> None:
    """Checks that a package of message types would not hide an installed one, and works in other languages.

    Raises:
        ScaffoldError: another folder has a package of that name, or the name is a word of C++ or Java.
    """
    if name in _RESERVED:
        raise ScaffoldError(
            f"'{name}' is a word of C++ or Java, where it cannot name message types; choose another name, such as "
            f"{name}_part"
        )
    others = [each for each in lcmtypes.__path__ if Path(each).resolve() != (root / "lcmtypes").resolve()]
    if name in {module.name for module in pkgutil.iter_modules(others)}:
        raise ScaffoldError(f"'{name}' is a package of installed message types; choose another name")


def check_module_is_free(name: str, package: str) -> None:
    """Checks that a module would not hide an installed one.

    Raises:
        ScaffoldError: the installed package of components has a module or package of that name.
    """
    installed = INSTALLED / package / name
    if installed.is_dir() or installed.with_suffix(".py").exists():
        raise ScaffoldError(f"'{package}.{name}' would hide the installed '{package}.{name}'; choose another name")
