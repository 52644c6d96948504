"""`fwk doctor`: checks that this machine has what runs need."""

import json
from dataclasses import asdict
from typing import Annotated

import typer

from fwk.cli.check.machine_checks import Severity, all_checks
from fwk.cli.check.system_checks import system_checks
from fwk.cli.output import BAD_INPUT
from fwk.cli.run_options import Json
from fwk.model.errors import PlanError
from fwk.model.plan import Plan
from fwk.model.ports import Ports
from fwk.plan.load import LaunchOptions, load_plan

_HOSTS, _CHANNELS = 100, 250  # of a large system, every component a process


def doctor(
    file: Annotated[
        str | None, typer.Argument(metavar="FILE", help="launch file whose ports and processes are checked, too")
    ] = None,
    bus_port: Annotated[
        int, typer.Option(min=1024, max=65535, help="first port of the run, as for fwk-launch")
    ] = Plan.bus_port,
    as_json: Json = False,
) -> None:
    """Checks network, ports, memory, libraries, processes, clock, disk and Java, and prints commands that help.

    With a launch file, the ports and the number of processes are those of its plan.

    Exit codes: 0 runs work; 1 they do not.
    """
    plan = _plan(file) if file else None
    n_hosts, n_channels = (len(plan.hosts), len(plan.channels) + plan.spare_channels) if plan else (_HOSTS, _CHANNELS)
    checks = [*all_checks(Ports(bus_port, n_hosts, n_channels)), *system_checks(plan)]
    findings = [check() for check in checks]
    if as_json:
        typer.echo(json.dumps([asdict(finding) for finding in findings], indent=2))
    for finding in () if as_json else findings:
        typer.echo(f"{finding.level:8} {finding.subject}: {finding.text}")
        if finding.advice:
            typer.echo(f"{'':8} type: {finding.advice}")
    if any(finding.level is Severity.BAD for finding in findings):
        raise typer.Exit(1)


def _plan(file: str) -> Plan:
    try:
        return load_plan(file, LaunchOptions())
    except PlanError as error:
        typer.echo(f"{error}\nerror: {file} cannot be run; 'fwk check {file}' says why", err=True)
        raise typer.Exit(BAD_INPUT) from error
