"""The measured arrangements: sizes, number of reads, message sizes, packet loss."""

from dataclasses import dataclass

from tools.bench.shape import Shape

SIZES = (5, 20, 40, 80, 160)
_LARGE_BYTES = 64 * 1024
_TICKS_TIMES_COMPONENTS = 10_000
_TICKS_MAX = 500


@dataclass(frozen=True)
class Scenario:
    """One column of the tables."""

    name: str
    shape: Shape
    loss: float = 0.0
    """Share of IP packets that are dropped."""

    @property
    def is_plain(self) -> bool:
        """Whether it differs from the others only in the number of components."""
        return self.loss == 0 and self.shape.reads == 1 and self.shape.padding_bytes == 0

    @property
    def ticks(self) -> int:
        """Number of measured ticks; fewer for many components, to keep runs short."""
        return min(_TICKS_MAX, max(50, _TICKS_TIMES_COMPONENTS // self.shape.components))


def growth(sizes: tuple[int, ...] = SIZES) -> list[Scenario]:
    """Returns the same work with more and more components."""
    return [Scenario(f"N={size}", Shape(size)) for size in sizes]


def variations(sizes: tuple[int, ...] = (20, 80)) -> list[Scenario]:
    """Returns other arrangements than the plain one: ten reads a component, large messages, packet loss."""
    made = []
    for size in sizes:
        made += [
            Scenario(f"N={size}, 10 reads", Shape(size, reads=10)),
            Scenario(f"N={size}, 64 KiB", Shape(size, padding_bytes=_LARGE_BYTES)),
            Scenario(f"N={size}, loss 1 %", Shape(size), 0.01),
            Scenario(f"N={size}, loss 5 %", Shape(size), 0.05),
        ]
    return made
