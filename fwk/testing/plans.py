"""Plans without launch files, for tests and measurements."""

from collections.abc import Mapping, Sequence
from typing import Any

from fwk.clock import US_PER_S
from fwk.component.component import DEFAULT_STAGES, Component
from fwk.component.declaration import Declaration, declaration
from fwk.lcm.messages import type_named
from fwk.model.plan import ComponentPlan, HostPlan, Plan
from fwk.model.sections import RestartPolicy
from fwk.plan.load import SPARE_CHANNELS
from fwk.plan.wiring.component_spec import ComponentSpec
from fwk.plan.wiring.needs import granted_by
from fwk.plan.wiring.wiring import wire


def plan_of(
    components: Mapping[str, type[Component]],
    settings: Mapping[str, Mapping[str, Any]] | None = None,
    channels: Mapping[str, Mapping[str, str]] | None = None,
    groups: Sequence[Sequence[str]] | None = None,
    period_s: float = 0.05,
    stages: tuple[str, ...] = DEFAULT_STAGES,
    restart: RestartPolicy | None = None,
    turns: Mapping[str, tuple[int, int]] | None = None,
    launched: Plan | None = None,
    **fields: Any,
) -> Plan:
    """Returns the plan of some components; those of a group share a process, each other one has its own.

    `turns` are `every` and `offset` by component, where they differ from the class. `launched` is the plan of a launch
    file that has these components and others: its stages, rates, turns and providers are theirs, channels that only the
    others write are silent, and nothing carries out their commands.

    Raises:
        ValueError: the components do not fit together.
    """
    mistakes: list[str] = []
    ran = {each.name: each for each in launched.components} if launched else {}
    written = {each.name: each.writer for each in launched.channels} if launched else {}
    specs = [
        ComponentSpec(
            name,
            declaration(kind),
            (channels or {}).get(name, {}),
            _providers(launched, ran[name], declaration(kind), written) if launched else {},
        )
        for name, kind in components.items()
    ]
    outside = {channel: type_named(kind) for channel, kind in fields.get("outside", {}).items()}

    def may_lack(name: str) -> bool:
        """Returns whether another component of the launch file writes a channel, or carries out a command."""
        return launched is not None and name not in ran

    wiring = wire(specs, lambda name, _, text: mistakes.append(f"{name}: {text}"), outside, may_lack)
    if mistakes:
        raise ValueError("\n".join(mistakes))
    names, granted = list(components), granted_by(specs, wiring)
    shared = [list(group) for group in groups or ()]
    grouped = {name for group in shared for name in group}
    shared += [[name] for name in names if name not in grouped]
    host_of = {name: index for index, group in enumerate(shared) for name in group}
    planned = []
    for index, (spec, ports) in enumerate(zip(specs, wiring.ports, strict=True)):
        kind, config_type = spec.declaration.component, spec.declaration.config
        config = config_type(**(settings or {}).get(spec.name, {})).model_dump()
        planned.append(
            ComponentPlan(
                index=index,
                name=spec.name,
                module=kind.__module__,
                class_name=kind.__qualname__,
                config=config,
                origins={},
                channels=ports,
                host=host_of[spec.name],
                restart=restart or RestartPolicy(),
                opens="blackboard" in spec.declaration.aspects.values(),
                needs=tuple(sorted(map(names.index, granted.get(spec.name, ())))),
                **_iterations(spec, stages, turns or {}, ran),
            )
        )
    hosts = [
        HostPlan(index, group[0] if len(group) == 1 else "+".join(group), tuple(sorted(map(names.index, group))))
        for index, group in enumerate(shared)
    ]
    return Plan(
        **{
            "name": "test",
            "file": "test",
            "folders": (),
            "stages": stages,
            "period_us": round(period_s * US_PER_S),
            "clock": "simulated",
            "seed": 1,
            "components": tuple(planned),
            "channels": wiring.channels,
            "hosts": tuple(hosts),
            "speed": 0.0,
            "public_url": "",
            "spare_channels": SPARE_CHANNELS if any(each.opens for each in planned) else 0,
            **fields,
        }
    )


def _providers(
    launched: Plan, component: ComponentPlan, declared: Declaration, written: Mapping[str, int]
) -> dict[str, str]:
    """Returns the provider of each aspect of a component: the writer of the channels of the aspect."""
    return {
        port.attribute.partition(".")[0]: launched.components[written[name]].name
        for port in declared.ports
        if "." in port.attribute and not port.each
        for name in component.channels[port.attribute]
    }


def _iterations(
    spec: ComponentSpec,
    stages: Sequence[str],
    turns: Mapping[str, tuple[int, int]],
    ran: Mapping[str, ComponentPlan],
) -> dict[str, Any]:
    """Returns when a component iterates: stages, rate, `every` and `offset`."""
    declared = spec.declaration
    if said := ran.get(spec.name):
        return {"stages": said.stages, "rate_hz": said.rate_hz, "every": said.every, "offset": said.offset}
    every, offset = turns.get(spec.name, (declared.every, declared.offset))
    indices = tuple(stages.index(stage) for stage in declared.stages)
    return {"stages": indices, "rate_hz": declared.rate_hz, "every": every, "offset": offset}


def alone(component: type[Component], name: str) -> Plan:
    """Returns the plan of one component without its channels, for the channels that it opens."""
    declared = declaration(component)
    only = ComponentPlan(
        index=0,
        name=name,
        module=component.__module__,
        class_name=component.__qualname__,
        stages=(0,),
        config={},
        origins={},
        channels={},
        host=0,
        opens="blackboard" in declared.aspects.values(),
    )
    return Plan(
        "bench",
        "",
        (),
        ("loop",),
        US_PER_S,
        "simulated",
        1,
        (only,),
        (),
        (HostPlan(0, name, (0,)),),
        spare_channels=SPARE_CHANNELS,
    )
