"""Test bench for one component: put messages in, iterate, check sent messages. No process, no bus."""

from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from fwk.clock import US_PER_S
from fwk.component import program
from fwk.component.component import Component
from fwk.component.config import Config
from fwk.component.declaration import Declaration, declaration
from fwk.component.images import Ring, VisionMaster
from fwk.component.port import Port
from fwk.engine.runner import Runner, RunSection
from fwk.lcm import envelope
from fwk.model.errors import hint
from fwk.model.service_channels import ANSWERS, service_channel
from fwk.testing.channel_decisions import ChannelDecisions
from fwk.testing.plans import alone
from fwk.testing.ports import OtherOwner, OtherSender, PortBench
from lcmtypes.core import log_t

NAMESPACE = "robot"
SENDER = "test/sender"


class Bench:
    """A component on the bench: `bench.ball.put(x_m=1.0)`, `bench.iterate()`, `bench.pose.sent[-1]`.

    Each port of the component is an attribute of its bench. A port of many instances is a mapping from the namespaces
    given in `namespaces`: `bench.motors["cyan1"]`. A port whose name the bench uses itself is `bench.port("tick")`.

    `bench.kick.put(speed_m_s=3.0)` sends a command to a component that carries it out; its answers are in `sent`.
    Commands that a component sends are in `sent`, too; `bench.owner_of("kick").answer()` answers the newest.
    """

    def __init__(
        self,
        component: type[Component],
        name: str = f"{NAMESPACE}/component",
        seed: int = 1,
        period_s: float = 0.05,
        namespaces: tuple[str, ...] = (),
        every: int | None = None,
        offset: int | None = None,
        **settings: Any,
    ) -> None:
        self.declaration: Declaration = declaration(component)
        self.logged: list[log_t] = []
        self.tick = 0
        self.time_us = 0
        self._ports: dict[str, PortBench] = {}
        self._by_name: dict[str, PortBench] = {}  # the parts that a test sees
        self._camera: dict[str, VisionMaster] = {}
        self._by_attribute: dict[str, list[str]] = {}
        channels = {}
        namespace = name.rpartition("/")[0]
        for port in self.declaration.ports:
            short = port.channel.rpartition("/")[2]
            names = [f"{each}/{short}" for each in namespaces] if port.each else [f"{namespace}/{port.attribute}"]
            self._by_attribute[port.attribute] = names
            channels[port.attribute] = names
            if port.owns or port.sends:
                channels[port.attribute] = [made for each in names for made in self._command_ports(port, each, name)]
            else:
                self._ports.update({channel: PortBench(channel, port.message_type) for channel in names})
                self._by_name.update({channel: self._ports[channel] for channel in names})
        self._rings = {
            channel: Ring.create(channel)
            for port in self.declaration.ports
            if port.images
            for channel in channels[port.attribute]
        }
        config = _config(self.declaration, settings)
        section = RunSection(seed, round(period_s * US_PER_S), self.logged.append, self._rings)
        self.runner = Runner(self.declaration, name, config, channels, section)
        self.component: Any = self.runner.component
        self.runner.clock.every = self._every = self.declaration.every if every is None else every
        self._offset = self.declaration.offset if offset is None else offset
        self._sent: dict[str, list[bytes]] = {}
        self._decisions: ChannelDecisions | None = None
        if self.runner.has_blackboard:
            self._decisions = ChannelDecisions(alone(component, name), {name: self.runner}, self._sent)
        self.runner.init()

    def _command_ports(self, port: Port, target: str, name: str) -> tuple[str, str]:
        """Makes the other side of a port for commands; returns the channels that the component's side stands for."""
        assert port.reply_type
        answers = PortBench(service_channel(target, ANSWERS), port.reply_type)
        self._ports[answers.channel] = answers
        other: PortBench
        if port.owns:
            other = OtherSender(service_channel(target, SENDER), port.message_type, answers)
            made = (answers.channel, other.channel)
        else:
            other = OtherOwner(service_channel(target, name), port.message_type, answers, name)
            made = (other.channel, answers.channel)
        self._ports[other.channel] = self._by_name[target] = other
        return made

    def port(self, attribute: str, namespace: str = "") -> PortBench:
        """Returns the other side of a port; with a namespace, that of one of its instances."""
        names = self._by_attribute[attribute]
        return self._by_name[next(name for name in names if not namespace or name.startswith(f"{namespace}/"))]

    def __getattr__(self, attribute: str) -> Any:
        """Returns the other side of the port with that name, or of its instances by namespace."""
        names = self.__dict__.get("_by_attribute", {}).get(attribute)
        if names is None:
            known = ", ".join(self.__dict__.get("_by_attribute", {})) or "none"
            raise AttributeError(f"the component has no port '{attribute}'; its ports: {known}")
        each = next(port.each for port in self.declaration.ports if port.attribute == attribute)
        if each:
            return {name.rpartition("/")[0]: self._by_name[name] for name in names}
        return self._by_name[names[0]]

    def owner_of(self, attribute: str, namespace: str = "") -> OtherOwner:
        """Returns the component that receives the requests of a port."""
        owner = self.port(attribute, namespace)
        assert isinstance(owner, OtherOwner), f"{attribute} sends no commands"
        return owner

    def show(self, attribute: str, pixels: Any, namespace: str = "") -> None:
        """Makes a frame visible to the next iteration of an `Image` port, or of one of an `Each[Image]` port."""
        port = self.port(attribute, namespace)
        if port.channel not in self._camera:
            from fwk.component.channels import Writes

            writer: Any = Writes(port.channel, port.message_type)
            self._camera[port.channel] = VisionMaster(writer, self._rings[port.channel])
        master = self._camera[port.channel]
        master.publish(pixels)
        port.waiting += master._announcement._take()

    def iterate(self, times: int = 1, stage: str = "") -> None:
        """Runs ticks, with an iteration in each that `every` selects; time advances by a period in each."""
        for _ in range(times):
            self.tick += 1
            self.time_us += self.runner.clock.period_us
            if self.tick % self._every != self._offset % self._every:
                self.runner.pass_over(self.tick, 0, stage, self.time_us)
                continue
            closed = self._open() if self._decisions else set()
            fresh = {name: port.waiting for name, port in self._ports.items() if port.waiting and name not in closed}
            for name in fresh:
                self._ports[name].waiting = []
            stages = [stage] if stage else self.declaration.stages or ("",)
            for step in stages:
                for channel, data in self.runner.iterate(self.tick, 0, step, self.time_us, fresh):
                    port = self._ports[channel]
                    self._sent.setdefault(channel, []).append(data)
                    port.sent.append(envelope.decode(port.message_type, data, channel))
                fresh = {}
            if self._decisions:
                self._decisions.ask(self.tick, 0, self.runner)

    def opened(self, channel: str) -> PortBench:
        """Returns the other side of a dynamic channel that the component has opened or asked for."""
        full = channel if "/" in channel else f"{self.runner.name.rpartition('/')[0]}/{channel}"
        return self._ports[full]

    def _open(self) -> set[str]:
        """Grants the requests of the last iteration; returns dynamic channels that the component does not read now."""
        assert self._decisions
        list(self._decisions.decide())
        for channel, kind in self._decisions.types.items():
            self._ports.setdefault(channel, PortBench(channel, kind))
        return set(self._decisions.types) - set(self.runner.readers)

    def finalize(self) -> None:
        """Finalizes the component; its messages are in `sent`."""
        for channel, data in self.runner.finalize(self.tick, self.time_us):
            port = self._ports[channel]
            port.sent.append(envelope.decode(port.message_type, data, channel))


