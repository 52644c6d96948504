"""lcm-spy with our types: Java classes of all .lcm files in one jar, built once for each content."""

import hashlib
import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

import lcm

from fwk.lcm.typegen import lcm_gen

_MEMORY = "-Xmx1g"  # lcm-spy's own limit of 128 MB makes it freeze on large messages


class SpyError(Exception):
    """lcm-spy or its jar cannot be had; says what is missing and what to type."""


def lcm_spy() -> Path:
    """The lcm-spy program that the lcm wheel brings."""
    return lcm_gen().with_name("lcm-spy")


def lcm_jar() -> Path:
    """LCM's own Java classes, of the same wheel."""
    return Path(lcm.__file__).parent.parent / "share" / "java" / "lcm.jar"


def cache_folder() -> Path:
    """Where jars are kept: `$XDG_CACHE_HOME/fwk` or `~/.cache/fwk`."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "fwk"


def class_path(jar: Path) -> str:
    """What Java programs need to read and write our types."""
    return os.pathsep.join([str(jar), str(lcm_jar())])


def build_jar(folders: Sequence[Path], cache: Path) -> Path:
    """The jar of all .lcm files in `folders`, from the cache if it has been built before.

    Of a type that several folders define the first folder's counts, as in Python.

    Raises:
        SpyError: no .lcm files, no Java compiler, or a file that lcm-gen or javac refuses.
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
            )  # whole or not at all, whoever else builds it now
    return jar


def start(jar: Path, url: str) -> None:
    """Becomes lcm-spy, listening on `url`; does not return.

    Raises:
        SpyError: there is no Java or no display.
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
    _require("jar", "default-jdk-headless")
    java, classes, jar = workshop / "java", workshop / "classes", workshop / "types.jar"
    classes.mkdir()
    for folder in reversed(sources):  # a type that several folders define is overwritten by the first folder's
        _run([str(lcm_gen()), "--java", "--jpath", str(java), *map(str, folder)], workshop)
    files = sorted(map(str, java.rglob("*.java")))
    hint = "; a member whose name is a Java keyword is the usual cause"
    compiler = ["javac", "-nowarn", "-encoding", "UTF-8", "-cp", str(lcm_jar()), "-d", str(classes)]
    _run([*compiler, *files], java, hint)
    _run(["jar", "cf", str(jar), "-C", str(classes), "."], workshop)
    return jar


def _run(command: Sequence[str], below: Path, hint: str = "") -> None:
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode:
        said = (result.stderr or result.stdout).strip().replace(f"{below}/", "")
        first = "\n".join(said.splitlines()[:3])
        raise SpyError(f"{Path(command[0]).name} refuses:\n{first}{hint}")


def _require(program: str, package: str) -> None:
    if not shutil.which(program):
        raise SpyError(f"no '{program}' on the path; lcm-spy needs Java: apt install {package}")
