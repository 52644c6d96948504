"""Candidates for fields of messages: `CHANNEL.FIELD` to plot, `FIELD=` to send."""

import re
from collections.abc import Iterable, Mapping

_INDEX = re.compile(r"\.\d+(\..*)?$")


def fields_to_plot(types: Mapping[str, str], begun: str) -> Iterable[str]:
    """Returns `CHANNEL.` for each channel, or `CHANNEL.FIELD` if only one channel begins like the word."""
    from fwk.lcm.messages import type_named
    from fwk.log_tools.columns import columns_of

    namespace, slash, last = begun.rpartition("/")
    name, dot, _ = last.partition(".")
    channel = namespace + slash + name
    found = [each for each in types if (each == channel if dot else each.startswith(channel))]
    if len(found) != 1:
        return [f"{each}." for each in found]
    columns = columns_of(type_named(types[found[0]]))
    return [f"{found[0]}.{each.name}" for each in columns if not each.dimensions and each.kind != "string"]


def fields_of(type_name: str) -> list[str]:
    """Returns the fields of a type without its header, and those of structs in it, with dots."""
    from fwk.lcm.messages import type_named
    from fwk.log_tools.columns import columns_of

    names = (_INDEX.sub("", each.name) for each in columns_of(type_named(type_name)))
    return [*dict.fromkeys(name for name in names if name.partition(".")[0] != "header")]
