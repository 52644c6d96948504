"""A component whose iterations are carried out by a program in any language."""

import re
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any, Literal

from pydantic import Field

from fwk.clock import US_PER_S, Clock
from fwk.component.calls import Calls
from fwk.component.channels import Reads, Writes
from fwk.component.child_process import ChildProcess, ProgramError
from fwk.component.component import Component
from fwk.component.config import Config
from fwk.component.file_process import FileProcess
from fwk.component.program_coding import CODINGS, FINAL, INIT, ProgramRequest
from fwk.component.program_services import CalledPort, ServedPort, ServicePort
from fwk.component.services import Serves
from fwk.lcm.messages import MessageError, type_named

MODULE = "fwk.component.program"
_TEXT = re.compile(r"Program\((.*)\)")
_PORT = re.compile(r"(\w+): (Reads|Writes|Serves|Calls)\[([\w.]+)(?:; ([\w.]+))?\]")
_KINDS: dict[str, Any] = {"Reads": Reads, "Writes": Writes, "Serves": Serves, "Calls": Calls}


class ProgramConfig(Config):
    """Settings of a program."""

    command: list[str] = Field(min_length=1, frozen=True)
    """The program and its arguments; words with a slash that are files are looked for beside the launch file, too."""
    coding: Literal["json", "lcm", "files"] = Field("json", frozen=True)
    """`json`: one line of JSON for each iteration and each answer; `lcm`: LCM messages, for programs with fwk.h;
    `files`: the program is started for each iteration, reads `input.json` and writes `output.json`.
    """
    answer_timeout_s: float | None = Field(None, gt=0.0)
    """Wall time after which a program without an answer has failed; by default no limit."""
    repeatable: bool = Field(False, frozen=True)
    """Whether a replay runs the program: it does so only if its answers depend on its inputs alone."""
    settings: dict[str, Any] = {}
    """Settings for the program itself, sent with its first request and after each change."""


class Program(Component):
    """Runs a program as a child process: each iteration is one request to it and one answer of it.

    The program starts with the component, ends with it, and is started again with it. A program that ends, gives no
    valid answer or none in time fails the component.
    """

    stage = "think"
    reaches_outside = False  # starts a program, also in a replay; `unrepeatable` decides whether there is one

    config: ProgramConfig
    clock: Clock

    @classmethod
    def unrepeatable(cls, config: Any) -> str:
        """Returns that the component runs a program, unless its settings call the program repeatable."""
        return "" if config.repeatable else f"it runs the program '{' '.join(config.command)}'"

    def init(self) -> None:
        """Starts the program and sends the first request."""
        ports = vars(self)
        self._services: dict[str, ServicePort] = {}
        for name, port in ports.items():
            if isinstance(port, Serves):
                self._services[name] = ServedPort(name, port)
            elif isinstance(port, Calls):
                self._services[name] = CalledPort(name, port)
        readers = {name: port for name, port in ports.items() if isinstance(port, Reads)}
        writers = {name: port for name, port in ports.items() if isinstance(port, Writes)}
        self._readers: dict[str, Reads[Any] | ServicePort] = {**readers, **self._services}
        self._writers: dict[str, Writes[Any] | ServicePort] = {**writers, **self._services}
        self._coding = CODINGS[self.config.coding]
        self._is_started_again = self.config.coding == "files"
        kind = FileProcess if self._is_started_again else ChildProcess
        self._child: FileProcess | ChildProcess = kind(self.config.command)
        about = {"name": self.name, "period_s": self.clock.iteration_s, "settings": self.config.settings}
        self._news: dict[str, Any] = {**about, "reads": [*self._readers], "writes": [*self._writers]}
        if not self._is_started_again:
            self._exchange(INIT)

    def loop(self) -> None:
        """Sends the inputs of the iteration and writes the messages of the answer."""
        self._exchange(self.clock.stage)

    def config_changed(self) -> None:
        """Sends changed settings with the next request."""
        self._news |= {"settings": self.config.settings}

    def finalize(self) -> None:
        """Sends the last request, and ends the program."""
        if not self._is_started_again:
            self._exchange(FINAL)
        self._child.close()

    def _exchange(self, stage: str) -> None:
        news = self._news
        if not self._is_started_again:  # a program that is started again knows nothing of the requests before
            self._news = {}
        period_us = round(self.clock.iteration_s * US_PER_S)
        readers = {} if stage == FINAL else self._readers  # the last iteration has had them
        for service in self._services.values() if stage not in (INIT, FINAL) else ():
            service.begin()
        asked = ProgramRequest(stage, self.clock.tick, self.clock.now_us, period_us, readers, news)
        data = self._child.exchange(self._coding.request(asked), self._coding.length_of, self.config.answer_timeout_s)
        try:
            for port, message in self._coding.answer(data, self._writers):
                target = self._writers[port]
                if isinstance(target, Writes):
                    target.value = message
                    target.write()
                else:
                    target.take(message)
        except (ProgramError, MessageError) as error:
            self._child.kill()
            raise ProgramError(f"'{self._child.command}': {error}") from error


Ports = Mapping[str, str | Sequence[str]]
"""Name of a port to its message type, or to the types of request and reply."""


def program_class_name(reads: Ports, writes: Ports, serves: Ports | None = None, calls: Ports | None = None) -> str:
    """Returns the name of a program's class, which declares its ports: `Program(ball: Reads[play.ball_t])`."""
    return f"Program({', '.join(_ports_in_words(reads, writes, serves or {}, calls or {}))})"


def _ports_in_words(*groups: Ports) -> list[str]:
    return [
        f"{name}: {kind}[{'; '.join(map(str, types)) if isinstance(types, list | tuple) else types}]"
        for kind, ports in zip(_KINDS, groups, strict=True)
        for name, types in ports.items()
    ]


@cache
def __getattr__(name: str) -> type[Program]:
    """Makes the class of that name, so that plans and recordings refer to it as to any other class.

    Raises:
        AttributeError: the name is not one of `program_class_name`, or a type does not exist.
    """
    found = _TEXT.fullmatch(name)
    if not found:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    annotations = {}
    for text in filter(None, found[1].split(", ")):
        port = _PORT.fullmatch(text)
        if not port:
            raise AttributeError(f"'{text}' is not a port; write ball: Reads[play.ball_t]")
        try:
            types = tuple(type_named(each) for each in port.groups()[2:] if each)
            if len(types) > 1 and port[2] in ("Reads", "Writes"):
                raise AttributeError(f"'{text}' has two types; a port that reads or writes has one")
            annotations[port[1]] = _KINDS[port[2]][types]
        except MessageError as error:
            raise AttributeError(f"{port[1]}: {error}") from error
    return type(name, (Program,), {"__annotations__": annotations, "__module__": __name__})
