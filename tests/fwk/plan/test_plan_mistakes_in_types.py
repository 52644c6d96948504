"""Mistakes in a user's message types: a row each."""

from pathlib import Path

import pytest

import lcmtypes.robot
from tests.fwk.plan.plan_mistakes import Broken, expected, rows, said

INSTALLED = Path(lcmtypes.robot.__file__).parent.parent
RUN = "components: {a/one: {use: plan_parts:Odometer}}\n"


def of_type(message: str, source: str) -> Broken:
    """Returns a row for the file lcmtypes/mine.lcm with this text after its package."""
    return Broken(message, f"{RUN}--- lcmtypes/mine.lcm\npackage mine;\n{source}")


@rows(
    Broken(
        "lcmtypes/mine.lcm:1: the package 'robot' is used by {installed}; give these types another package",
        f"{RUN}--- lcmtypes/mine.lcm\npackage robot;\nstruct mine_t {{ core.header_t header; }}",
    ),
    Broken(
        "lcmtypes/mine.lcm:1: no 'package NAME;' line; every .lcm file names its package",
        f"{RUN}--- lcmtypes/mine.lcm\nstruct mine_t {{ core.header_t header; }}",
    ),
    Broken(
        "lcmtypes/__init__.py: this file hides all other message types; remove it, because 'lcmtypes' is a package of "
        "several folders",
        f"{RUN}--- lcmtypes/mine.lcm\npackage mine;\nstruct mine_t {{ double x_m; }}\n--- lcmtypes/__init__.py\n",
    ),
    of_type("lcmtypes/mine.lcm:2: the name of the member is missing after 'what'", "struct mine_t { what }"),
    of_type(
        "lcmtypes/mine.lcm:3: ';' is missing after 'x_m'",
        "struct mine_t {\n  double x_m\n\n\n  double y_m;\n}",
    ),
    of_type("lcmtypes/mine.lcm:2: '}' of struct mine_t is missing", "struct mine_t {\n  double x_m;\n"),
    of_type(
        "lcmtypes/mine.lcm:4: 'strct' is not expected here; a struct begins with 'struct NAME {'",
        "// one\n\nstrct mine_t { double x_m; }",
    ),
    of_type(
        "lcmtypes/mine.lcm:2: enum is not supported; write constants into a struct: const int8_t RED = 1;",
        "enum mine_t { RED }",
    ),
    of_type(
        "lcmtypes/mine.lcm:2: 'lambda' is a keyword of Python; choose another name", "struct mine_t { double lambda; }"
    ),
    of_type(
        "lcmtypes/mine.lcm:2: 'encode' is a name of every generated class; choose another name\n"
        "lcmtypes/mine.lcm:3: '__slots__' is a name of every generated class; choose another name",
        "struct mine_t { double encode;\n const int8_t __slots__ = 1; }",
    ),
    of_type(
        "lcmtypes/mine.lcm:3: there is no type 'core.heade_t'; did you mean 'core.header_t'?",
        "struct mine_t {\n  core.heade_t header;\n}",
    ),
    of_type(
        "lcmtypes/mine.lcm:3: there is no type 'doubl'; did you mean 'double'?\n"
        "lcmtypes/mine.lcm:4: there is no type 'nowhere.to_t'",
        "struct mine_t {\n  doubl x_m;\n  nowhere.to_t way;\n}",
    ),
    of_type(
        "lcmtypes/more.lcm:2: struct mine.mine_t is defined already, in mine.lcm:2; keep one",
        "struct mine_t { double x_m; }\n--- lcmtypes/more.lcm\npackage mine;\nstruct mine_t { double y_m; }",
    ),
    of_type(
        "lcmtypes/mine.lcm:4: mine_t has a 'x_m' already, in line 3", "struct mine_t {\n double x_m;\n double x_m;\n}"
    ),
    of_type(
        "lcmtypes/mine.lcm:2: mine_t contains itself: mine.mine_t -> mine.mine_t; only an array of variable length may "
        "do that",
        "struct mine_t { mine_t inner; }",
    ),
    of_type(
        "lcmtypes/mine.lcm:2: a_t contains itself: mine.a_t -> mine.b_t -> mine.a_t; only an array of variable length "
        "may do that\n"
        "lcmtypes/mine.lcm:3: b_t contains itself: mine.b_t -> mine.a_t -> mine.b_t; only an array of variable length "
        "may do that",
        "struct a_t { b_t inner[2]; }\nstruct b_t { a_t inner; }\nstruct c_t { a_t fine; }",
    ),
    of_type(
        "lcmtypes/mine.lcm:3: 'x' makes mine_t 7,999,999,992 bytes long; a message type has at most 16,777,216",
        "struct mine_t {\n  double x[999999999];\n}",
    ),
    of_type(
        "lcmtypes/mine.lcm:3: the size of 'x' is 'n'; it should be a number, an integer constant, or an integer member "
        "in a line above",
        "struct mine_t {\n  double x[n];\n  int32_t n;\n}",
    ),
    of_type(
        "lcmtypes/mine.lcm:2: 'x' has room for nothing; the size of an array is at least 1",
        "struct mine_t { double x[0]; }",
    ),
)
def test_mistakes_in_user_types(folder: Path, broken: Broken) -> None:
    assert said(broken, folder) == [line.replace("{installed}", str(INSTALLED)) for line in expected(broken)]


def test_types_with_equal_members_are_told_apart(folder: Path) -> None:
    struct = "struct NAME_t { core.header_t header; double x_m; }\n"
    twin = Broken(
        "it.yaml:3: a/two: 'a/place' is written by a/one as twins.here_t and read by a/two as twins.there_t; "
        "use one type",
        "components:\n  a/one: {use: twin:One}\n  a/two: {use: twin:Two}\n--- lcmtypes/twins.lcm\npackage twins;\n"
        + struct.replace("NAME", "here")
        + struct.replace("NAME", "there")
        + "--- twin.py\nfrom fwk import Component, Reads, Writes\nfrom lcmtypes.twins import here_t, there_t\n"
        + 'class One(Component):\n    stage = "act"\n    place: Writes[here_t]\n'
        + 'class Two(Component):\n    stage = "act"\n    place: Reads[there_t]\n',
    )
    assert said(twin, folder) == expected(twin)


def test_a_latin_1_comment_is_named_with_its_line(folder: Path) -> None:
    (folder / "lcmtypes").mkdir()
    (folder / "lcmtypes" / "mine.lcm").write_bytes("package mine;\n// Größe\n".encode("latin-1"))
    found = said(Broken("", RUN), folder)
    assert found == ["lcmtypes/mine.lcm:2: byte 0xf6 is not UTF-8; save the file as UTF-8"]


@pytest.mark.parametrize(
    "source",
    [
        "struct node_t { int32_t n; node_t children[n]; }",
        "struct a_t { double x_m, y_m, z_m[3]; const int8_t N = 2, M = 0x10; int16_t grid[N][M]; byte raw[N]; }",
        "struct /* one */ a_t // two\n{ };\nstruct b_t { a_t inner; core.frame_t frame; float f[1]; string s; }",
    ],
)
def test_valid_types_are_accepted(folder: Path, source: str) -> None:
    write = Broken(
        "", f"{RUN}--- lcmtypes/mine.lcm\npackage mine;\n{source}\n--- it.yaml\ncomponents: {{a/b: {{use: no}}}}"
    )
    assert said(write, folder)[0].startswith("it.yaml:1: a/b: no module 'no'")
