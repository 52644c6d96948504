"""Profiles the iterations of one component by function and line."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any

from fwk.clock import US_PER_S, monotonic_us
from fwk.engine.runner import Runner
from fwk.model.plan import ComponentPlan

INTERVAL_S = 0.0001  # iterations often take less than a millisecond
KEEP_US = 5 * US_PER_S  # interval of writing, so that samples survive a kill
SUFFIX = ".pyisession"


class ProfilerMissingError(Exception):
    """A profile was requested and pyinstrument is not installed."""


def check_profiler() -> None:
    """Checks before anything starts that the profiler is installed.

    Raises:
        ProfilerMissingError: it is not; names the command that installs it.
    """
    try:
        import_module("pyinstrument")
    except ImportError as error:
        raise ProfilerMissingError(
            "--profile: pyinstrument is not installed; type: pip install 'fwk[profile]'"
        ) from error


def profile_file(run_dir: Path, component: str, incarnation: int = 1) -> Path:
    """Returns the file for the samples of one incarnation of a component."""
    again = f"-{incarnation}" if incarnation > 1 else ""
    return run_dir / f"profile-{component.replace('/', '-')}{again}{SUFFIX}"


@dataclass(frozen=True)
class ProfileRequest:
    """Component to be profiled, and the folder of its samples."""

    component: ComponentPlan
    run_dir: Path


class Profile:
    """Samples of one component's iterations, folded to one entry for each different stack."""

    def __init__(self, request: ProfileRequest, incarnation: int) -> None:
        self._component = request.component.name
        self._file = profile_file(request.run_dir, self._component, incarnation)
        self._profiler = import_module("pyinstrument").Profiler(interval=INTERVAL_S, async_mode="disabled")
        self._stacks: dict[tuple[str, ...], tuple[float, int]] = {}
        self._about: dict[str, Any] = {}
        self._keep_us = 0

    def runner(self, *arguments: Any) -> Runner:
        """Builds the runner of a component: the profiled component gets a sampled runner."""
        return _SampledRunner(self, *arguments) if arguments[1] == self._component else Runner(*arguments)

    def sample(self) -> None:
        """Starts the profiler, or writes the samples when it is time."""
        if not self._profiler.is_running:
            self._profiler.start()
            self._keep_us = monotonic_us() + KEEP_US
        elif monotonic_us() >= self._keep_us:
            self.keep()

    def keep(self) -> None:
        """Writes all samples in the format of the profiler."""
        if not self._profiler.is_running:
            return
        session = self._profiler.stop()
        for stack, seconds in session.frame_records:
            own = _from_iteration_on(stack)
            if own:
                before, count = self._stacks.get(own, (0.0, 0))
                self._stacks[own] = before + seconds, count + 1
        self._about = self._about or session.to_json(include_frame_records=False)
        total_s = sum(seconds for seconds, _ in self._stacks.values())
        made = {
            **self._about,
            "frame_records": [[list(stack), seconds] for stack, (seconds, _) in self._stacks.items()],
            "sample_count": sum(count for _, count in self._stacks.values()),
            "duration": total_s,
            "cpu_time": total_s,
            "start_call_stack": list(next(iter(self._stacks), ("",))[:1]),
            "target_description": f"iterations of {self._component}",
        }
        self._file.write_text(json.dumps(made))
        self._profiler.reset()


class _SampledRunner(Runner):
    """Runner whose iterations are found in the samples by the file of this class."""

    def __init__(self, profile: Profile, *arguments: Any) -> None:
        super().__init__(*arguments)
        self._profile = profile

    def iterate(
        self, tick: int, stage: int, stage_name: str, time_us: int, fresh: Mapping[str, list[bytes]]
    ) -> list[tuple[str, bytes]]:
        self._profile.sample()
        return super().iterate(tick, stage, stage_name, time_us, fresh)


_MARK = _SampledRunner.iterate.__code__.co_name + "\x00" + __file__


def _from_iteration_on(stack: list[str]) -> tuple[str, ...]:
    """Returns the frames of a sampled stack that belong to an iteration; empty: the sample lies between iterations."""
    for place, frame in enumerate(stack):
        if frame.startswith(_MARK):
            return tuple(stack[place:])
    return ()
