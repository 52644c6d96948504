"""Loads a launch file: from its name and command-line options to a checked plan, or to all its mistakes."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any

from fwk.clock import US_PER_S
from fwk.model.errors import Problems
from fwk.model.plan import ComponentPlan, Plan
from fwk.model.ports import Ports
from fwk.model.public_url import UrlError, parse_url
from fwk.model.selection import chosen, groups_of
from fwk.plan.alike import check_alike
from fwk.plan.cameras import check_cameras
from fwk.plan.channel_settings import check_with_channels
from fwk.plan.files.folders import folders_of, join
from fwk.plan.files.launch_file import Files, find_launch_file, lay_over, read_files
from fwk.plan.files.overrides import overrides
from fwk.plan.files.templates import expand
from fwk.plan.hosting import Hosting, share_out
from fwk.plan.opened import opened
from fwk.plan.resolve import Resolved, add_settings, check_clock, resolve
from fwk.plan.run_section import (
    function_of,
    last,
    log_of,
    merged,
    outside_of,
    public_url_of,
    record_of,
    runs_of,
    scoreboard_channels_of,
)
from fwk.plan.stages import stages_of
from fwk.plan.what_ran import blas_kernel, imported_modules
from fwk.plan.wiring.needs import check_left_out, granted_by, needs_of
from fwk.plan.wiring.start_order import check_groups, check_processes, check_starts
from fwk.plan.wiring.wiring import Wiring, wire

_PORTS_END = 65536
SPARE_CHANNELS = 64


@dataclass(frozen=True)
class LaunchOptions:
    """Command-line options that change the plan; None: the value of the launch file."""

    sets: Sequence[str] = ()
    """Settings as `PATH=VALUE`."""
    hosting: Hosting = "process"
    only: Sequence[str] = ()
    """Patterns of the components to run; empty: all."""
    without: Sequence[str] = ()
    """Patterns of the components to leave out."""
    outside: Sequence[str] = ()
    """Patterns of channels without a writer that programs outside write."""
    seed: int | None = None
    speed: float | None = None
    """Logical seconds per wall second; 0: as fast as possible."""
    bus_port: int | None = None
    record_channels: Sequence[str] = ()
    """Patterns of the channels that are recorded; empty: as in the launch file."""
    record_exclude: Sequence[str] = ()
    """Patterns of the channels that are not recorded."""
    record_parts: Mapping[str, float] = field(default_factory=dict)
    """Parts of the recording: `split_mb` or `split_s`, and `compress`; what is missing is as in the launch file."""
    run_only: bool = False
    """Whether `video` and `evaluation`, functions that a run does not call, are taken unchecked, for a quick start."""


def load_plan(file: str, options: LaunchOptions = LaunchOptions(), notice: Callable[[str], None] | None = None) -> Plan:
    """Finds, reads and checks a launch file, and imports everything that it uses.

    The whole file is checked, including components that `only` and `without` leave out. A channel whose writer is left
    out has no writer, and its readers never see a value. `notice` takes a line for each entry of an earlier version.

    Raises:
        PlanError: the file has mistakes; the text has a line for each.
    """
    problems = Problems()
    path = find_launch_file(file, problems)
    problems.stop_if_any()
    assert path
    files = read_files(path, problems)
    typed = overrides(options.sets, problems)
    if typed.value:
        lay_over(files, path, typed, problems)
    plan = _Loading(files, options, problems).plan()
    if notice:
        for note in problems.notes:
            notice(str(note))
    return plan


@dataclass
class _Loading:
    files: Files
    options: LaunchOptions
    problems: Problems
    folders: tuple[str, ...] = field(init=False)

    def plan(self) -> Plan:
        files, problems, options = self.files, self.problems, self.options
        self.folders = folders_of(files.folders)
        join(self.folders, problems)
        stages = stages_of(files, problems)
        asked = expand(files, problems)
        if not asked and not files.gaps:
            only = any(layer.content.templates for layer in files.layers)
            text = ", only templates; include it in a file with 'robots:'" if only else "; name one under 'components:'"
            problems.add(str(files.path), "", f"there is no component in it{text}")
        add_settings(files, asked, problems)
        components = resolve(files, asked, stages, self.folders, problems)
        outside = outside_of(files, problems)
        whole = self._wire(components, outside, files.may_hide)
        granted = granted_by([each.spec for each in components], whole)
        needs = needs_of(asked, granted, files, problems)
        check_starts(asked, needs, problems)
        names = [each.name for each in asked]
        said, places = merged(files, "hosts")
        groups = groups_of(names, said, places, problems)
        check_groups(asked, groups, places, problems)
        kept = set(chosen(names, options.only, options.without, problems))
        check_left_out(names, kept, granted, options.without, problems)
        own = [each.asked.name for each in components]
        outside |= opened(whole.channels, own, kept, options.outside, problems)
        shared = self._shared()
        choice = {"channels": options.record_channels, "exclude": options.record_exclude}
        recorded = record_of(files, whole.channels, choice, options.record_parts, problems)
        problems.stop_if_any()
        if len(kept) < len(components):
            # All components are right, so a missing writer was left out on purpose.
            components = [each for each in components if each.asked.name in kept]
            whole = self._wire(components, outside, lambda _: True)
        later = {each.name for each in asked if not each.entry.start}
        alone = {each.asked.name for each in components if each.rate_hz is not None}
        hosts = share_out([each.asked.name for each in components], options.hosting, groups, later, alone)
        host_of = {member: host.index for host in hosts for member in host.components}
        made = Plan(
            stages=stages,
            components=_component_plans(components, whole, host_of, needs),
            channels=whole.channels,
            spare_channels=last(files, "spare_channels", SPARE_CHANNELS) if any(map(_opens, components)) else 0,
            hosts=hosts,
            outside={channel.name: channel.type_name for channel in whole.channels if channel.name in outside},
            record=replace(
                recorded,
                frames=tuple(name for name in recorded.frames if name in {each.name for each in whole.channels}),
            ),
            scoreboard_channels=scoreboard_channels_of(shared["scoreboard"], whole.channels, self.folders),
            modules=imported_modules([each.asked.entry.use for each in components], self.folders),
            blas_kernel=blas_kernel(),
            **shared,
        )
        check_clock(components, shared["clock"], problems)
        check_alike(components, problems)
        check_cameras(components, whole.channels, problems)
        check_with_channels(components, whole, problems)
        self._check_ports(made)
        check_processes(made.hosts, made.components, asked, problems)
        problems.stop_if_any()
        return made

    def _wire(self, components: Sequence[Resolved], outside: Mapping[str, Any], may_lack_writer: Any) -> Wiring:
        by_name = {each.asked.name: each for each in components}

        def report(name: str, port: str | None, text: str) -> None:
            self.problems.add(by_name[name].place(port), name, text)

        return wire([each.spec for each in components], report, outside, may_lack_writer)

    def _shared(self) -> dict[str, Any]:
        files, options, problems = self.files, self.options, self.problems
        bus_port = {} if options.bus_port is None else {"bus_port": options.bus_port}
        return {
            "name": last(files, "name", files.path.stem),
            "file": str(files.path),
            "folders": self.folders,
            "period_us": round(last(files, "period_s", 0.05) * US_PER_S),
            "clock": last(files, "clock", "simulated"),
            "seed": last(files, "seed", 1) if options.seed is None else options.seed,
            "speed": last(files, "speed", 1.0) if options.speed is None else options.speed,
            "stage_time_us": round(last(files, "stage_time_s", 0.0) * US_PER_S),
            "loop_time_us": round(last(files, "loop_time_s", 0.0) * US_PER_S),
            "loop_time_warnings": last(files, "loop_time_warnings", True),
            "cores": last(files, "cores", "any"),
            "public_url": public_url_of(files, problems, options.bus_port),
            "scoreboard": function_of(files, "scoreboard", self.folders, problems),
            "video": self._function("video"),
            "evaluation": self._function("evaluation"),
            "log": log_of(files, problems),
            "runs": runs_of(files),
            **bus_port,
        }

    def _function(self, key: str) -> str:
        if self.options.run_only:
            return str(last(self.files, key, ""))
        return function_of(self.files, key, self.folders, self.problems)

    def _check_ports(self, plan: Plan) -> None:
        end = Ports.of(plan).end
        if end > _PORTS_END:
            highest = plan.bus_port - (end - _PORTS_END)
            text = f"the run would need the ports {plan.bus_port} to {end - 1}; use --bus-port {highest} or less"
            self.problems.add("--bus-port", "", text)
        with suppress(UrlError):  # reported already
            port = parse_url(plan.public_url)[1] if plan.public_url else 0
            if plan.bus_port <= port < end:
                text = (
                    f"port {port} is one of the run's own ports {plan.bus_port} to {end - 1}; use one outside of them"
                )
                self.problems.add("public_url", "", text)


def _opens(component: Resolved) -> bool:
    return "blackboard" in component.declaration.aspects.values()


def _component_plans(
    components: Sequence[Resolved], wiring: Wiring, host_of: Mapping[int, int], needs: Mapping[str, Sequence[str]]
) -> tuple[ComponentPlan, ...]:
    index_of = {each.asked.name: index for index, each in enumerate(components)}
    return tuple(
        ComponentPlan(
            index=index,
            name=each.asked.name,
            module=each.asked.entry.use.partition(":")[0],
            class_name=each.declaration.component.__name__,
            stages=each.stages,
            config=each.config,
            origins=each.origins,
            channels=wiring.ports[index],
            host=host_of[index],
            restart=each.asked.entry.restart,
            ready_timeout_s=each.asked.entry.ready_timeout_s,
            stop_timeout_s=each.asked.entry.stop_timeout_s,
            rate_hz=each.rate_hz,
            every=each.every,
            offset=each.offset,
            memory_limit_mb=each.asked.entry.memory_limit_mb,
            needs=tuple(index_of[name] for name in needs.get(each.asked.name, ()) if name in index_of),
            start=each.asked.entry.start,
            opens=_opens(each),
        )
        for index, each in enumerate(components)
    )
