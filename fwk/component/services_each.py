"""The commands aspect for a component that carries them out for many, such as a simulator for all robots."""

from typing import Generic, TypeVar

from fwk.component.commands import Commands
from fwk.component.requests import Serves
from fwk.component.sending import Each

T = TypeVar("T")
Q = TypeVar("Q")
R = TypeVar("R")


class CommandsEach(Each[Commands[T]], Generic[T]):
    """The commands to many, by namespace: one queue for each that somebody sends commands to.

    `for robot, kick in self.kicks.items(): ...`
    """


class ServesEach(Each[Serves[Q, R]], Generic[Q, R]):
    """The requests to many, by namespace: one queue for each that somebody asks."""
