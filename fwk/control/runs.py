"""Finds the runs of this machine: by name, by bus port, by FWK_RUN, or the only one. Imports nothing heavy."""

import contextlib
import os
from collections.abc import Mapping
from typing import Any

from fwk.clock import US_PER_S, monotonic_us
from fwk.control import address
from fwk.control.client import LOOK_S, Client, ControlError, RefusedError

RUN_VARIABLE = "FWK_RUN"
"""Environment variable that names the run that commands use by default."""
_TOGETHER = 64
"""Number of runs that are asked at a time."""
_NEEDED = frozenset(("name", "plan", "pid"))
"""Keys of the answer by which a run is chosen."""
_BUSY_S = 5.0
"""Time that a run which is looked for by name gets to answer if it was silent at first, as on a busy machine."""


def look() -> dict[int, dict[str, Any]]:
    """Returns what each run says about itself, and the user number of its owner, by bus port; runs that do not answer
    in a second have no entry. Root sees the runs of all users.
    """
    ports = address.running()
    found: dict[int, dict[str, Any]] = {}
    for first in range(0, len(ports), _TOGETHER):
        found |= _asked(ports[first : first + _TOGETHER], LOOK_S)
    return found


def _asked(ports: list[int], within_s: float) -> dict[int, dict[str, Any]]:
    """Asks several runs at once, so that silent ones cost no more time than one."""
    clients: dict[int, Client] = {}
    found: dict[int, dict[str, Any]] = {}
    with contextlib.ExitStack() as stack:
        for port in ports:
            with contextlib.suppress(ControlError):
                clients[port] = stack.enter_context(Client(address.supervisor_address(port), within_s))
                clients[port].send("run")
        end_us = monotonic_us() + round(within_s * US_PER_S)
        for port, client in clients.items():
            with contextlib.suppress(ControlError, TimeoutError, EOFError):
                run = client.answer(end_us)
                if run.keys() >= _NEEDED:
                    found[port] = {**run, "owner": client.uid}
    return found


def states() -> list[dict[str, Any]]:
    """Returns the status of each run, with the number of its components in their place; a run that does not answer has
    only its port.
    """
    return [_state(port) for port in sorted(look())]


def _state(port: int) -> dict[str, Any]:
    with contextlib.suppress(ControlError), Client(address.supervisor_address(port), LOOK_S) as run:
        status = run.ask("status")
        found = [each["state"] for each in status.pop("components")]
        return {**status, "components": len(found), "failed": found.count("failed"), "answers": True}
    return {"bus_port": port, "answers": False}


def find(chosen: str | int | None) -> int:
    """Returns the bus port of a run: the one with that name or bus port, else the one that FWK_RUN names, else the only
    one.

    Raises:
        RefusedError: no run, or more than one, has that name; or several runs exist and none is named.
        ControlError: no run exists.
    """
    if chosen == "":
        raise RefusedError("a run has a name or a bus port, not ''; 'fwk ps' lists the runs")
    wanted = str(chosen if chosen is not None else os.environ.get(RUN_VARIABLE, ""))
    by_port = {str(port): port for port in address.running()}
    if wanted in by_port:
        return by_port[wanted]
    if not wanted and len(ports := address.running()) == 1:
        return ports[0]
    runs = look()
    if wanted and all(run["name"] != wanted for run in runs.values()):
        runs = {**runs, **_asked([port for port in address.running() if port not in runs], _BUSY_S)}
    runs = _preferred(runs, wanted)
    if wanted:
        ports = [port for port, run in runs.items() if wanted in (run.get("name"), str(port))]
        if len(ports) == 1:
            return ports[0]
        if ports:
            raise RefusedError(f"several runs are called '{wanted}'; name one by its port: {_listed(runs, ports)}")
        others = f"; there {'are' if len(runs) > 1 else 'is'} {_listed(runs, list(runs))}" if runs else ""
        raise RefusedError(f"no run '{wanted}' on this machine{others}")
    if not runs:
        raise ControlError("nothing runs on this machine; start something with: fwk-launch FILE")
    if len(runs) > 1:
        raise RefusedError(f"several runs on this machine; choose one: {_listed(runs, list(runs))}")
    (port,) = runs
    return port


def meant() -> list[int]:
    """Returns the bus ports of the runs that a command may mean that names none: the user's own, else all."""
    return sorted(_preferred(look(), ""))


def _preferred(runs: dict[int, dict[str, Any]], wanted: str) -> dict[int, dict[str, Any]]:
    """Returns the user's own runs if one of them can be meant, else the runs of all users, which only root sees."""
    own = {port: run for port, run in runs.items() if run.get("owner") == os.geteuid()}
    return own if any(not wanted or run["name"] == wanted for run in own.values()) else runs


def supervisor(chosen: str | int | None) -> Client:
    """Connects to the supervisor of a run.

    Raises:
        ControlError: as `find`.
    """
    return Client(address.supervisor_address(find(chosen)))


def gateway(chosen: str | int | None) -> Client:
    """Connects to the gateway of a run.

    Raises:
        ControlError: as `find`.
    """
    return Client(address.gateway_address(find(chosen)))


def public_bus(about: Mapping[str, Any], instead: str = "") -> str:
    """Returns the URL of the public bus of a run.

    Args:
        about: facts about the run, as its supervisor tells them.
        instead: what helps a user of a run without a public bus.

    Raises:
        ControlError: the run has none.
    """
    url: str = about["public_url"]
    if not url:
        remedy = instead or "its launch file sets 'public_url' to an empty text"
        raise ControlError(f"{about['plan']} has no public bus; {remedy}")
    return url


def _listed(runs: dict[int, dict[str, Any]], ports: list[int]) -> str:
    names = [run.get("name", "") for run in runs.values()]
    own = {port: runs[port].get("name", "") for port in ports}
    words = {port: name if name and names.count(name) == 1 else port for port, name in own.items()}
    return " or ".join(f"--run {word} ({runs[port]['plan']}, pid {runs[port]['pid']})" for port, word in words.items())
