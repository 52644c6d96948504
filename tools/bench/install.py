"""Installs the peers, each into a separate environment below build/bench-peers: python -m tools.bench.install."""

import subprocess
import sys
import venv
from pathlib import Path
from tempfile import TemporaryDirectory

from fwk.program import BAD_INPUT, complain
from tools.bench import ros_build
from tools.bench.environments import ALL, ROS, Environment


def main() -> int:
    """Installs every environment (or those named on the command line); names each that failed and continues."""
    wanted = sys.argv[1:] or [environment.name for environment in ALL]
    known = [environment.name for environment in ALL]
    if unknown := [name for name in wanted if name not in known]:
        complain(f"no environment '{unknown[0]}'; there are {', '.join(known)}")
        return BAD_INPUT
    failed = 0
    for environment in ALL:
        if environment.name not in wanted:
            continue
        try:
            _install(environment)
            reason = environment.missing()
        except (OSError, subprocess.CalledProcessError) as error:
            reason = f"{error} {getattr(error, 'stderr', '') or ''}".strip()
        failed += bool(reason)
        print(f"{environment.name}: {reason or 'ready'}", flush=True)
    return 1 if failed else 0


def _install(environment: Environment) -> None:
    if environment.pip:
        venv.create(environment.folder, with_pip=True, clear=True)
        _run([environment.python, "-m", "pip", "install", "--quiet", *environment.pip])
    elif environment.debian:
        _unpack(environment)
    if environment is ROS:
        ros_build.build()


def _unpack(environment: Environment) -> None:
    """Downloads the packages with those dependencies that the system lacks, and unpacks them without installing."""
    listed = _run(["apt-get", "install", "--simulate", "--no-install-recommends", *environment.debian])
    names = [line.split()[1] for line in listed.splitlines() if line.startswith("Inst ")]
    names += [name for name in environment.debian if name not in names]
    environment.folder.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory() as folder:
        _run(["apt-get", "download", *names], cwd=Path(folder))
        for package in sorted(Path(folder).glob("*.deb")):
            _run(["dpkg-deb", "--extract", str(package), str(environment.folder)])


def _run(command: list[str], cwd: Path | None = None) -> str:
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, check=True).stdout


if __name__ == "__main__":
    sys.exit(main())
