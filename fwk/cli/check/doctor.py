"""`fwk doctor`: does this machine have what runs need?"""

from typing import Annotated

import typer

from fwk.cli.check.machine_checks import Level, all_checks
from fwk.model.plan import Plan
from fwk.model.ports import Ports

_HOSTS, _CHANNELS = 100, 250  # of a large system, every component a process


def doctor(
    bus_port: Annotated[int, typer.Option(min=1024, max=65535, help="as for fwk-launch")] = Plan.bus_port,
) -> None:
    """Checks multicast, buffers, ports, shared memory, generator and Java, and says what to type.

    Exit code 0: runs work; 1: they do not.
    """
    findings = [check() for check in all_checks(Ports(bus_port, _HOSTS, _CHANNELS))]
    for finding in findings:
        typer.echo(f"{finding.level:8} {finding.subject}: {finding.text}")
        if finding.advice:
            typer.echo(f"{'':8} type: {finding.advice}")
    if any(finding.level is Level.BAD for finding in findings):
        raise typer.Exit(1)
