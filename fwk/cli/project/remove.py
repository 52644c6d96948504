"""`fwk remove reads|writes|serves|calls|setting COMPONENT NAME...`: removes ports or settings of a component."""

from typing import TYPE_CHECKING

import typer

from fwk.cli.project.changing import DryRun
from fwk.cli.project.edit import ComponentWord, Names, remove_each
from fwk.cli.run_options import Json

if TYPE_CHECKING:
    from fwk.scaffold.source import Source

remove = typer.Typer(add_completion=False, no_args_is_help=True)


@remove.callback()
def group() -> None:
    """Removes ports and settings from the class of a component, with imports that nothing else uses.

    Prints the difference, and the places in the file that still use what was removed.
    """


@remove.command("reads")
def reads(component: ComponentWord, names: Names, dry_run: DryRun = False, as_json: Json = False) -> None:
    """Removes readers of channels."""
    _remove("reads", component, names, dry_run, as_json)


@remove.command("writes")
def writes(component: ComponentWord, names: Names, dry_run: DryRun = False, as_json: Json = False) -> None:
    """Removes writers of channels."""
    _remove("writes", component, names, dry_run, as_json)


@remove.command("serves")
def serves(component: ComponentWord, names: Names, dry_run: DryRun = False, as_json: Json = False) -> None:
    """Removes services that the component offers."""
    _remove("serves", component, names, dry_run, as_json)


@remove.command("calls")
def calls(component: ComponentWord, names: Names, dry_run: DryRun = False, as_json: Json = False) -> None:
    """Removes services that the component uses."""
    _remove("calls", component, names, dry_run, as_json)


@remove.command("setting")
def setting(component: ComponentWord, names: Names, dry_run: DryRun = False, as_json: Json = False) -> None:
    """Removes settings with their docstrings."""

    def removed(source: "Source", name: str) -> list[str]:
        from fwk.scaffold.settings import remove_setting  # needs a library that `remove_each` asks for

        return remove_setting(source, name)

    remove_each(component, names, dry_run, as_json, removed)


def _remove(kind: str, component: str, names: list[str], dry_run: bool, as_json: bool) -> None:
    def removed(source: "Source", name: str) -> list[str]:
        from fwk.scaffold.ports import remove_port  # needs a library that `remove_each` asks for

        return remove_port(source, kind, name)

    remove_each(component, names, dry_run, as_json, removed)
