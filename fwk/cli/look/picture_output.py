"""Saves pictures to files, or draws them in the terminal with two pixels a character."""

import shutil
from pathlib import Path
from typing import NoReturn

import cv2
import numpy as np
import typer
from numpy.typing import NDArray
from rich.console import Console
from rich.style import Style
from rich.text import Text

from fwk.program import BAD_INPUT, FAILED
from fwk.recording.pictures import as_picture, fits_picture

Pixels = NDArray[np.uint8]
SUFFIXES = (".bmp", ".jpeg", ".jpg", ".png", ".ppm", ".tif", ".tiff", ".webp")
_UPPER_HALF = "▀"


def save(pixels: Pixels, file: Path, raw: bool = False) -> None:
    """Writes a picture in the format of the file's suffix, or its bytes as they are."""
    if not raw and file.suffix.lower() not in SUFFIXES:
        fail(f"{file}: the name has no suffix of a picture; use one of {', '.join(SUFFIXES)}, or --raw", BAD_INPUT)
    if not raw and not fits_picture(pixels):
        fail(f"{file}: no picture file has {pixels.shape[2]} channels; --raw saves the bytes as they are", BAD_INPUT)
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(pixels.tobytes() if raw else cv2.imencode(file.suffix.lower(), pixels)[1].tobytes())
    except OSError as error:
        fail(f"{file}: cannot be written: {error.strerror}")


def show(pixels: Pixels) -> None:
    """Draws a picture as large as the terminal allows."""
    size = shutil.get_terminal_size()
    Console(width=size.columns).print(as_text(pixels, size.columns, max(1, size.lines - 2)), end="")


def as_text(pixels: Pixels, columns: int, rows: int) -> Text:
    """Returns a picture of at most so many columns and rows of characters, each two pixels high, in its proportions."""
    height_px, width_px = pixels.shape[:2]
    factor = min(columns / width_px, 2 * rows / height_px)
    size = max(1, round(width_px * factor)), 2 * max(1, round(height_px * factor / 2))
    small = cv2.resize(as_picture(pixels), size, interpolation=cv2.INTER_AREA if factor < 1 else cv2.INTER_NEAREST)
    colours = small if small.ndim == 3 else cv2.cvtColor(small, cv2.COLOR_GRAY2BGR)
    text = Text(no_wrap=True, end="")
    for upper, lower in zip(colours[::2].tolist(), colours[1::2].tolist(), strict=True):
        for above, below in zip(upper, lower, strict=True):
            text.append(_UPPER_HALF, Style(color=_rgb(above), bgcolor=_rgb(below)))
        text.append("\n")
    return text


def fail(text: str, code: int = FAILED) -> NoReturn:
    """Ends the command with a sentence.

    Raises:
        Exit: always.
    """
    typer.echo(f"error: {text}", err=True)
    raise typer.Exit(code)


def _rgb(bgr: list[int]) -> str:
    blue, green, red = bgr[:3]
    return f"#{red:02x}{green:02x}{blue:02x}"
