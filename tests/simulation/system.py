"""One run of a whole system in a simulated world: supervisor, hosts, gateway and recorder in one thread."""

import json
import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from lcmtypes.simulation import call_t

from fwk.bus import sync
from fwk.bus.network import Steps
from fwk.bus.sockets import Address
from fwk.control.server import Answer
from fwk.gateway.gateway import Gateway
from fwk.gateway.unwrap import Unwrap, plain_channels
from fwk.model.ports import Ports
from fwk.recording import sinks
from fwk.supervisor.options import RunOptions
from fwk.supervisor.supervisor import Machine, Supervisor
from tests.simulation.components import CALLS
from tests.simulation.faults import Action, Weather
from tests.simulation.machine import machine
from tests.simulation.network import Ether, Signal
from tests.simulation.process import Process
from tests.simulation.recorded import Log, log_of
from tests.simulation.scenario import Scenario
from tests.simulation.trace import Trace
from tests.simulation.world import START_US, StuckError, World
from tests.simulation.zygote import SimulatedZygote

RUN = 4711
FAULTS_END_US = 30_000_000
"""Wall time after which no fault happens any more."""
LIMIT_US = 120_000_000
"""A run that has not ended by then waits for ever."""


@dataclass
class Outcome:
    """Result of a run."""

    path: Path
    """The recording."""
    stuck: str = ""
    reason: str = ""
    """Reason for the end of the run, from the supervisor."""
    failed: bool = False
    errors: list[str] = field(default_factory=list)
    """Exceptions that participants must not raise."""
    iterations: list[tuple[str, str, int, int]] = field(default_factory=list)
    acknowledged: list[tuple[str, int, int]] = field(default_factory=list)
    """Component, value and tick of every acknowledged setting."""
    lost: int = 0
    """Messages that the gateway reports as never received."""
    calls: list[int] = field(default_factory=list)
    """Numbers that the gateway took in from programs outside."""
    ticks: int = 0
    wall_us: int = 0
    events: int = 0

    @property
    def log(self) -> Log:
        """The recording, read."""
        return log_of(self.path)


class _Connection:
    """A tool that sends requests to the supervisor."""

    open = True
    pid = 0

    def __init__(self, answered: Callable[[dict[str, Any]], None]) -> None:
        self._answered = answered

    def reply(self, message: dict[str, Any]) -> None:
        """Takes an answer."""
        self._answered(message)

    def stream(self, message: dict[str, Any]) -> None:
        """Takes an answer of a stream."""
        self._answered(message)

    def refuse(self, error: str) -> None:
        """Takes a refusal."""
        self._answered({"ok": False, "error": error})


class _Server(Signal):
    """The control server: passes requests to the supervisor at simulated times."""

    def __init__(self, ether: Ether, answer: Answer) -> None:
        super().__init__(ether)
        self._answer = answer
        self._requests: list[tuple[dict[str, Any], Callable[[dict[str, Any]], None]]] = []

    def ask(self, request: dict[str, Any], answered: Callable[[dict[str, Any]], None]) -> None:
        """Queues a request."""
        self._requests.append((request, answered))
        self.set()

    def handle(self) -> None:
        """Answers the queued requests."""
        self.clear()
        requests, self._requests = self._requests, []
        for request, answered in requests:
            self._answer(json.dumps(request).encode(), _Connection(answered))  # type: ignore[arg-type]

    def close(self) -> None:
        """Stops answering."""


class _Public(Signal):
    """The public bus, as the gateway sees it."""

    def __init__(self, ether: Ether) -> None:
        super().__init__(ether)
        self._waiting: list[bytes] = []

    def say(self, data: bytes) -> None:
        """Publishes a message as a program outside."""
        self._waiting.append(data)
        self.set()

    def receive(self) -> tuple[str, bytes, int] | None:
        """Returns the next message as (channel, data, port of its sender)."""
        if not self._waiting:
            self.clear()
            return None
        return CALLS, self._waiting.pop(0), 50_000

    def send(self, datagram: bytes) -> None:
        """Drops the datagram: no program outside listens."""

    def busy_listeners(self) -> list[str]:
        """Names no listener: the gateway paces what it publishes for programs that it cannot see."""
        return []


