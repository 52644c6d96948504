"""Registry of all generated types, which finds the type of encoded messages by their fingerprint."""

import importlib
import pkgutil
import sys
from collections.abc import Sequence
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

import lcmtypes
from fwk.lcm import envelope, messages, typegen

MessageType = type[messages.Message]


def put_first(folders: Sequence[str]) -> None:
    """Puts folders in front of the module search path, in this order."""
    sys.path[:] = [*folders, *(entry for entry in sys.path if entry not in folders)]
    importlib.invalidate_caches()


def use_types_of(folder: Path) -> None:
    """Adds the types of `folder`/lcmtypes/*.lcm, if there are any, and generates their classes where needed.

    Raises:
        TypeGenerationError: an .lcm file has mistakes.
    """
    if any((folder / "lcmtypes").glob("*.lcm")):
        typegen.generate((folder / "lcmtypes").resolve())
        put_first([str(folder.resolve())])
        by_fingerprint.cache_clear()
        _interfaces.cache_clear()
        _in_envelopes.cache_clear()


def source_folders() -> list[Path]:
    """Returns the folders of all .lcm files in use, each once."""
    return list(dict.fromkeys(Path(folder).resolve() for folder in lcmtypes.__path__))


@cache
def by_fingerprint() -> dict[bytes, tuple[MessageType, ...]]:
    """Returns all generated types by fingerprint; several types with the same members have the same."""
    found: dict[bytes, tuple[MessageType, ...]] = {}
    for package in sorted(module.name for module in pkgutil.iter_modules(lcmtypes.__path__) if module.ispkg):
        for _, made in sorted(vars(import_module(f"lcmtypes.{package}")).items()):
            if isinstance(made, type) and hasattr(made, "_get_packed_fingerprint"):
                mark = messages.fingerprint(made)
                found[mark] = (*found.get(mark, ()), made)
    return found


def types_of(data: bytes) -> tuple[MessageType, ...]:
    """Returns the types that a message, perhaps in its envelope, may have; empty if none is known."""
    return by_fingerprint().get(data[:8]) or _in_envelopes().get(data[:8], ())


def decoded(data: bytes) -> Any:
    """Returns a decoded message, without its envelope. Raises exceptions of generated code, or `LookupError`."""
    return types_of(data)[0].decode(envelope.content(data) if in_envelope(data) else data)


def in_envelope(data: bytes) -> bool:
    """Returns whether the bytes are a message of a known type without the header, in its envelope."""
    return data[:8] in _in_envelopes()


def is_interface(data: bytes) -> bool:
    """Returns whether a message has a header, its own or that of an envelope."""
    return data[:8] in _interfaces()


@cache
def _interfaces() -> frozenset[bytes]:
    return frozenset(mark for mark, found in by_fingerprint().items() if messages.has_header(found[0])) | set(
        _in_envelopes()
    )


@cache
def _in_envelopes() -> dict[bytes, tuple[MessageType, ...]]:
    return {
        envelope.marked(mark): found for mark, found in by_fingerprint().items() if not messages.has_header(found[0])
    }


def header_of(data: bytes) -> messages.Header | None:
    """Returns the header of a message; None if it has none."""
    if not is_interface(data):
        return None
    try:
        return messages.Header.of(data)
    except messages.MessageError:
        return None
