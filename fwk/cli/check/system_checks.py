"""Checks of installation, processes, clock and disk, and of a plan on this machine."""

import errno
import os
import re
import tempfile
from collections.abc import Callable, Iterable
from importlib import metadata
from pathlib import Path

import psutil

import lcmtypes
from fwk.cli.check.findings import Finding, Severity
from fwk.cli.run.run_directory import RUNS
from fwk.clock import US_PER_S, monotonic_us, wall_us
from fwk.display.cores import usable_cores
from fwk.display.plan_overview import counted, fewer_processes
from fwk.lcm.typegen import stale_types
from fwk.model.plan import Plan

_REQUIREMENT = re.compile(r"([\w.-]+)(\[[^]]*\])?\s*(?:>=\s*([\d.]+))?")
_TITLE = "fwk: "
_OWNERS = (" supervisor",)
_CLOCK_SOURCE = Path("/sys/devices/system/clocksource/clocksource0/current_clocksource")
_FAST_CLOCKS = (
    "tsc",
    "kvm-clock",
    "arch_sys_counter",
    "hyperv_clocksource_tsc_page",
    "hyperv_clocksource",
    "xen",
    "riscv_clocksource",
)
_EARLIEST_US = 1_735_689_600 * US_PER_S  # 2025-01-01: before it no version of fwk existed
_DISK_BYTES = 8 << 20
_DISK_BYTES_PER_S = 10 << 20  # a recording of ten robots is a tenth of that
_PROCESSES_PER_CORE = 8


def versions(requirements: Iterable[str] | None = None) -> Finding:
    """Checks that the libraries are there, in versions that fwk works with; by default those that fwk names."""
    subject, wrong, names = "versions of libraries", [], []
    for text in metadata.requires("fwk") or () if requirements is None else requirements:
        found = _REQUIREMENT.match(text)
        if not found or "extra ==" in text:
            continue
        name, least = found[1], found[3]
        try:
            version = metadata.version(name)
        except metadata.PackageNotFoundError:
            wrong.append(f"{name} is missing")
        else:
            if not least or _parts(version) >= _parts(least):
                continue
            wrong.append(f"{name} {version}, needed {least}")
        names.append(f"'{name}>={least}'" if least else name)
    if wrong:
        return Finding(Severity.BAD, subject, ", ".join(wrong), f"pip install --upgrade {' '.join(names)}")
    return Finding(Severity.OK, subject, "as needed")


def _parts(version: str) -> list[int]:
    return [int(each) for each in re.findall(r"\d+", version)[:3]]


def stale_files(folders: Iterable[str] | None = None) -> Finding:
    """Checks that the classes of message types are those of their .lcm files.

    By default these are all types in use, and those of the project in the present folder.
    """
    subject = "message types"
    searched = dict.fromkeys(map(os.path.abspath, [*lcmtypes.__path__, "lcmtypes"] if folders is None else folders))
    old = [each for folder in searched for each in stale_types(Path(folder))]
    if old:
        text = f"the classes of {', '.join(str(each) for each in old[:3])} are not those of the file"
        parents = " ".join(dict.fromkeys(str(each.parent) for each in old))
        return Finding(Severity.WARNING, subject, text, f"python -m fwk.lcm.typegen {parents}")
    return Finding(Severity.OK, subject, "generated from their files")


def orphans(titles: Callable[[], dict[int, tuple[int, str]]] | None = None) -> Finding:
    """Checks that each process of a run has its supervisor; `titles` gives parent and title of all processes."""
    subject = "processes of runs"
    found = (titles or _titles)()
    ours = {pid: (parent, title) for pid, (parent, title) in found.items() if title.startswith(_TITLE)}
    left = [pid for pid, (parent, title) in ours.items() if parent not in ours and not title.endswith(_OWNERS)]
    if left:
        text = ", ".join(f"{pid} ({ours[pid][1].removeprefix(_TITLE)})" for pid in left[:5])
        return Finding(
            Severity.WARNING, subject, f"without a supervisor: {text}", f"kill -9 {' '.join(map(str, left))}"
        )
    runs = sum(title.endswith(_OWNERS) for _, title in ours.values())
    return Finding(Severity.OK, subject, f"{counted(runs, 'run')}, no process left behind")


