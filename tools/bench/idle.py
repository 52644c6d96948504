"""A launch file whose components do nothing: python -m tools.bench.idle soccer-percepts.yaml --speed max --ticks 400.

Takes the words of `fwk-launch`; without `--ticks` and `--time` it ends after 400 ticks, without `--speed` it goes as
fast as it can. Processes, channels, stages and ticks are those of the launch file, but no component initializes itself,
and each iteration writes one empty message. What is left is the least that so many processes need, whatever their
components do: no match can be faster.
"""

import sys
from collections.abc import Sequence

from fwk.cli import launch
from fwk.component.channels import Writes
from fwk.engine.runner import Runner
from fwk.model.service_channels import is_of_service

_TICKS = "400"


def _nothing() -> None:
    """Does nothing."""


def _init(runner: Runner) -> None:
    """Lets the iterations of a component write its first channel that is not one of a service, and nothing else."""
    interfaces = (writer for channel, writer in runner.writers.items() if not is_of_service(channel))
    first: Writes[object] | None = next(interfaces, None)
    methods = vars(runner.component)
    methods["loop"] = _nothing if first is None else first.write
    methods["config_changed"] = methods["finalize"] = _nothing


def words_of_run(given: Sequence[str]) -> list[str]:
    """Returns the words of `fwk-launch`, with an end and a pace where they lack one."""
    options = {word.partition("=")[0] for word in given}
    end = () if options & {"--ticks", "--time"} else ("--ticks", _TICKS)
    pace = () if "--speed" in options else ("--speed", "max")
    return [*given, *end, *pace]


def main() -> None:
    """Runs the launch file; its hosts are forked from this process, and so do nothing."""
    if "--help" in sys.argv:
        print(__doc__)
    sys.argv[1:] = words_of_run(sys.argv[1:])
    setattr(Runner, "init", _init)  # noqa: B010 - mypy refuses an assignment to a method
    launch.main()


if __name__ == "__main__":
    main()
