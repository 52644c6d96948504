"""The message reference: one page with every type of a folder of .lcm files."""

import re
from importlib import import_module
from pathlib import Path

from tools.docs.lcm_source import Member, Struct, read_structs

_HEAD = """\
# Messages

Generated from `lcmtypes/*.lcm`. A program in any language reads and writes these types with the code that `lcm-gen`
makes from those files. Units stand at the end of a name: `x_m`, `time_us`, `omega_rad_s`. The fingerprint is the hash
that begins each encoded message.
"""


def message_reference(folder: Path) -> str:
    """Returns the page in Markdown for all .lcm files in `folder`.

    Raises:
        LcmSourceError: a file has a line that is not LCM.
    """
    structs = [struct for path in sorted(folder.glob("*.lcm")) for struct in read_structs(path)]
    names = {struct.full_name for struct in structs}
    lines = [_HEAD]
    package = ""
    for struct in structs:
        if struct.package != package:
            package = struct.package
            lines += [f"## {package} {{#{package}}}", ""]
        lines += _section(struct, names)
    return "\n".join(lines)


def _section(struct: Struct, names: set[str]) -> list[str]:
    lines = [f"### {struct.full_name} {{#{struct.full_name}}}", ""]
    if struct.comment:
        lines += [_text(struct.comment), ""]
    lines += [f"Fingerprint `{_fingerprint(struct):016x}`.", ""]
    if struct.members:
        lines += ["| member | type | meaning |", "| --- | --- | --- |"]
        lines += [
            f"| `{each.name}` | {_type(struct, each, names)} | {_text(each.comment)} |" for each in struct.members
        ]
        lines += [""]
    if struct.constants:
        lines += ["| constant | type | value | meaning |", "| --- | --- | --- | --- |"]
        lines += [
            f"| `{each.name}` | `{each.type}` | {each.value} | {_text(each.comment)} |" for each in struct.constants
        ]
        lines += [""]
    return lines


def _fingerprint(struct: Struct) -> int:
    generated = getattr(import_module(f"lcmtypes.{struct.package}"), struct.name)
    return int.from_bytes(generated._get_packed_fingerprint(), "big")


def _type(struct: Struct, member: Member, names: set[str]) -> str:
    full = member.type if "." in member.type else f"{struct.package}.{member.type}"
    dimensions = f"`{member.dimensions}`" if member.dimensions else ""
    return (f"[{member.type}](#{full})" if full in names else f"`{member.type}`") + dimensions


def _text(comment: str) -> str:
    """Returns the comment with characters escaped that Markdown would read as markup."""
    return re.sub(r"([|*_<>\[\]])", r"\\\1", comment)
