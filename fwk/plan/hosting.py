"""Shares components out to processes."""

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
    """Hosts in the order of their first component.

    `process`: one a component, unless `groups` (component to group) says otherwise; `robot`: one a namespace; `single`:
    one for all. Those of `later` do not start with the run, so they keep processes of their own; those in
    `alone` have one each in any case.
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
