"""Evaluation of a launch file in the process that plays the run, and how its failures are told."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, cast

from fwk.component.log import own_frame
from fwk.engine.failures import ComponentFailedError
from fwk.engine.metrics import told
from fwk.lcm.type_registry import put_first, use_types_of
from fwk.plan.classes import find_object
from fwk.plan.what_ran import hash_of_module
from fwk.testing.differing import check_plan
from fwk.testing.executors import CampaignError

Work = Callable[..., Any]
"""Plays a launch file for a logical time with a seed; returns the measurements as plain values for JSON.

Settings that the launch file's own are overridden with are a fourth argument, if there are some.
"""
_hash_in_use = lru_cache(maxsize=None)(hash_of_module)
"""A process goes on with a module as it was when it first used it, whatever becomes of the file."""
_SHOWN = 300  # letters of a failure that a message shows


@dataclass(frozen=True)
class Evaluation:
    """The evaluation of a launch file, found by its name in the process that plays the run."""

    use: str
    """`module:function`."""
    folders: tuple[str, ...] = ()
    """Folders of the launch file's modules and message types, besides the installed ones."""
    sets: tuple[str, ...] = ()
    """Settings to override: `PATH=VALUE`."""
    modules: Mapping[str, str] = field(default_factory=dict)
    """Modules that the process must have, with the hashes of their files; a worker of a cluster may have others."""
    plan: str = ""
    """Digest of the plan that the process must play; empty for any."""

    def __call__(self, file: str, time_s: float, seed: int) -> Any:
        """Plays a run and returns its measurements.

        Raises:
            CampaignError: this process has other modules or another launch file, or the run failed; the text names a
                component that did.
        """
        for folder in self.folders:
            use_types_of(Path(folder))
        put_first(self.folders)
        work = cast(Work, find_object(self.use, self.folders))
        other = [name for name, digest in self.modules.items() if _hash_in_use(name) != digest]
        if other:
            more = f" and {len(other) - 1} more" if len(other) > 1 else ""
            cure = "copy the code to its machine if it has a copy of its own, and restart the worker"
            raise CampaignError(f"a worker has other code of {other[0]}{more}; {cure}")
        try:
            if self.plan:
                check_plan(file, self.sets, self.plan)
            return work(file, time_s, seed, self.sets) if self.sets else work(file, time_s, seed)
        except CampaignError:
            raise
        except Exception as error:  # of any kind; some do not reach another process, alone or as a cause
            failure = failure_of(error)
        raise CampaignError(failure)


def failure_of(error: Exception) -> str:
    """Returns an exception of an application with its place, and with the component that raised it if one did.

    The tick is left out, so that runs that fail at the same place have the same cause.
    """
    raised: BaseException = error
    context = error.__context__
    if isinstance(error, ComponentFailedError):
        raised, context = error.__cause__ or error, error
    frame = own_frame(raised)
    place = f" ({frame.filename}:{frame.lineno})" if frame else ""
    failed = f"{context}".partition(": ")[0] if isinstance(context, ComponentFailedError) else ""
    return f"{shortened(': '.join(filter(None, (failed, told(raised)))))}{place}"


def shortened(text: str) -> str:
    """Returns a text in one line, and the beginning of a long one."""
    line = " ".join(text.split())
    return f"{line[:_SHOWN]} ..." if len(line) > _SHOWN else line
