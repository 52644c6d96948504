"""The base class of components."""

from typing import Any, ClassVar

from fwk.component.aspect import Aspect

DEFAULT_STAGES = (
    "pre_loop",
    "sensor_acquire",
    "sensor_prepare",
    "sensor_process",
    "worldstate",
    "think",
    "skill",
    "act",
    "act_exec",
    "post_loop",
)


class Component:
    """A unit of deployment. What it wants stands in annotated lines and is there before `init`.

    | annotation | gives |
    | --- | --- |
    | `ball: Reads[ball_t]` | newest value and all since the last iteration of `<namespace>/ball` |
    | `ball: Reads[ball_t] = channel(history=20)` | besides, the newest 20 in `self.ball.history` |
    | `pose: Writes[pose_t]` | the one writer of `<namespace>/pose` |
    | `ReadsEach[...]`, `WritesEach[...]` | many instances of an interface, by namespace |
    | `kick: Commands[kick_t]` | the commands `<namespace>/kick`, to carry out; one such component each |
    | `kick: Sends[kick_t]` | sends them, and sees what becomes of each |
    | `path: Serves[path_request_t, path_t]`, `path: Calls[...]` | requests with a typed reply, to answer; to ask |
    | `SendsEach[...]`, `CallsEach[...]` | to many of those who carry them out, by namespace |
    | `CommandsEach[...]`, `ServesEach[...]` | to carry out for many, by namespace |
    | `image: Image`, `image: VisionMaster` | frames of a camera, to read or to give out |
    | `image: ImagesEach` | frames of many cameras, by namespace |
    | `config: MyConfig` | checked settings |
    | `clock: Clock` | logical time |
    | `log: Logger` | the system's log |
    | `rng: np.random.Generator` | random numbers, seeded from the run's seed and the component's name |
    | `time_source: TimeSource` | says when the next tick happens; one a system |
    | `main_loop: MainLoop` | takes over the main loop, and gives it back; one at a time |
    | `blackboard: Blackboard` | opens channels while it runs, and tells who is there |
    | `plugins: PluginControl` | starts, stops and exchanges other components |
    | `tf: Transforms`, any class derived from `Aspect` | what another component provides |
    """

    stage: ClassVar[str | tuple[str, ...]]
    provides: ClassVar[type[Aspect] | tuple[type[Aspect], ...]] = ()
    """Aspects that others get from this component."""
    rate_hz: ClassVar[float | None] = None
    """Instead of a stage: iterations a second of a continuous component; 0: again when there is something newer."""
    reaches_outside: ClassVar[bool | None] = None
    """Whether the component drives a device or talks to other programs. True: a replay leaves it alone. None: a replay
    runs it, and leaves it alone as soon as it opens a device, a connection or a program. False: a replay lets it do so.
    """
    name: str
    """Full name: `cyan1/omni_ball`."""
    changed_settings: frozenset[str] = frozenset()
    """What the newest change of settings has changed; dotted names, for `config_changed`."""

    @classmethod
    def preload(cls, config: Any) -> None:
        """Called before processes are forked, once for each setting of the class: make here what all can share.

        Fill a cache with tables that are never written to; the component's `init` finds them there. Nothing may depend
        on it: a component started by hand or in a test has to do without.
        """

    @classmethod
    def unrepeatable(cls, config: Any) -> str:  # noqa: ARG003 - for those who derive
        """Returns why a replay cannot run the component with these settings; empty: it can.

        For components that depend on more than their inputs, for example `'/dev/video0' is a device`. A replay leaves
        them alone.
        """
        return "it reaches outside" if cls.reaches_outside else ""

    def init(self) -> None:
        """Called once before the first iteration; an exception means that the component does not start.

        What it writes goes out with the first iteration, as the first of it. There is no tick yet, so `clock` says 0.
        """

    def loop(self) -> None:
        """One iteration."""

    def config_changed(self) -> None:
        """Called between two iterations when settings were changed; `self.config` has the new ones.

        What `init` has made of the old ones has to be made anew here; `self.changed_settings` says which they are.
        """

    def finalize(self) -> None:
        """Called once after the last iteration, when the component is stopped or the run ends.

        What it writes is seen as that of an iteration if the run goes on: an actuator's driver leaves it stopped.
        """
