"""`fwk compress LOG`: compresses the files of a log in place."""

import json
import os
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.output import say
from fwk.cli.recordings.find_log import failing, find_log
from fwk.cli.recordings.progress import progress_of
from fwk.cli.run_options import Json
from fwk.lcm.log_file import LogError, is_compressed
from fwk.lcm.log_parts import parts_of
from fwk.program import BAD_INPUT
from fwk.recording.part_compressor import compress_part


def compress(
    log: Annotated[Path, typer.Argument(metavar="LOG", help="log, or run by its name or directory")],
    as_json: Json = False,
) -> None:
    """Compresses a log in place with Zstandard; all commands for logs read it as before.

    Each file of the log becomes a file with the suffix .zst; `zstd -d --rm FILE` makes it a plain LCM log again, as
    lcm-logplayer needs it. The file that a run still writes stays as it is.

    Needs: pip install 'fwk[compress]'

    Exit codes: 0 compressed; 2 bad input, or the library is missing.
    """
    with failing(BAD_INPUT):
        found = find_log(log)
        plain = [part for part in parts_of(found) if not is_compressed(part)]
        if not plain:
            raise LogError(f"{found}: is compressed already")
        before = sum(map(os.path.getsize, plain))
        done_bytes, written = 0, []
        with progress_of("compressing", found) as progress:
            for part in plain:
                part_bytes = os.path.getsize(part)
                if not compress_part(part):
                    written.append(part)
                done_bytes += part_bytes
                progress(done_bytes)
    after = sum(map(os.path.getsize, parts_of(found)))
    if as_json:
        row = {"log": str(found), "files": len(plain) - len(written), "bytes_before": before, "bytes_after": after}
        typer.echo(json.dumps({**row, "still_written": list(map(str, written))}))
        return
    files = len(plain) - len(written)
    say(f"{found}: {files} file{'' if files == 1 else 's'} compressed, {before} bytes before, {after} after")
    say(*(f"{part}: a run still writes it; not compressed" for part in written))
