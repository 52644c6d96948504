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
    from fwk.component.blackboard import Blackboard, NotOpen
    from fwk.component.channels import Reads, ReadsEach, Writes, WritesEach, channel
    from fwk.component.commands import Command, CommandError, Commands, CommandState
    from fwk.component.component import Component
    from fwk.component.config import Config
    from fwk.component.images import FrameError, Image, ImagesEach, VisionMaster
    from fwk.component.log import Logger
    from fwk.component.log_lines import LogLines
    from fwk.component.main_loop import MainLoop
    from fwk.component.plugins import PluginControl
    from fwk.component.requests import Call, Calls, CallsEach, Request, Serves
    from fwk.component.sending import Future, Sends, SendsEach
    from fwk.component.services_each import CommandsEach, ServesEach
    from fwk.component.transform_tree import Transform, TransformError, TransformTree
    from fwk.component.transforms import Transforms, transform_message
    from fwk.lcm.messages import Header, MessageError
    from fwk.model.channel_table import BlackboardEvent

_MODULES = {
    "pydantic": ("Field",),
    "fwk.clock": ("Clock", "TimeSource"),
    "fwk.component.aspect": ("Aspect",),
    "fwk.component.blackboard": ("Blackboard", "NotOpen"),
    "fwk.component.channels": ("Reads", "ReadsEach", "Writes", "WritesEach", "channel"),
    "fwk.component.commands": ("Command", "CommandError", "CommandState", "Commands"),
    "fwk.component.component": ("Component",),
    "fwk.component.config": ("Config",),
    "fwk.component.images": ("FrameError", "Image", "ImagesEach", "VisionMaster"),
    "fwk.component.log": ("Logger",),
    "fwk.component.log_lines": ("LogLines",),
    "fwk.component.main_loop": ("MainLoop",),
    "fwk.component.plugins": ("PluginControl",),
    "fwk.component.requests": ("Call", "Calls", "CallsEach", "Request", "Serves"),
    "fwk.component.sending": ("Future", "Sends", "SendsEach"),
    "fwk.component.services_each": ("CommandsEach", "ServesEach"),
    "fwk.component.transform_tree": ("Transform", "TransformError", "TransformTree"),
    "fwk.component.transforms": ("Transforms", "transform_message"),
    "fwk.lcm.messages": ("Header", "MessageError"),
    "fwk.model.channel_table": ("BlackboardEvent",),
}
_MODULE_OF = {name: module for module, names in _MODULES.items() for name in names}

__all__ = [
    "Aspect",
    "Blackboard",
    "BlackboardEvent",
    "Call",
    "Calls",
    "CallsEach",
    "Clock",
    "Command",
    "CommandError",
    "CommandState",
    "Commands",
    "CommandsEach",
    "Component",
    "Config",
    "Field",
    "FrameError",
    "Future",
    "Header",
    "Image",
    "ImagesEach",
    "LogLines",
    "Logger",
    "MainLoop",
    "MessageError",
    "NotOpen",
    "PluginControl",
    "Reads",
    "ReadsEach",
    "Request",
    "Sends",
    "SendsEach",
    "Serves",
    "ServesEach",
    "TimeSource",
    "Transform",
    "TransformError",
    "TransformTree",
    "Transforms",
    "VisionMaster",
    "Writes",
    "WritesEach",
    "channel",
    "transform_message",
]


def __getattr__(name: str) -> object:
    """Imports the module that defines `name` and keeps its value."""
    if name not in _MODULE_OF:
        raise AttributeError(f"module 'fwk' has no attribute '{name}'")
    value = globals()[name] = getattr(import_module(_MODULE_OF[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
