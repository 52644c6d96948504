"""`fwk repair LOG`: makes a whole log of a damaged one."""

import json
from dataclasses import asdict

import typer

from fwk.cli.output import say
from fwk.cli.recordings.find_log import failing, find_log
from fwk.cli.recordings.log_options import Force, Log, Out
from fwk.cli.recordings.progress import progress_of
from fwk.cli.run_options import Json
from fwk.log_tools.repair import Repaired
from fwk.log_tools.repair import repair as repair_log
from fwk.program import BAD_INPUT


def repair(log: Log, out: Out, force: Force = False, as_json: Json = False) -> None:
    """Writes all whole events of a log to a new log with an index, and names what is lost.

    It makes a log of a run that was killed whole, and an index for any log. Events keep their numbers, so that a replay
    still notices what is missing.

    Exit codes: 0 written; 2 bad input, or no whole event.
    """
    with failing(BAD_INPUT):
        found = find_log(log)
        with progress_of("reading", found) as progress:
            done = repair_log(found, out, force, progress)
    if as_json:
        parts = [part._asdict() for part in done.changed]
        typer.echo(json.dumps({**asdict(done), "log": str(done.log), "out": str(done.out), "changed": parts}))
        return
    say(f"{out}: {done.events} events", *_losses(done))


def _losses(done: Repaired) -> list[str]:
    made = [f"lost: bytes {first} to {last}, not a whole event" for first, last in done.lost_bytes]
    if done.lost_events:
        made.append(f"lost: {done.lost_events} events, according to the numbers of the others")
    made += [f"damaged: {part}; their whole events are kept" for part in done.changed if not part.missing]
    if done.last_tick is not None:
        made.append(f"last whole tick: {done.last_tick}; {done.unfinished_events} events after it")
    return made or ["nothing is lost"]
