"""Checks of processes, memory and programs: each tries one thing that runs need, and names a command that helps."""

import mmap
import os
import resource
import shutil
import subprocess

from fwk.cli.check.findings import Finding, Severity
from fwk.lcm.typegen import lcm_gen

_FILES = 1024  # a supervisor of a hundred processes, or a gateway to a few hundred channels


def java() -> Finding:
    """Checks the programs that `fwk spy` needs."""
    missing = [program for program in ("java", "javac") if not shutil.which(program)]
    if missing:
        text = f"no {', '.join(missing)}: 'fwk spy' does not work"
        return Finding(Severity.WARNING, "Java", text, "sudo apt install default-jdk")
    return Finding(Severity.OK, "Java", "installed, for 'fwk spy'")


def shared_memory() -> Finding:
    """Checks that processes can share camera frames."""
    subject = "shared memory (memfd)"
    try:
        descriptor = os.memfd_create("fwk-doctor")
        try:
            os.ftruncate(descriptor, mmap.PAGESIZE)
            with mmap.mmap(descriptor, mmap.PAGESIZE) as memory, open(f"/proc/self/fd/{descriptor}", "rb") as other:
                memory[:4] = b"seen"
                works = other.read(4) == b"seen"
        finally:
            os.close(descriptor)
    except OSError as error:
        return Finding(Severity.BAD, subject, f"{error.strerror}: cameras do not work")
    return Finding(
        Severity.OK if works else Severity.BAD, subject, "works" if works else "a second mapping reads other bytes"
    )


def generator() -> Finding:
    """Checks that message types can be generated."""
    subject, advice = "lcm-gen", "pip install --force-reinstall lcm; sudo apt install libglib2.0-0"
    try:
        result = subprocess.run([lcm_gen(), "--version"], capture_output=True, text=True, check=False)
    except OSError as error:
        return Finding(Severity.BAD, subject, f"{lcm_gen()}: {error.strerror}", advice)
    if result.returncode:
        return Finding(Severity.BAD, subject, f"{lcm_gen()}: {result.stderr.strip()}", advice)
    return Finding(Severity.OK, subject, result.stdout.strip())


def open_files() -> Finding:
    """Checks the number of files and sockets that a process may open."""
    limit, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if limit == resource.RLIM_INFINITY or limit >= _FILES:
        return Finding(Severity.OK, "open files", f"{limit} a process")
    allowed = hard == resource.RLIM_INFINITY or hard >= _FILES
    advice = f"ulimit -n {_FILES}" if allowed else f"sudo prlimit --pid $$ --nofile={_FILES}"
    return Finding(Severity.WARNING, "open files", f"{limit} a process: large launch files need {_FILES}", advice)
