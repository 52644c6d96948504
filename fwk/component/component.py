"""The base class of components."""

from typing import TYPE_CHECKING, Any, ClassVar

from fwk.component.aspect import Aspect
from fwk.component.undeclared import explanation

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
    """Base class of components, the units of deployment. Annotated lines declare what is there before `init`.

    | annotation | gives |
    | --- | --- |
    | `ball: Reads[ball_t]` | newest value of `<namespace>/ball`, and all values since the last iteration |
    | `ball: Reads[ball_t] = channel(history=20)` | also the newest 20 values in `self.ball.history` |
    | `pose: Writes[pose_t]` | the one writer of `<namespace>/pose` |
    | `kick: Serves[kick_t]`, `kick: Calls[kick_t]` | commands `<namespace>/kick`, to carry out or to send |
    | `path: Serves[path_request_t, path_t]`, `path: Calls[...]` | requests with a typed reply |
    | `image: Image`, `image: VisionMaster` | frames of a camera, to read or to publish |
    | `motors: Each[Reads[motor_t]]`, `Each[Calls[...]]` | ports of one kind, one for each namespace |
    | `config: MyConfig` | checked settings |
    | `clock: Clock` | logical time |
    | `log: Logger` | the run's log |
    | `lines: LogLines` | log lines of the other components |
    | `rng: np.random.Generator` | random numbers, seeded from the run's seed and the component's name |
    | `time_source: TimeSource` | logical time of the next tick; one component of a system |
    | `main_loop: MainLoop` | takes over the main loop and gives it back |
    | `blackboard: Blackboard` | opens and lists channels during the run |
    | `plugins: PluginControl` | starts, stops and reloads other components |
    | `tf: Transforms`, any class derived from `Aspect` | provided by another component |
    """

    stage: ClassVar[str | tuple[str, ...]]
    """Stages in which the component iterates."""
    every: ClassVar[int] = 1
    """Iterates in one of `every` ticks: when `tick % every == offset % every`. Messages of the ticks between wait."""
    offset: ClassVar[int] = 0
    """Shifts these ticks, so that components can take turns."""
    rate_hz: ClassVar[float | None] = None
    """Instead of a stage: iterations per second of a continuous component; 0: one for each newer input."""
    provides: ClassVar[type[Aspect] | tuple[type[Aspect], ...]] = ()
    """Aspects that other components get from this component."""
    reaches_outside: ClassVar[bool | None] = None
    """Whether the component drives a device, talks to other programs or writes files.

    True: a replay does not run it. None: a replay runs it until it opens a device, a connection, a program or a file to
    write. False: a replay runs it, and it may open them.
    """
    name: str
    """Full name: `cyan1/omni_ball`."""
    changed_settings: frozenset[str] = frozenset()
    """Dotted names of the settings that the newest change has changed, for `config_changed`."""

    if not TYPE_CHECKING:  # type checkers would take every attribute for declared

        def __getattr__(self, name: str) -> Any:
            """Names the line that declares an attribute which is used without it.

            Raises:
                AttributeError: always; Python calls this method for attributes that do not exist.
            """
            raise AttributeError(explanation(type(self), vars(self), name))

    @classmethod
    def preload(cls, config: Any) -> None:
        """Called before processes are forked, once for each component: makes read-only data that processes share.

        Typically it fills a cache with tables that are never written to, where `init` finds them. Nothing may depend on
        the call: it does not happen in tests and for a component that is started by hand.
        """

    @classmethod
    def unrepeatable(cls, config: Any) -> str:  # noqa: ARG003 - for subclasses
        """Returns why a replay cannot run the component with these settings, such as `'/dev/video0' is a device`.

        An empty text means that it can. Components that depend on more than their inputs override this method.
        """
        return "it reaches outside" if cls.reaches_outside else ""

    def init(self) -> None:
        """Called once before the first iteration; after an exception the component does not start.

        Its messages are sent with the first iteration and come first in it. There is no tick yet: `clock` shows 0.
        """

    def loop(self) -> None:
        """Called once in each iteration."""

    def config_changed(self) -> None:
        """Called between two iterations after settings were changed; `self.config` holds the new values.

        Anything that `init` derives from a setting is to be derived again here; `self.changed_settings` names the
        settings.
        """

    def finalize(self) -> None:
        """Called once after the last iteration, when the component is stopped or the run ends.

        Its messages are visible like those of an iteration if the run goes on, so an actuator's driver can stop the
        actuator.
        """
