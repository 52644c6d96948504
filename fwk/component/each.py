"""Ports to many channels: one port for each namespace."""

from collections.abc import ItemsView, Iterator, Mapping
from typing import Generic, TypeVar

P = TypeVar("P")


class Each(Mapping[str, P], Generic[P]):
    """Ports of one kind by namespace, in alphabetical order: `motors: Each[Reads[motor_t]]`.

    `for robot, motor in self.motors.items(): ...`

    `Each[Reads[...]]` and `Each[Image]` have a port for every channel that matches and that a component writes,
    `Each[Writes[...]]` one for every such channel that a component reads, `Each[Serves[...]]` one for every such
    service that a component calls, `Each[Calls[...]]` one for every such service that a component offers.
    """

    def __init__(self, ports: Mapping[str, P]) -> None:
        self._ports = dict(sorted(ports.items()))

    def __getitem__(self, key: str) -> P:
        return self._ports[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._ports)

    def __len__(self) -> int:
        return len(self._ports)

    def items(self) -> ItemsView[str, P]:
        """Pairs of namespace and port."""
        return self._ports.items()
