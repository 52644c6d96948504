"""`fwk cam`: frames of a camera, of a run or of a recording."""

import json
import sys
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer

from fwk.cli.look import picture_output
from fwk.cli.look.picture_output import Pixels, fail
from fwk.cli.look.recorded_pictures import Recorded
from fwk.cli.recordings.find_log import failing, find_log
from fwk.cli.run_options import Json, RunChoice, ask, asking
from fwk.component.images import Ring
from fwk.control import runs
from fwk.model.errors import hint
from fwk.program import BAD_INPUT

FRAME_TYPE = "core.frame_t"


def cam(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="a camera, such as cyan1/camera, or its channel; none: lists them")
    ] = "",
    save: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="write the frame there; with --log also a folder, for all pictures"),
    ] = None,
    show: Annotated[bool, typer.Option("--show", help="draw it in the terminal, as without --save")] = False,
    raw: Annotated[bool, typer.Option("--raw", help="with --save: uncompressed bytes, row by row")] = False,
    log: Annotated[
        Path | None, typer.Option(metavar="LOG", help="a recording with pictures, or its run by name or directory")
    ] = None,
    tick: Annotated[
        int | None, typer.Option(min=1, metavar="N", help="with --log: the newest frame up to tick N")
    ] = None,
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Lists cameras, or saves or shows a frame of one.

    Recordings have pictures if the launch file says 'record: {frames: ...}', or names a component that writes pictures.
    """
    if raw and not save:
        raise typer.BadParameter("--raw is an option of --save; add --save FILE")
    if tick and not log:
        raise typer.BadParameter("--tick is for recordings; add --log LOG")
    if name and not save and not sys.stdout.isatty():
        raise typer.BadParameter("a picture is shown only in a terminal; add --save FILE")
    if log:
        with failing(BAD_INPUT):
            recorded = Recorded(find_log(log), tick)
            if not name:
                typer.echo(json.dumps(recorded.rows(), indent=2) if as_json else "\n".join(recorded.lines()))
                return
            if save and (save.is_dir() or not save.suffix):
                typer.echo(f"{save}: {recorded.save_all(name, save)} pictures")
                return
            pixels, where = recorded.newest(name)
    elif name:
        pixels, where = _newest(name, chosen)
    else:
        _list(_cameras(chosen), as_json)
        return
    if save:
        picture_output.save(pixels, save, raw)
        height_px, width_px, channels = (*pixels.shape, 1)[:3]
        typer.echo(f"{save}: {where}, {height_px} x {width_px} x {channels}")
    if show or not save:
        picture_output.show(pixels)
        typer.echo(where)


def _cameras(chosen: str | None) -> list[dict[str, Any]]:
    with asking(), runs.gateway(chosen) as run:
        rows = [row for row in run.ask("channels")["channels"] if row["type"] == FRAME_TYPE]
    if not rows:
        fail("the run has no cameras")
    return rows


def _list(rows: list[dict[str, Any]], as_json: bool) -> None:
    if as_json:
        keys = ("channel", "writer", "readers", "sequence", "tick", "age_s")
        typer.echo(json.dumps([{key: row[key] for key in keys} for row in rows], indent=2))
        return
    for row in rows:
        age = "no frame yet" if row["age_s"] is None else f"frame {row['sequence']}, {row['age_s']:.2f} s ago"
        typer.echo(f"{row['writer'] or 'none':20} {row['channel']:20} {age}")


def _newest(name: str, chosen: str | None) -> tuple[Pixels, str]:
    rows = _cameras(chosen)
    row = next((row for row in rows if name in (row["writer"], row["channel"])), None)
    if row is None:
        _unknown(name, rows)
    with asking():
        ring = Ring.of_process(ask(chosen, "run")["pid"], row["channel"])
    newest = ring.newest() if ring else None
    if newest is None:
        fail(f"{row['channel']}: no frame yet")
    return newest[1], f"{row['channel']}, frame {newest[0]}"


def _unknown(name: str, rows: list[dict[str, Any]]) -> NoReturn:
    names = [each for row in rows for each in (row["writer"], row["channel"]) if each]
    fail(f"no camera '{name}' in the run; {hint(name, names)}", BAD_INPUT)
