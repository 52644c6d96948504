"""fwk: a step-exact component framework for robots, on LCM."""

import os

# Several processes share few cores: a linear-algebra thread pool in each would only get in the others' way, and the
# order in which its threads finish would show in the last bits of results.
for _variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_variable, "1")

from pydantic import Field  # noqa: E402 - after the limits

from fwk.aspects.blackboard import Reads, ReadsEach, Writes, WritesEach, channel  # noqa: E402
from fwk.aspects.commands import Command, CommandError, Commands, CommandState  # noqa: E402
from fwk.aspects.commands_each import CommandsEach, ServesEach  # noqa: E402
from fwk.aspects.log_lines import LogLines  # noqa: E402
from fwk.aspects.logging import Logger  # noqa: E402
from fwk.aspects.main_loop import MainLoop  # noqa: E402
from fwk.aspects.opening import Blackboard, NotOpen  # noqa: E402
from fwk.aspects.plugins import PluginControl  # noqa: E402
from fwk.aspects.provided import Aspect  # noqa: E402
from fwk.aspects.rpc import Call, Calls, CallsEach, Request, Serves  # noqa: E402
from fwk.aspects.sending import Future, Sends, SendsEach  # noqa: E402
from fwk.aspects.vision import Image, ImagesEach, VisionMaster  # noqa: E402
from fwk.clock import Clock, TimeSource  # noqa: E402
from fwk.component import Component  # noqa: E402
from fwk.config import Config  # noqa: E402
from fwk.instances import BlackboardEvent  # noqa: E402

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
    "VisionMaster",
    "Writes",
    "WritesEach",
    "channel",
]
