"""Aspects that components provide: channels bundled with methods that make them easy to use."""


class Aspect:
    """Base class of aspects that one component provides and other components declare.

    ```python
    class Battery(Aspect):
        charge: Reads[charge_t]  # the channel that the provider writes as `charge`

        def low(self) -> bool:
            return self.charge.has_value and self.charge.value.percent < 20.0

    class Gauge(Component):
        provides = Battery
        charge: Writes[charge_t]

    class Agent(Component):
        battery: Battery  # needs a Gauge in the plan, and starts when it is ready
    ```
    Each component that declares the aspect has an object of its own. The annotated lines of an aspect may be `Reads`,
    `Each[Reads[...]]`, `Image`, `Clock` and `Logger`. `Reads` and `Image` connect to the channel that the provider
    writes under the same name.
    """

    def init(self) -> None:
        """Called before the component's `init`; after an exception the component does not start."""

    def begin(self) -> None:
        """Called at the beginning of each iteration, after the inputs are frozen."""
