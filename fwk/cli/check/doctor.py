"""`fwk doctor`: checks that this machine has what runs need."""

import json
from dataclasses import asdict
from typing import Annotated

import typer

from fwk.cli.check.machine_checks import Severity, all_checks
from fwk.cli.run_options import Json
from fwk.model.plan import Plan
from fwk.model.ports import Ports

_HOSTS, _CHANNELS = 100, 250  # of a large system, every component a process


def doctor(
    bus_port: Annotated[
        int, typer.Option(min=1024, max=65535, help="first port of the run, as for fwk-launch")
    ] = Plan.bus_port,
    as_json: Json = False,
) -> None:
    """Checks multicast, buffers, ports, shared memory, generator and Java, and prints commands that help.

    Exit codes: 0 runs work; 1 they do not.
    """
    findings = [check() for check in all_checks(Ports(bus_port, _HOSTS, _CHANNELS))]
    if as_json:
        typer.echo(json.dumps([asdict(finding) for finding in findings], indent=2))
    for finding in () if as_json else findings:
        typer.echo(f"{finding.level:8} {finding.subject}: {finding.text}")
        if finding.advice:
            typer.echo(f"{'':8} type: {finding.advice}")
    if any(finding.level is Severity.BAD for finding in findings):
        raise typer.Exit(1)
