"""`fwk call NAME FIELD=VALUE...`: sends a command or a request to a component of a run."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from fwk.cli.arguments import seconds
from fwk.cli.look.bb import field_lines
from fwk.cli.run_options import Json, RunChoice, ask, asking
from fwk.cli.steer.send import Fields, made
from fwk.control import runs
from fwk.control.client import Client, ControlError, RefusedError
from fwk.lcm import messages
from fwk.lcm.comments import NEEDED, comment_of
from fwk.lcm.messages import MessageError
from fwk.lcm.type_registry import use_types_of
from fwk.model.errors import hint
from fwk.model.service_channels import ANSWERS, OUTSIDE, client_of, service_channel, service_of
from fwk.program import FAILED

TIMEOUT_S = 10.0


def call(
    name: Annotated[str, typer.Argument(metavar="NAME", help="a command or request, such as house/pour")],
    fields: Fields = None,
    timeout_s: Annotated[
        float,
        typer.Option("--timeout", parser=seconds, metavar="SECONDS", help="how long to wait for the last answer"),
    ] = TIMEOUT_S,
    expires_s: Annotated[
        float | None,
        typer.Option(
            "--expires",
            parser=seconds,
            metavar="SECONDS",
            help="logical time after which it is not begun; default: the same",
        ),
    ] = None,
    accepted: Annotated[bool, typer.Option("--accepted", help="do not wait until it is done")] = False,
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Sends a command or a request to the component that carries it out, and shows its answers.

    A component that is stopped or has failed is sent nothing; one that restarts is waited for.

    Exit codes: 0 done, or accepted with --accepted; 1 not done, or no run answers; 2 it could not be sent.
    """
    wanted = ("done", "accepted") if accepted else ("done",)
    with asking():
        last = _called(name, fields or [], timeout_s, expires_s or timeout_s, accepted, chosen)
    well = last["state"] in wanted
    if as_json:
        typer.echo(json.dumps(last))
    else:
        typer.echo(_sentence(last, timeout_s), err=not well)
        for key, value in last["reply"].items() if well else ():
            typer.echo("\n".join(field_lines(key, value, "  ")))
    if not well:
        raise typer.Exit(FAILED)


def _called(
    name: str, fields: list[str], timeout_s: float, expires_s: float, accepted: bool, chosen: str | None
) -> dict[str, Any]:
    """Returns the last answer; after the time-out, the last one until then, with `timed_out`."""
    with runs.gateway(chosen) as gateway:
        data = _encoded(gateway, name, fields, chosen)
        _check_owner(gateway, name, chosen)
        last: dict[str, Any] = {}
        for answer in gateway.follow("call", timeout_s, True, name=name, data=data.hex(), expires_s=expires_s):
            last = {"reply": {}, "reason": "", **answer, "timed_out": False}
            if last["state"] not in ("sent", "accepted") or (accepted and last["state"] == "accepted"):
                return last
    return {**last, "timed_out": True, "owner": _owner(name, chosen)}


def _check_owner(gateway: Client, name: str, chosen: str | None) -> None:
    """Checks that the component that carries the commands out has a process, or gets one without being told.

    Raises:
        ControlError: the component was not started, was stopped, or has failed for good.
    """
    component = _owner_status(gateway, name, chosen)["components"][0]
    if component["state"] in _ENDED and not component["pid"]:
        remedy = "" if "'fwk " in component["reason"] else f"; 'fwk start {component['name']}' starts it"
        raise ControlError(f"{name}: not sent, because {_state(component)}{remedy}")


def _owner(name: str, chosen: str | None) -> str:
    """Returns the component that carries the commands out, with its state, and whether the run is paused."""
    with runs.gateway(chosen) as gateway:
        status = _owner_status(gateway, name, chosen)
    paused = f", but the run is paused after tick {status['tick']}; 'fwk resume' goes on" if status["paused"] else ""
    return _state(status["components"][0]) + paused


def _owner_status(gateway: Client, name: str, chosen: str | None) -> dict[str, Any]:
    """Returns the status of the run with that of the component that carries the commands out."""
    rows = gateway.ask("channels")["channels"]
    owner = next(row["writer"] for row in rows if row["channel"] == service_channel(name, ANSWERS))
    return ask(chosen, "status", names=[owner])


def _state(component: dict[str, Any]) -> str:
    reason = f": {component['reason']}" if component["reason"] else ""
    return f"{component['name']} is {component['state']}{reason}"


def _encoded(gateway: Client, name: str, fields: list[str], chosen: str | None) -> bytes:
    types = {row["channel"]: row["type"] for row in gateway.ask("channels")["channels"]}
    known = {service_of(channel): kind for channel, kind in types.items() if client_of(channel) == OUTSIDE}
    if name not in known:
        otherwise = "" if known else "no component of this run has a port for commands"
        raise RefusedError(f"no component carries out '{name}'; {hint(name, known, otherwise)}")
    for folder in ask(chosen, "run")["folders"]:
        use_types_of(Path(folder))
    try:
        return messages.encode(command_of(known[name], fields), name)
    except MessageError as error:
        raise RefusedError(str(error)) from error


def command_of(type_name: str, fields: list[str]) -> Any:
    """Returns a command with these fields set, as `made` does.

    Raises:
        MessageError: besides, a field is missing that has to be given by the comment beside it.
    """
    command = made(type_name, fields)
    given = {text.partition("=")[0].partition(".")[0] for text in fields}
    for member, kind in zip(command.__slots__, command.__typenames__, strict=True):
        if member not in given and NEEDED in comment_of(type_name, member):
            right = f"{member}=true or {member}=false" if kind == "boolean" else f"{member}=VALUE"
            raise MessageError(f"'{member}' of {type_name} is missing; write {right}")
    return command


def _sentence(last: dict[str, Any], timeout_s: float) -> str:
    if last["timed_out"]:
        lacking = f"no {_LACKING[last['state']]} within {timeout_s:g} s"
        return f"error: {last['name']}: {last['state']}, and {lacking}; {last['owner']}"
    return f"{last['name']}: {last['state']}, tick {last['tick']}{': ' if last['reason'] else ''}{last['reason']}"


_ENDED = ("stopped", "failed")
"""States that only a person ends, once the component has no process."""
_LACKING = {"sent": "answer", "accepted": "last answer"}
