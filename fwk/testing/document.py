"""Documents of tests, such as scenarios: YAML that is read as launch files are, with file and line of each mistake."""

from typing import TypeVar

from pydantic import BaseModel

from fwk.model.errors import Problems
from fwk.plan.files.source import Node, read_text
from fwk.plan.files.validation import validated

M = TypeVar("M", bound=BaseModel)


class Document:
    """Values of a YAML text, and their mistakes."""

    def __init__(self, text: str, name: str) -> None:
        """Reads the text.

        Args:
            text: the YAML.
            name: of the file, for the mistakes.

        Raises:
            PlanError: the text is not YAML.
        """
        self._problems = Problems()
        self._node = read_text(text, name, self._problems) or Node({}, f"{name}:1")
        self.raise_mistakes()

    def values(self, model: type[M], *path: str, who: str = "", what: str = "key") -> M | None:
        """Returns the values at a path as an instance of a model; adds the mistakes.

        Args:
            model: the model.
            path: keys from the outermost level to the values.
            who: what the mistakes are about, such as a component.
            what: word for a key.

        Returns:
            The values that fit; None if none do.
        """

        def report(_: object, place: str, text: str) -> None:
            self._problems.add(place, who, text)

        node: Node | None = self._node
        for key in path:
            node = node.child(key) if node else None
        found = validated(model, node or Node({}, self._node.place), report, what)
        return found[0] if found else None

    def add(self, text: str, *path: str | int) -> None:
        """Adds a mistake of the value at a path."""
        self._problems.add(self.place(*path), "", text)

    def place(self, *path: str | int) -> str:
        """Returns file and line of the value at a path."""
        return self._node.at(*path).place

    def raise_mistakes(self) -> None:
        """Ends the check if there is a mistake.

        Raises:
            PlanError: all mistakes so far, in the order of their lines.
        """
        self._problems.stop_if_any()
