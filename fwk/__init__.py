"""fwk: a step-exact component framework for robots, on LCM."""

import os

# Several processes share few cores: a linear-algebra thread pool in each would only get in the others' way, and the
# order in which its threads finish would show in the last bits of results.
for _variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")

from pydantic import Field  # noqa: E402 - after the limits

from fwk.clock import Clock, TimeSource  # noqa: E402
from fwk.component.aspect import Aspect  # noqa: E402
from fwk.component.blackboard import Blackboard, NotOpen  # noqa: E402
from fwk.component.channels import Reads, ReadsEach, Writes, WritesEach, channel  # noqa: E402
from fwk.component.commands import Command, CommandError, Commands, CommandState  # noqa: E402
from fwk.component.component import Component  # noqa: E402
from fwk.component.config import Config  # noqa: E402
from fwk.component.images import Image, ImagesEach, VisionMaster  # noqa: E402
from fwk.component.log import Logger  # noqa: E402
from fwk.component.log_lines import LogLines  # noqa: E402
from fwk.component.main_loop import MainLoop  # noqa: E402
from fwk.component.plugins import PluginControl  # noqa: E402
from fwk.component.requests import Call, Calls, CallsEach, Request, Serves  # noqa: E402
from fwk.component.sending import Future, Sends, SendsEach  # noqa: E402
from fwk.component.services_each import CommandsEach, ServesEach  # noqa: E402
from fwk.component.transform_tree import Transform, TransformError, TransformTree  # noqa: E402
from fwk.component.transforms import Transforms  # noqa: E402
from fwk.component.transforms import message_of as transform_message  # noqa: E402
from fwk.model.channel_table import BlackboardEvent  # noqa: E402

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
    "Future",
    "Image",
    "ImagesEach",
    "LogLines",
    "Logger",
    "MainLoop",
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
