"""Files of a report in the folder of an evaluation: the table for spreadsheets and programs, and a picture."""

import errno
from collections.abc import Sequence
from pathlib import Path

from fwk.testing.executors import INSTALL
from procs.evaluation.plots import plot
from procs.evaluation.table import Row, as_csv, as_json

_NO_FILE = "it is neither a file nor a folder, but a pipe, a socket or a device; move it away, or choose another folder"


def write_report(rows: Sequence[Row], folder: Path) -> str:
    """Writes table.csv and table.json into the folder, and measures.png if matplotlib is there.

    Returns:
        Why there is no picture, or an empty text.

    Raises:
        OSError: a file cannot be written, or its name is that of a pipe or a device, which may have no end.
    """
    table, program, picture = (_usable(folder / name) for name in ("table.csv", "table.json", "measures.png"))
    table.write_text(as_csv(rows))
    program.write_text(as_json(rows))
    try:
        plot(rows, picture)
    except ImportError:
        return f"no picture: matplotlib is not installed; type: {INSTALL}"
    return ""


def _usable(file: Path) -> Path:
    """Returns the path of a file that may be written.

    Raises:
        OSError: something stands there that takes bytes without keeping them.
    """
    if file.exists() and not (file.is_file() or file.is_dir()):
        raise OSError(errno.EINVAL, _NO_FILE, str(file))
    return file
