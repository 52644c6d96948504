"""Aspects that a component provides: what it writes, bundled with the behaviour that makes it easy to use."""


class Aspect:
    """What one component provides and others ask for by annotation.

    ```python
    class Battery(Aspect):
        charge: Reads[charge_t]  # what the provider writes as `charge`

        def low(self) -> bool:
            return self.charge.has_value and self.charge.value.percent < 20.0

    class Gauge(Component):
        provides = Battery
        charge: Writes[charge_t]

    class Agent(Component):
        battery: Battery  # only with a Gauge in the plan, and not before it is ready
    ```
    Each component that asks has an aspect of its own. Its annotated lines may be `Reads`, `ReadsEach`, `Image`, `Clock`
    and `Logger`. `Reads` and `Image` stand for what the provider writes under the same name.
    """

    def init(self) -> None:
        """Called before the component's own `init`; an exception means that the component does not start."""

    def begin(self) -> None:
        """Called at the beginning of each iteration, when the inputs are frozen."""
