"""Options shared by the commands that load a launch file."""

from typing import Annotated

import typer

from fwk.cli.arguments import Hosting

Sets = Annotated[list[str] | None, typer.Option("--set", metavar="PATH=VALUE", help="override a setting; repeatable")]
ProcessHosting = Annotated[Hosting, typer.Option(help="one process a component, one a namespace, or one for all")]
