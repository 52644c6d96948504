"""A process of a simulated world: runs a participant, takes time, stops, dies at any point."""

import traceback
from collections.abc import Callable
from functools import partial
from typing import Any

from fwk.bus.network import Steps
from fwk.bus.waiting import Source as Watched
from fwk.engine.failures import ComponentFailedError
from tests.simulation.network import SEND_US, Ether, SimulatedSocket
from tests.simulation.network import Source as SimulatedSource
from tests.simulation.world import World

STEP_US = 10
"""Wall time that a process takes at least between waking up and waiting again."""
SPINS_MAX = 100
"""A process that wakes up so often without reading or sending anything is in an endless loop."""
KILLED = -9
_NEVER_US = 1 << 62


class Process:
    """Runs a participant on simulated sockets and time, and is the participant's `Network`.

    A step of the participant is one event of the world; its wall time delays what it sends and its next wake-up.
    """

    def __init__(self, name: str, world: World, ether: Ether, ended: Callable[[int], None]) -> None:
        self.name = name
        self.local_us = world.now_us
        """The process's wall time: ahead of the world's while a step takes time."""
        self.died_us: int | None = None
        self.reached_port = 0
        """Port of the only group that hears a process without network; 0: the network works."""
        self.stopping = False
        """Whether the process has been asked to end."""
        self.error = ""
        """Traceback of an exception that a participant must not raise."""
        self.signals: list[int] = []
        self._world = world
        self._ether = ether
        self._ended = ended
        self._steps: Steps[Any] | None = None
        self._sockets: list[SimulatedSocket] = []
        self._watched: dict[int, SimulatedSource] = {}
        self._until_us = 0
        self._wake_us = _NEVER_US
        self._wakes = 0
        self._stopped_until_us = 0
        self._die_in = 0  # number of datagrams until it dies; 0: it does not die
        self._stop_in = 0
        self._stop_us = 0
        self._started = False
        self._done = 0  # datagrams read and sent
        self._spins = 0

    # The network, for the participant.

    def now_us(self) -> int:
        """Returns the wall time; each call takes some."""
        self.local_us = max(self.local_us, self._world.now_us) + 1
        return self.local_us

    def group_socket(self, port: int) -> SimulatedSocket:
        """Opens a socket that hears the multicast group on `port`."""
        return self._open(port, True)

    def own_socket(self, port: int) -> SimulatedSocket:
        """Opens the socket that sends from `port` and hears what is sent to `port` alone."""
        return self._open(port, False)

    def watch(self, source: Watched) -> None:
        """Lets `source` end waits from now on."""
        descriptor = source if isinstance(source, int) else source.fileno()
        found = self._ether.sources[descriptor]
        self._watched[descriptor] = found
        found.watcher = self

    def unwatch(self, source: Watched) -> None:
        """Takes `source` out of the waits."""
        descriptor = source if isinstance(source, int) else source.fileno()
        if found := self._watched.pop(descriptor, None):
            found.watcher = None

    def received(self) -> None:
        """Counts a datagram that was read."""
        self._done += 1

    def may_send(self) -> bool:
        """Counts a datagram that is about to be sent; returns whether the process lives long enough to send it."""
        if self.died_us is not None:
            return False
        self.local_us += SEND_US
        self._done += 1
        if self._die_in:
            self._die_in -= 1
            if not self._die_in:
                self._world.trace.add(self.local_us, self.name, "dies before it sends")
                self.died_us = self.local_us
                return False
        if self._stop_in:
            self._stop_in -= 1
            if not self._stop_in:
                self._world.trace.add(self.local_us, self.name, f"stands still for {self._stop_us} us")
                self.local_us += self._stop_us
        return True

    # Actions of the world.

    def start(self, make: Callable[[], Steps[Any]]) -> None:
        """Starts the participant that `make` returns, in the first step of the process."""
        self._wake_us = max(self.local_us, self._world.now_us)
        self._world.at(self._wake_us, partial(self._begin, make))

    def arrived(self) -> None:
        """Notes that a source of the process became readable."""
        self._schedule(self._world.now_us)

    def terminate(self) -> None:
        """Asks the process to end."""
        self.stopping = True
        self._schedule(self._world.now_us)

    def signal(self, number: int) -> None:
        """Delivers a signal to the process."""
        self.signals.append(number)
        self._schedule(self._world.now_us)

    def kill(self) -> None:
        """Ends the process at once; its later datagrams are not sent."""
        if self.died_us is None:
            self._world.trace.add(self._world.now_us, self.name, "is killed")
            self.died_us = self._world.now_us
            self._end(KILLED)

    def kill_at_send(self, number: int) -> None:
        """Ends the process before it sends datagram `number` from now on, from 1."""
        self._die_in = number

    def cut_off(self, reached_port: int) -> None:
        """Loses everything that the process sends from now on, but to the group on one port."""
        self.reached_port = reached_port

    def stand_still(self, time_us: int) -> None:
        """Stops the process for some wall time."""
        self._world.trace.add(self._world.now_us, self.name, f"stands still for {time_us} us")
        self._stopped_until_us = max(self._stopped_until_us, self._world.now_us + time_us)

    def stand_still_at_send(self, number: int, time_us: int) -> None:
        """Stops the process for some wall time before it sends datagram `number` from now on."""
        self._stop_in, self._stop_us = number, time_us

    def go_on(self) -> None:
        """Continues the stopped process."""
        self._stopped_until_us = 0
        self._schedule(self._world.now_us)

    def work(self, time_us: int) -> None:
        """Takes wall time in the running step."""
        self.local_us += time_us

    @property
    def alive(self) -> bool:
        """Returns whether the process runs."""
        return self.died_us is None

    def _open(self, port: int, group: bool) -> SimulatedSocket:
        made = self._ether.open(self, port, group)
        self._sockets.append(made)
        return made

    def _schedule(self, due_us: int) -> None:
        """Wakes the process at that time unless it wakes up earlier anyway."""
        due_us = max(due_us, self.local_us, self._stopped_until_us)
        if due_us < self._wake_us and self._started and self.alive:
            self._wake_us = due_us
            self._wakes += 1
            self._world.at(due_us, partial(self._wake, self._wakes))

    def _wake(self, number: int) -> None:
        if number != self._wakes or not self.alive:
            return
        self._wake_us = _NEVER_US
        world = self._world
        weather = world.weather
        if self._stopped_until_us > world.now_us:
            self._schedule(self._stopped_until_us)
        elif weather.hiccup and world.random.random() < weather.hiccup:
            self.local_us = max(self.local_us, world.now_us + int(world.random.random() * weather.hiccup_us))
            self._schedule_next()
        else:
            self._step([descriptor for descriptor, source in self._watched.items() if source.readable])

    def _begin(self, make: Callable[[], Steps[Any]]) -> None:
        if not self.alive:
            return
        self._started = True
        self._wake_us = _NEVER_US
        self._run(partial(self._first, make))

    def _first(self, make: Callable[[], Steps[Any]]) -> int:
        self._steps = make()
        return next(self._steps)

    def _step(self, readable: list[int]) -> None:
        assert self._steps
        if len(readable) > 1:
            self._world.random.shuffle(readable)
        done = self._done
        self._run(partial(self._steps.send, readable))
        self._spins = self._spins + 1 if readable and self._done == done else 0
        if self._spins > SPINS_MAX and not self.error:
            ports = [source.port for source in self._watched.values() if isinstance(source, SimulatedSocket)]
            self.error = f"wakes up again and again and reads nothing; it waits for ports {ports}"

    def _run(self, advance: Callable[[], int]) -> None:
        world = self._world
        self.local_us = max(self.local_us, world.now_us) + STEP_US
        before, world.running = world.running, self
        try:
            self._until_us = advance()
        except StopIteration as end:
            self._end(end.value if isinstance(end.value, int) else 0)
        except ComponentFailedError:
            self._end(1)
        except Exception:  # a participant must not raise anything else: a defect
            self.error = traceback.format_exc()
            world.trace.add(self.local_us, self.name, f"fails: {self.error}")
            self._end(1)
        else:
            if self.alive:
                self._schedule_next()
            else:
                self._end(KILLED)
        finally:
            world.running = before
        if self._steps and not self.alive:
            self._close()

    def _close(self) -> None:
        """Runs the participant's `finally` clauses; their datagrams are dropped."""
        steps, self._steps = self._steps, None
        try:
            if steps:
                steps.close()
        except Exception:  # the process died in the middle of a step
            self._world.trace.add(self.local_us, self.name, f"is gone: {traceback.format_exc(limit=1)}")

    def _schedule_next(self) -> None:
        readable = any(source.readable for source in self._watched.values()) or self.signals
        self._schedule(self._world.now_us if readable else self._until_us)

    def _end(self, code: int) -> None:
        """Closes the sockets; the end is reported a little later, while the last datagrams are on their way."""
        if self.died_us is None:
            self.died_us = self.local_us
            self._world.trace.add(self.local_us, self.name, f"ends with exit code {code}")
        elif code != KILLED:
            code = KILLED  # the process died in the middle of its last step
        if self._steps and self._world.running is not self:
            self._close()
        for socket in self._sockets:
            socket.close()
        for source in self._watched.values():
            source.watcher = None
        self._watched = {}
        self._world.at(max(self.died_us, self._world.now_us), partial(self._ended, code))
