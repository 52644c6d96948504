"""lcm-spy with the types of a run: Java classes of all .lcm files in one jar, built once for each set of files."""

import hashlib
import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

import lcm

from fwk.lcm.typegen import lcm_gen

_JAVAC = ("javac", "-J-XX:TieredStopAtLevel=1", "-J-XX:+UseSerialGC", "-J-Xshare:auto")
"""The compiler with options that shorten the life of a short program: less than half the processor time."""
_MEMORY = "-Xmx1g"  # lcm-spy's own limit of 128 MB makes it freeze on large messages


class SpyError(Exception):
    """lcm-spy or its jar is not available; the text names the missing part and the command that helps."""


def lcm_spy() -> Path:
    """Returns the path of the lcm-spy program in the lcm wheel."""
    return lcm_gen().with_name("lcm-spy")


def lcm_jar() -> Path:
    """Returns the path of LCM's Java classes in the lcm wheel."""
    return Path(lcm.__file__).parent.parent / "share" / "java" / "lcm.jar"


def cache_folder() -> Path:
    """Returns the folder of built jars: `$XDG_CACHE_HOME/fwk` or `~/.cache/fwk`."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "fwk"


def class_path(jar: Path) -> str:
    """Returns the Java class path for reading and writing the types of `folders`."""
    return os.pathsep.join([str(jar), str(lcm_jar())])


def build_jar(folders: Sequence[Path], cache: Path) -> Path:
    """Returns the jar of all .lcm files in `folders`, from the cache if it exists.

    If several folders define a type, the first one counts, as in Python.

    Raises:
        SpyError: there are no .lcm files or no Java compiler, or lcm-gen or javac refuses a file.
    """
    sources = {folder: found for folder in folders if (found := sorted(folder.glob("*.lcm")))}
    if not sources:
        raise SpyError(f"no .lcm files in {', '.join(map(str, folders))}")
    key = hashlib.sha256(lcm_jar().read_bytes())
    for content in (source.read_bytes() for found in sources.values() for source in found):
        key.update(len(content).to_bytes(8, "big") + content)
    jar = cache / f"types-{key.hexdigest()[:16]}.jar"
    if not jar.exists():
        cache.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=cache, prefix="building-") as workshop:
            os.replace(
                _build(list(sources.values()), Path(workshop)), jar
            )  # atomic, as another process may build it too
    return jar


def start(jar: Path, url: str) -> None:
    """Replaces the process by lcm-spy, which listens on `url`; does not return.

    Raises:
        SpyError: Java or a display is missing.
    """
    _require("java", "default-jre")
    if not os.environ.get("DISPLAY"):
        raise SpyError("no display (DISPLAY is not set); lcm-spy draws a window. In a terminal, type 'fwk bb watch'")
    others = os.environ.get("CLASSPATH")
    environment = {
        **os.environ,
        "CLASSPATH": os.pathsep.join([str(jar), *([others] if others else [])]),
        "LCM_JVM_OPT": os.environ.get("LCM_JVM_OPT") or _MEMORY,
    }
    os.execve(lcm_spy(), [str(lcm_spy()), f"--lcm-url={url}"], environment)


def _build(sources: Sequence[Sequence[Path]], workshop: Path) -> Path:
    _require("javac", "default-jdk-headless")
    java, classes = workshop / "java", workshop / "classes"
    classes.mkdir()
    for folder in reversed(sources):  # a type that several folders define is overwritten by the first folder's
        _run([str(lcm_gen()), "--java", "--jpath", str(java), *map(str, folder)], workshop)
    files = sorted(map(str, java.rglob("*.java")))
    hint = "; a member whose name is a Java keyword is the usual cause"
    compiler = [*_JAVAC, "-nowarn", "-encoding", "UTF-8", "-cp", str(lcm_jar()), "-d", str(classes)]
    _run([*compiler, *files], java, hint)
    return Path(shutil.make_archive(str(workshop / "types"), "zip", classes))  # the `jar` program takes a second


def _run(command: Sequence[str], below: Path, hint: str = "") -> None:
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode:
        said = (result.stderr or result.stdout).strip().replace(f"{below}/", "")
        first = "\n".join(said.splitlines()[:3])
        raise SpyError(f"{Path(command[0]).name} reports:\n{first}{hint}")


def _require(program: str, package: str) -> None:
    if not shutil.which(program):
        raise SpyError(f"no '{program}' on the path; lcm-spy needs Java: apt install {package}")
