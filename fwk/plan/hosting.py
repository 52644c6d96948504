"""Assigns components to host processes."""

from collections.abc import Collection, Mapping, Sequence
from typing import Literal

from fwk.model.plan import HostPlan

Hosting = Literal["process", "robot", "single"]
ALL = "all"


def share_out(
    names: Sequence[str],
    hosting: Hosting,
    groups: Mapping[str, str],
    later: Collection[str] = (),
    alone: Collection[str] = (),
) -> tuple[HostPlan, ...]:
    """Returns the hosts in the order of their first component.

    `process`: one for each component or group of `groups` (component to group); `robot`: one for each namespace;
    `single`: one for all. Components of `later`, which do not start with the run, and of `alone` have a process each.
    """
    members: dict[str, list[int]] = {}
    for index, name in enumerate(names):
        host = name if name in alone else _host(name, "process" if name in later else hosting, groups)
        members.setdefault(host, []).append(index)
    return tuple(HostPlan(index, host, tuple(inside)) for index, (host, inside) in enumerate(members.items()))


def _host(name: str, hosting: Hosting, groups: Mapping[str, str]) -> str:
    if hosting == "single":
        return ALL
    if hosting == "robot":
        return name.rpartition("/")[0] or name
    return groups.get(name, name)
