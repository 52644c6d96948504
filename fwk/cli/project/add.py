"""`fwk add reads|writes|serves|calls|setting COMPONENT ...`: adds a port or a setting to a component."""

import typer

from fwk.cli.project.changing import DryRun, explaining
from fwk.cli.project.edit import (
    Channel,
    ComponentWord,
    EachFlag,
    History,
    Meaning,
    PortWords,
    ServiceWords,
    add_ports,
    finish,
    open_source,
)
from fwk.cli.run_options import Json
from fwk.scaffold.changes import ScaffoldError

add = typer.Typer(add_completion=False, no_args_is_help=True)


@add.callback()
def group() -> None:
    """Adds ports and settings to the class of a component, with their imports, and prints the difference.

    Everything else in the file stays as it is. What the component has already is not added again.
    """


@add.command("reads")
def reads(
    component: ComponentWord,
    ports: PortWords,
    each: EachFlag = False,
    channel: Channel = "",
    history: History = 0,
    dry_run: DryRun = False,
    as_json: Json = False,
) -> None:
    """Adds readers of channels."""
    add_ports("reads", component, ports, dry_run, as_json, each=each, channel=channel, history=history)


@add.command("writes")
def writes(
    component: ComponentWord,
    ports: PortWords,
    each: EachFlag = False,
    channel: Channel = "",
    dry_run: DryRun = False,
    as_json: Json = False,
) -> None:
    """Adds writers of channels."""
    add_ports("writes", component, ports, dry_run, as_json, each=each, channel=channel)


@add.command("serves")
def serves(
    component: ComponentWord,
    services: ServiceWords,
    each: EachFlag = False,
    channel: Channel = "",
    dry_run: DryRun = False,
    as_json: Json = False,
) -> None:
    """Adds services that the component offers: commands, or requests with a reply."""
    add_ports("serves", component, services, dry_run, as_json, each=each, channel=channel)


@add.command("calls")
def calls(
    component: ComponentWord,
    services: ServiceWords,
    each: EachFlag = False,
    channel: Channel = "",
    dry_run: DryRun = False,
    as_json: Json = False,
) -> None:
    """Adds services of other components that the component uses."""
    add_ports("calls", component, services, dry_run, as_json, each=each, channel=channel)


@add.command("setting")
def setting(
    component: ComponentWord,
    name: str = typer.Argument(metavar="NAME:TYPE=VALUE", help="setting with its default, such as gain:float=0.3"),
    meaning: Meaning = "",
    dry_run: DryRun = False,
    as_json: Json = False,
) -> None:
    """Adds a setting, and the class of settings if the component has none. Types: bool, int, float, str."""
    with explaining():
        left, equals, default = name.partition("=")
        word, colon, kind = left.partition(":")
        if not equals or not colon:
            raise ScaffoldError(f"'{name}' is not a setting; write NAME:TYPE=VALUE, such as gain:float=0.3")
        _, source = open_source(component)
        from fwk.scaffold.settings import SettingRequest, add_setting, python_value

        add_setting(source, SettingRequest(word, kind, python_value(kind, default), meaning))
        finish(source, dry_run, as_json)