class _SupervisorConnection(Signal):
    """The gateway's end of the connection that the supervisor closes."""

    def send(self, packet: bytes, /) -> int:
        """Drops a packet: only the launcher of a real run waits for it."""
        return len(packet)


class _GatewayEnd(Signal):
    """Informs the supervisor about the end of the gateway."""

    def gateway_end(self) -> str:
        """Describes how it ended."""
        return "it ended in the simulated world"


class _SlowDisk:
    """Takes time for each tick, like a busy disk."""

    def __init__(self, process: Process, world: World) -> None:
        self._process = process
        self._world = world

    def message(self, channel: str, data: bytes, time_us: int) -> None:
        """Takes a message."""

    def tick(self) -> None:
        """Takes the time."""
        if most_us := self._world.weather.disk_us:
            self._process.work(int(self._world.random.random() * most_us))

    def close(self) -> None:
        """Closes nothing."""


class System:
    """All participants of one run."""

    def __init__(self, scenario: Scenario, folder: Path, trace: Trace) -> None:
        self.scenario = scenario
        self.plan = scenario.plan()
        self.outcome = Outcome(Path(tempfile.mkdtemp(dir=folder)) / "log.lcm")
        self.world = World(scenario.seed, scenario.weather, trace)
        self._ether = Ether(self.world)
        self._ether.on_sent = self._on_sent
        self._ports = Ports.of(self.plan)
        self._zygote = SimulatedZygote(self.plan, RUN, self.world, self._ether)
        self._tick = -1
        self._ended = 0
        self._gateway_end = _GatewayEnd(self._ether)
        self._public = _Public(self._ether)
        self._server: _Server | None = None
        self._recorder: sinks.Recorder | None = None
        self._closed = _SupervisorConnection(self._ether)  # the supervisor's connection to the gateway
        self._supervisor_process = Process("supervisor", self.world, self._ether, self._on_supervisor_end)
        self._gateway_process = Process("gateway", self.world, self._ether, self._on_gateway_end)

    def run(self) -> Outcome:
        """Runs the system to its end."""
        world, outcome = self.world, self.outcome
        machine.enter(self._work, lambda: world.running.name if world.running else "")
        try:
            self._gateway_process.start(self._gateway)
            self._supervisor_process.start(self._supervise)
            self._reached(0)
            world.at(START_US + FAULTS_END_US, self._end_faults)
            world.run(lambda: self._ended == 2, LIMIT_US + self.scenario.ticks * self.scenario.period_us)
        except StuckError as error:
            outcome.stuck = f"{error}; tick {self._tick}"
        finally:
            outcome.iterations = machine.iterations
            machine.leave()
        self._zygote.close()
        if self._recorder:
            self._recorder.close()  # the gateway did not end regularly
        processes = [self._supervisor_process, self._gateway_process, *self._zygote.processes.values()]
        outcome.errors = [f"{process.name}: {process.error}" for process in processes if process.error]
        outcome.wall_us, outcome.events = world.now_us - START_US, world.events
        return outcome

    def _work(self, time_us: int) -> None:
        if self.world.running:
            self.world.running.work(time_us)

    def _supervise(self) -> Steps[int]:
        scenario, outcome = self.scenario, self.outcome
        options = RunOptions(outcome.path.parent, ticks=scenario.ticks, speed=1.0 if scenario.wall else 0.0)
        made = Machine(self._zygote, listen=self._listen)  # type: ignore[arg-type]  # a server like the real one
        supervisor = Supervisor(self.plan, options, RUN, self._supervisor_process, made)
        outcome.reason, outcome.failed = yield from supervisor.work(self._gateway_end)
        yield from supervisor.stop()
        outcome.ticks = supervisor.loop.tick
        self._closed.set()
        return 0

    def _listen(self, answer: Answer) -> _Server:
        self._server = _Server(self._ether, answer)
        return self._server

    def _gateway(self) -> Steps[int]:
        outcome, process = self.outcome, self._gateway_process
        gateway = Gateway(self.plan, RUN, process, self._closed, self._public)
        recorder = self._recorder = sinks.Recorder(self.plan, outcome.path, gateway.log.error)
        gateway.sinks += [
            Unwrap(recorder, plain_channels(self.plan), gateway.dynamic.plain),
            _SlowDisk(process, self.world),
        ]
        yield from gateway.serve()
        outcome.lost = gateway.lost
        return 0

    def _on_supervisor_end(self, _code: int) -> None:
        self._ended += 1
        self._closed.set()

    def _on_gateway_end(self, _code: int) -> None:
        self._ended += 1
        self._gateway_end.set()

    def _end_faults(self) -> None:
        self.world.weather = Weather(latency_us=self.scenario.weather.latency_us)

    def _on_sent(self, address: Address, data: bytes) -> None:
        """Watches the tick records, from which actions know their time."""
        if address[1] == self._ports.record and data[8:].startswith(sync.RECORD + b"\0"):
            tick = sync.decode_record(data[8 + len(sync.RECORD) + 1 :]).tick
            if tick > self._tick:
                self._reached(tick)

    def _reached(self, tick: int) -> None:
        for action in self.scenario.actions:
            if self._tick < action.after_tick <= tick:
                self.world.after(action.delay_us, partial(self._act, action))
        self._tick = tick

    def _act(self, action: Action) -> None:
        world = self.world
        process = self._process(action.target)
        said = " ".join(str(item) for item in (action.kind, action.word, action.target, action.amount) if item)
        world.trace.add(world.now_us, "world", said)
        if action.kind == "jump":
            world.jump(action.amount)
        elif action.kind == "call":
            message = call_t()
            message.number = action.amount
            self._public.say(message.encode())
        elif action.kind == "pause":
            self._ask({"verb": "pause"})
            world.after(action.amount, partial(self._ask, {"verb": "resume"}))
        elif action.kind == "steer":
            self._ask({"verb": "steer", "action": action.word, "names": [action.target]})
        elif action.kind == "set":
            request = {"verb": "set", "changes": [f"{action.target}.tune={action.amount}"]}
            self._ask(request, partial(self._acknowledge, action))
        elif process:
            if action.kind == "kill":
                process.kill()
            elif action.kind == "kill_at_send":
                process.kill_at_send(action.amount)
            elif action.kind == "cut_off":
                process.cut_off(self._ports.sync)
                process.kill_at_send(action.amount)
            elif action.kind == "stop":
                process.stand_still(action.amount)
            else:
                process.stand_still_at_send(1 + action.delay_us % 10, action.amount)

    def _process(self, target: str) -> Process | None:
        if target in ("supervisor", "gateway"):
            return self._supervisor_process if target == "supervisor" else self._gateway_process
        return next((self._zygote.process_of(each.host) for each in self.plan.components if each.name == target), None)

    def _ask(self, request: dict[str, Any], answered: Callable[[dict[str, Any]], None] | None = None) -> None:
        if self._server:
            self._server.ask(request, answered or self._hear)

    def _hear(self, answer: dict[str, Any]) -> None:
        self.world.trace.add(self.world.now_us, "tool", f"is answered {answer}")

    def _acknowledge(self, action: Action, answer: dict[str, Any]) -> None:
        self._hear(answer)
        if answer.get("ok"):
            self.outcome.acknowledged.append((action.target, action.amount, int(answer["tick"])))


def run(scenario: Scenario, folder: Path, trace: Trace | None = None) -> Outcome:
    """Runs a scenario; the recording lies below `folder`."""
    return System(scenario, folder, trace or Trace(False)).run()
