"""The simulated machine below components: processor time, and a disk that remembers."""

from collections.abc import Callable
from dataclasses import dataclass, field


def _no_work(_time_us: int) -> None:
    pass


def _no_process() -> str:
    return ""


@dataclass
class Machine:
    """The machine that the components of this process run on; outside the simulated world it does nothing.

    A replay runs outside the world, so its components neither take time nor fail.
    """

    simulated: bool = False
    work: Callable[[int], None] = _no_work
    """Takes wall time in microseconds."""
    process: Callable[[], str] = _no_process
    """Returns the name of the running process."""
    iterations: list[tuple[str, str, int, int]] = field(default_factory=list)
    """Every iteration so far: process, component, tick, step of the tick."""
    marks: set[str] = field(default_factory=set)

    def enter(self, work: Callable[[int], None], process: Callable[[], str]) -> None:
        """Lets components run on a simulated machine."""
        self.__init__(True, work, process)  # type: ignore[misc]  # replaced as a whole

    def leave(self) -> None:
        """Lets components run on a machine without time and memory."""
        self.__init__()  # type: ignore[misc]  # replaced as a whole

    def once(self, mark: str) -> bool:
        """Returns whether this is the first call with `mark` in any process; False outside the simulation."""
        if not self.simulated or mark in self.marks:
            return False
        self.marks.add(mark)
        return True


machine = Machine()
