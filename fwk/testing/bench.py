"""A test bench for one component: put messages in, iterate, look at what it sent. No process, no bus."""

from typing import Any, cast

from fwk import messages
from fwk.aspects.vision import Ring, VisionMaster
from fwk.clock import US_PER_S
from fwk.component import Component, Declaration, declaration
from fwk.runner import Runner, Surroundings
from lcmtypes.core import log_t

NAMESPACE = "robot"


class PortBench:
    """The outside of one port: what the test puts in, or finds sent."""

    def __init__(self, channel: str, message_type: type[messages.Message]) -> None:
        self.channel = channel
        self.message_type = message_type
        self.waiting: list[bytes] = []
        self.sent: list[Any] = []
        self._sequence = 0

    def put(self, message: Any = None, **fields: Any) -> None:
        """Makes a message visible to the next iteration: a whole one, or some fields of one that is otherwise zero."""
        made = cast(Any, message if message is not None else self.message_type())
        for name, value in fields.items():
            if name not in self.message_type.__slots__:
                raise AttributeError(f"{messages.type_name(self.message_type)} has no field '{name}'")
            setattr(made, name, value)
        self._sequence += 1
        made.header.sequence = self._sequence
        self.waiting.append(messages.encode(made, self.channel))


class Bench:
    """A component on the bench: `bench.port("ball").put(x_m=1.0)`, `bench.iterate()`, `bench.port("pose").sent[-1]`.

    Ports of many instances have one `PortBench` for each namespace given in `namespaces`:
    `bench.port("motors", "cyan1")`.
    """

    def __init__(
        self,
        component: type[Component],
        name: str = f"{NAMESPACE}/component",
        seed: int = 1,
        period_s: float = 0.05,
        namespaces: tuple[str, ...] = (),
        **settings: Any,
    ) -> None:
        self.declaration: Declaration = declaration(component)
        self.logged: list[log_t] = []
        self.tick = 0
        self.time_us = 0
        self._ports: dict[str, PortBench] = {}
        self._camera: dict[str, VisionMaster] = {}
        channels = {}
        namespace = name.rpartition("/")[0]
        for port in self.declaration.ports:
            short = port.channel.rpartition("/")[2]
            names = [f"{each}/{short}" for each in namespaces] if port.each else [f"{namespace}/{port.attribute}"]
            channels[port.attribute] = names
            self._ports.update({channel: PortBench(channel, port.message_type) for channel in names})
        self._by_attribute = channels
        self._rings = {
            channels[port.attribute][0]: Ring.create(port.attribute) for port in self.declaration.ports if port.images
        }
        config = self.declaration.config(**settings)
        surroundings = Surroundings(seed, round(period_s * US_PER_S), self.logged.append, self._rings)
        self.runner = Runner(self.declaration, name, config, channels, surroundings)
        self.component: Any = self.runner.component
        self.component.init()

    def port(self, attribute: str, namespace: str = "") -> PortBench:
        """The outside of a port; of one of several instances if a namespace is given."""
        names = self._by_attribute[attribute]
        return self._ports[next(name for name in names if not namespace or name.startswith(f"{namespace}/"))]

    def show(self, attribute: str, pixels: Any) -> None:
        """Makes a frame visible to the next iteration of an `Image` port."""
        port = self.port(attribute)
        if attribute not in self._camera:
            from fwk.aspects.blackboard import Writes

            writer: Any = Writes(port.channel, port.message_type)
            self._camera[attribute] = VisionMaster(writer, self._rings[port.channel])
        master = self._camera[attribute]
        master.publish(pixels)
        port.waiting += master.announcement.take()

    def iterate(self, times: int = 1, stage: str = "") -> None:
        """Runs that many ticks; logical time goes on by the period each."""
        for _ in range(times):
            self.tick += 1
            self.time_us += self.runner.clock.period_us
            fresh = {name: port.waiting for name, port in self._ports.items() if port.waiting}
            for name in fresh:
                self._ports[name].waiting = []
            stages = [stage] if stage else self.declaration.stages
            for step in stages:
                for channel, data in self.runner.iterate(self.tick, 0, step, self.time_us, fresh):
                    port = self._ports[channel]
                    port.sent.append(messages.decode(port.message_type, data, channel))
                fresh = {}
