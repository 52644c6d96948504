"""Resources used by a tree of processes, read from /proc: CPU time, context switches, memory, datagrams."""

from dataclasses import dataclass
from pathlib import Path

_PROC = Path("/proc")


@dataclass(frozen=True)
class Usage:
    """Counters of a moment; the difference of two counts the events in between."""

    cpu_us: float = 0.0
    switches: int = 0
    datagrams_read: int = 0
    datagrams_dropped: int = 0

    def __sub__(self, other: "Usage") -> "Usage":
        return Usage(
            self.cpu_us - other.cpu_us,
            self.switches - other.switches,
            self.datagrams_read - other.datagrams_read,
            self.datagrams_dropped - other.datagrams_dropped,
        )


def descendants(pid: int) -> list[int]:
    """Returns the process ids of all descendants of `pid`."""
    children: dict[int, list[int]] = {}
    for folder in _PROC.iterdir():
        if folder.name.isdigit():
            try:
                parent = int((folder / "stat").read_text().rpartition(")")[2].split()[1])
            except OSError:  # it has ended
                continue
            children.setdefault(parent, []).append(int(folder.name))
    found, waiting = [], [pid]
    while waiting:
        below = children.get(waiting.pop(), [])
        found += below
        waiting += below
    return sorted(found)


def usage(pids: list[int]) -> Usage:
    """Returns CPU time and context switches of all threads of processes so far; datagrams of this network namespace."""
    cpu_ns = switches = 0
    for pid in pids:
        for task in (_PROC / str(pid) / "task").glob("*"):
            try:
                cpu_ns += int((task / "schedstat").read_text().split()[0])
                for line in (task / "status").read_text().splitlines():
                    if "ctxt_switches" in line:
                        switches += int(line.split()[1])
            except OSError:  # a thread that has ended
                continue
    udp = _udp_counters()
    return Usage(cpu_ns / 1000, switches, udp["InDatagrams"], udp["RcvbufErrors"])


def pss_mb(pids: list[int]) -> float:
    """Returns the memory of processes in MB, shared pages counted once."""
    total_kb = 0
    for pid in pids:
        try:
            lines = (_PROC / str(pid) / "smaps_rollup").read_text().splitlines()
        except OSError:
            continue
        total_kb += sum(int(line.split()[1]) for line in lines if line.startswith("Pss:"))
    return total_kb / 1000


def threads(pids: list[int]) -> int:
    """Returns the number of threads of processes."""
    return sum(len(list((_PROC / str(pid) / "task").glob("*"))) for pid in pids)


def _udp_counters() -> dict[str, int]:
    lines = [line.split() for line in Path("/proc/self/net/snmp").read_text().splitlines() if line.startswith("Udp:")]
    return dict(zip(lines[0][1:], map(int, lines[1][1:]), strict=True))