def _titles() -> dict[int, tuple[int, str]]:
    found = {}
    for process in psutil.process_iter(["ppid", "cmdline"]):
        title = " ".join(process.info["cmdline"] or ()).rstrip()  # padded to the length of the command line before
        found[process.pid] = (process.info["ppid"] or 0, title)
    return found


def clock(source: Path = _CLOCK_SOURCE, now_us: Callable[[], int] = wall_us) -> Finding:
    """Checks that the clock is set and quick to read."""
    subject = "clock"
    if now_us() < _EARLIEST_US:
        return Finding(
            Severity.WARNING,
            subject,
            "the date is before 2025: times in logs are wrong",
            "sudo timedatectl set-ntp true",
        )
    name = source.read_text().strip() if source.is_file() else ""
    if name and name not in _FAST_CLOCKS:
        text = f"the kernel reads '{name}', which is slow: ticks take longer"
        available = source.with_name("available_clocksource")
        offered = available.read_text().split() if available.is_file() else []
        fast = next((each for each in _FAST_CLOCKS if each in offered), "")
        advice = f"echo {fast} | sudo tee {source}" if fast else "sudo dmesg | grep -i clocksource"
        return Finding(Severity.WARNING, subject, text if fast else f"{text}, and it offers no faster one", advice)
    return Finding(Severity.OK, subject, f"set, read from {name}" if name else "set")


def disk(folder: Path | None = None, now_us: Callable[[], int] = monotonic_us) -> Finding:
    """Checks that the disk of the run directories is there and takes recordings quickly."""
    place = folder or Path.home() / RUNS
    subject = f"disk of {place}"
    there = next(each for each in (place, *place.parents) if each.is_dir())
    try:
        with tempfile.TemporaryFile(dir=there) as file:
            began = now_us()
            file.write(bytes(_DISK_BYTES))
            file.flush()
            os.fsync(file.fileno())
            seconds = max(now_us() - began, 1) / US_PER_S
    except OSError as error:
        return Finding(Severity.BAD, subject, f"{error.strerror}: nothing is recorded", _disk_advice(error, there))
    rate = _DISK_BYTES / seconds
    text = f"writes {rate / (1 << 20):.0f} MiB/s"
    if rate < _DISK_BYTES_PER_S:
        advice = "fwk-launch FILE --record /dev/shm/log.lcm"
        return Finding(Severity.WARNING, subject, f"{text}: a recording of a large system may lose messages", advice)
    return Finding(Severity.OK, subject, text)


def _disk_advice(error: OSError, folder: Path) -> str:
    if error.errno in (errno.ENOSPC, errno.EDQUOT):
        return f"fwk runs prune --keep 10; if it is still full: du -xh {folder} | sort -h | tail"
    if error.errno == errno.EROFS:
        return f"sudo mount -o remount,rw $(findmnt -no TARGET --target {folder})"
    return f"sudo chown $USER {folder}; chmod u+rwx {folder}"


def cores(plan: Plan, count: int | None = None) -> Finding:
    """Checks that the machine has enough cores for the processes of a plan."""
    cores_ = count or usable_cores()
    text = f"{counted(len(plan.hosts), 'process', 'processes')} on {counted(cores_, 'core')}"
    most = _PROCESSES_PER_CORE * cores_
    if len(plan.hosts) > most:
        slow = "late components in real time" if plan.clock == "wall" else "slow ticks"
        advice = f"fwk-launch FILE {fewer_processes(plan, most)}"
        return Finding(Severity.WARNING, f"cores for {plan.name}", f"{text}: {slow}", advice)
    return Finding(Severity.OK, f"cores for {plan.name}", text)
