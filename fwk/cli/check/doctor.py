"""`fwk doctor`: checks that this machine has what runs need."""

import json
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.arguments import Hosting
from fwk.cli.check import machine_checks, network_checks, system_checks
from fwk.cli.check.findings import Finding, Severity
from fwk.cli.run_options import Json
from fwk.model.errors import PlanError
from fwk.model.plan import Plan
from fwk.model.ports import Ports
from fwk.plan.load import LaunchOptions, load_plan
from fwk.plan.run_section import default_public_url
from fwk.program import BAD_INPUT

_HOSTS, _CHANNELS = 100, 250  # of a large system, every component a process


def doctor(
    file: Annotated[
        str | None, typer.Argument(metavar="FILE", help="launch file whose ports and processes are checked, too")
    ] = None,
    bus_port: Annotated[
        int, typer.Option(min=1024, max=65535, help="first port of the run, as for fwk-launch")
    ] = Plan.bus_port,
    hosting: Annotated[Hosting, typer.Option(help="distribution of components to processes, as for fwk-launch")] = (
        Hosting.PROCESS
    ),
    record: Annotated[
        Path | None, typer.Option(metavar="FILE", help="recording whose disk is checked, as for fwk-launch")
    ] = None,
    as_json: Json = False,
) -> None:
    """Checks network, ports, memory, libraries, processes, clock, disk and Java, and prints commands that help.

    With a launch file, ports, public bus and number of processes are those of its plan.

    Exit codes: 0 runs work; 1 they do not.
    """
    plan = _plan(file, LaunchOptions(bus_port=bus_port, hosting=hosting.value)) if file else None
    findings = [check() for check in _checks(plan, bus_port, record)]
    if as_json:
        typer.echo(json.dumps([asdict(finding) for finding in findings], indent=2))
    for finding in () if as_json else findings:
        typer.echo(f"{finding.level:8} {finding.subject}: {finding.text}")
        if finding.advice:
            typer.echo(f"{'':8} type: {finding.advice}")
    if any(finding.level is Severity.BAD for finding in findings):
        raise typer.Exit(1)


def _plan(file: str, options: LaunchOptions) -> Plan:
    try:
        return load_plan(file, options)
    except PlanError as error:
        typer.echo(f"{error}\nerror: {file} cannot be run; 'fwk check {file}' says why", err=True)
        raise typer.Exit(BAD_INPUT) from error


def _checks(plan: Plan | None, bus_port: int, record: Path | None) -> list[Callable[[], Finding]]:
    """Returns all checks, the most important first."""
    ports = Ports.of(plan) if plan else Ports(bus_port, _HOSTS, _CHANNELS)
    url = plan.public_url if plan else default_public_url(bus_port)
    return [
        network_checks.multicast_loopback,
        network_checks.multicast_route,
        network_checks.receive_buffers,
        lambda: network_checks.ports(ports),
        lambda: network_checks.public_bus(url, ports),
        machine_checks.shared_memory,
        machine_checks.generator,
        machine_checks.open_files,
        machine_checks.java,
        system_checks.versions,
        system_checks.stale_files,
        system_checks.orphans,
        system_checks.clock,
        lambda: system_checks.disk(record and record.absolute().parent),
        *([lambda: system_checks.cores(plan)] if plan else []),
    ]
