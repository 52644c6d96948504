"""Former names of the public API, so that components and recordings of earlier versions run as they are."""

from typing import TypeVar

from fwk.component.blackboard import NotOpenError
from fwk.component.calls import Call, Calls
from fwk.component.channels import Reads, Writes
from fwk.component.each import Each
from fwk.component.images import Image
from fwk.component.services import Request, RequestState, Serves, ServiceError

T = TypeVar("T")
Q = TypeVar("Q")
R = TypeVar("R")

Command = Request
Commands = Serves
CommandError = ServiceError
CommandState = RequestState
Sends = Calls
Future = Call
NotOpen = NotOpenError

ReadsEach = Each[Reads[T]]
WritesEach = Each[Writes[T]]
ImagesEach = Each[Image]
CommandsEach = Each[Serves[T]]
SendsEach = Each[Calls[T]]
ServesEach = Each[Serves[Q, R]]
CallsEach = Each[Calls[Q, R]]