def program_bench(
    command: Sequence[str],
    reads: Mapping[str, str] | None = None,
    writes: Mapping[str, str] | None = None,
    serves: program.Ports | None = None,
    calls: program.Ports | None = None,
    **settings: Any,
) -> Bench:
    """Returns a program of a launch file on the bench: `command`, `reads`, `writes`, `serves` and `calls` as there."""
    kind = getattr(program, program.program_class_name(reads or {}, writes or {}, serves or {}, calls or {}))
    return Bench(kind, command=[*command], **settings)


def _config(declared: Declaration, settings: Mapping[str, Any]) -> Config:
    """Returns the settings of the component.

    Raises:
        ValueError: settings that its class does not have, or values that do not fit.
    """
    try:
        return declared.config(**settings)
    except ValidationError as error:
        who = declared.component.__name__
        mistakes = (_mistake(declared, details) for details in error.errors(include_url=False))
        raise ValueError("; ".join(f"{who}: {mistake}" for mistake in mistakes)) from None


def _mistake(declared: Declaration, details: ErrorDetails) -> str:
    path = ".".join(map(str, details["loc"]))
    if details["type"] == "extra_forbidden":
        return f"no setting '{path}'; {hint(path, declared.config.model_fields)}"
    if details["type"] == "missing":
        return f"the setting '{path}' is missing; it has no default"
    message = details["msg"].removeprefix("Value error, ").replace("Input should", "it should")
    return f"'{path}' is {details['input']!r}; {message}"
