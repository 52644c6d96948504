"""fwk: a step-exact component framework for robots, on LCM.

`from fwk import Component, Reads, ...` gives component authors everything that they need. A name is imported when it is
first used, so `import fwk` alone loads no library.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pydantic import Field

    from fwk.clock import Clock, TimeSource
    from fwk.component.aspect import Aspect
    from fwk.component.blackboard import Blackboard, NotOpenError
    from fwk.component.calls import Call, Calls
    from fwk.component.channels import Reads, Writes, channel
    from fwk.component.component import Component
    from fwk.component.config import Alike, Config
    from fwk.component.each import Each
    from fwk.component.former_names import CallsEach as CallsEach
    from fwk.component.former_names import Command as Command
    from fwk.component.former_names import CommandError as CommandError
    from fwk.component.former_names import Commands as Commands
    from fwk.component.former_names import CommandsEach as CommandsEach
    from fwk.component.former_names import CommandState as CommandState
    from fwk.component.former_names import Future as Future
    from fwk.component.former_names import ImagesEach as ImagesEach
    from fwk.component.former_names import NotOpen as NotOpen
    from fwk.component.former_names import ReadsEach as ReadsEach
    from fwk.component.former_names import Sends as Sends
    from fwk.component.former_names import SendsEach as SendsEach
    from fwk.component.former_names import ServesEach as ServesEach
    from fwk.component.former_names import WritesEach as WritesEach
    from fwk.component.images import FrameError, Image, VisionMaster
    from fwk.component.log import Logger
    from fwk.component.log_lines import LogLines
    from fwk.component.main_loop import MainLoop
    from fwk.component.plugins import PluginControl
    from fwk.component.services import Request, RequestState, Serves, ServiceError
    from fwk.component.transform_tree import Transform, TransformError, TransformTree
    from fwk.component.transforms import Transforms, transform_message
    from fwk.lcm.messages import Header, MessageError
    from fwk.model.channel_table import BlackboardEvent

_MODULES = {
    "pydantic": ("Field",),
    "fwk.clock": ("Clock", "TimeSource"),
    "fwk.component.aspect": ("Aspect",),
    "fwk.component.blackboard": ("Blackboard", "NotOpenError"),
    "fwk.component.calls": ("Call", "Calls"),
    "fwk.component.channels": ("Reads", "Writes", "channel"),
    "fwk.component.component": ("Component",),
    "fwk.component.config": ("Alike", "Config"),
    "fwk.component.each": ("Each",),
    "fwk.component.images": ("FrameError", "Image", "VisionMaster"),
    "fwk.component.log": ("Logger",),
    "fwk.component.log_lines": ("LogLines",),
    "fwk.component.main_loop": ("MainLoop",),
    "fwk.component.plugins": ("PluginControl",),
    "fwk.component.services": ("Request", "RequestState", "Serves", "ServiceError"),
    "fwk.component.transform_tree": ("Transform", "TransformError", "TransformTree"),
    "fwk.component.transforms": ("Transforms", "transform_message"),
    "fwk.lcm.messages": ("Header", "MessageError"),
    "fwk.model.channel_table": ("BlackboardEvent",),
}
_MODULE_OF = {name: module for module, names in _MODULES.items() for name in names}
_FORMER = (
    *("CallsEach", "Command", "CommandError", "CommandState", "Commands", "CommandsEach", "Future", "ImagesEach"),
    *("NotOpen", "ReadsEach", "Sends", "SendsEach", "ServesEach", "WritesEach"),
)
"""Former names, which earlier components and their recordings use."""

__all__ = [
    "Alike",
    "Aspect",
    "Blackboard",
    "BlackboardEvent",
    "Call",
    "Calls",
    "Clock",
    "Component",
    "Config",
    "Each",
    "Field",
    "FrameError",
    "Header",
    "Image",
    "LogLines",
    "Logger",
    "MainLoop",
    "MessageError",
    "NotOpenError",
    "PluginControl",
    "Reads",
    "Request",
    "RequestState",
    "Serves",
    "ServiceError",
    "TimeSource",
    "Transform",
    "TransformError",
    "TransformTree",
    "Transforms",
    "VisionMaster",
    "Writes",
    "channel",
    "transform_message",
]


def __getattr__(name: str) -> object:
    """Imports the module that defines `name` and keeps its value."""
    module = "fwk.component.former_names" if name in _FORMER else _MODULE_OF.get(name)
    if module is None:
        raise AttributeError(f"module 'fwk' has no attribute '{name}'")
    value = globals()[name] = getattr(import_module(module), name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
