"""The generated reference pages name every message type and every public name."""

import re
from importlib import import_module
from pathlib import Path

import pytest

import fwk
import fwk.testing
from tests.docs.docs_pages import ROOT
from tools.docs.api_reference import SUBJECTS, api_pages
from tools.docs.lcm_source import LcmSourceError, Struct, read_structs
from tools.docs.message_reference import message_reference

STRUCTS = [struct for path in sorted((ROOT / "lcmtypes").glob("*.lcm")) for struct in read_structs(path)]


@pytest.mark.parametrize("struct", STRUCTS, ids=lambda struct: struct.full_name)
def test_a_struct_has_the_members_that_lcm_gen_sees(struct: Struct) -> None:
    generated = getattr(import_module(f"lcmtypes.{struct.package}"), struct.name)
    assert [member.name for member in struct.members] == list(generated.__slots__)
    own = f"{struct.package}."
    types = [each.removeprefix("lcmtypes.").removeprefix(own) for each in generated.__typenames__]
    assert [member.type.removeprefix(own) for member in struct.members] == types
    assert all(hasattr(generated, constant.name) for constant in struct.constants)


def test_comments_document_the_member_beside_and_below(tmp_path: Path) -> None:
    source = tmp_path / "garden.lcm"
    source.write_text(
        "package garden;\n// Water in the soil.\nstruct soil_t {\n  double wet;  // 0 to\n               // 1\n"
        "  // below\n  int32_t n;\n  const int8_t DRY = 3; // thirsty\n  byte raw[n][2];\n}\n"
    )
    (soil,) = read_structs(source)
    assert soil.comment == "Water in the soil."
    assert [(each.name, each.comment) for each in soil.members] == [("wet", "0 to 1 below"), ("n", ""), ("raw", "")]
    assert [(each.name, each.value, each.comment) for each in soil.constants] == [("DRY", "3", "thirsty")]
    assert soil.members[2].dimensions == "[n][2]"


def test_a_line_that_is_not_lcm_is_named(tmp_path: Path) -> None:
    source = tmp_path / "garden.lcm"
    source.write_text("package garden;\nstruct soil_t {\n  double;\n}\n")
    with pytest.raises(LcmSourceError, match=r"garden\.lcm:3: cannot read 'double;'"):
        read_structs(source)


def test_the_message_reference_has_every_type() -> None:
    page = message_reference(ROOT / "lcmtypes")
    for struct in STRUCTS:
        assert f"### {struct.full_name} " in page
    linked = set(re.findall(r"\]\(#([\w.]+)\)", page))
    assert linked <= {struct.full_name for struct in STRUCTS}
    assert "core.header_t" in linked


def test_the_api_reference_has_every_public_name() -> None:
    text = "\n".join(api_pages().values())
    for name in fwk.__all__:
        assert text.count(f"\n## {name}\n") == 1
    for name in fwk.testing.__all__:
        assert f"::: fwk.testing.{name}\n" in text


def test_subjects_name_only_what_is_public() -> None:
    named = [name for _, names in SUBJECTS.values() for name in names]
    assert set(named) <= set(fwk.__all__), "tools/docs/api_reference.py names what fwk does not export"
