"""Classes made from .lcm files: the output of lcm-gen, completed, and kept up to date with the files."""

import subprocess
import sys
from pathlib import Path

import pytest

from fwk.lcm.lcm_file import read_lcm_file
from fwk.lcm.typegen import TypeGenerationError, generate
from lcmtypes.core import command_t, frame_t, header_t
from lcmtypes.robot import odometry_t

SOURCE = """package NAME;
struct point_t { double x_m; double y_m; }
struct track_t { point_t newest; int32_t n; point_t points[n]; string label; const int8_t LOST = 1; }
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = tmp_path / "lcmtypes"
    made.mkdir()
    return made


def write(folder: Path, name: str, text: str = SOURCE) -> Path:
    source = folder / f"{name}.lcm"
    source.write_text(text.replace("NAME", name))
    return source


def files(folder: Path) -> list[str]:
    return sorted(str(file.relative_to(folder)) for file in folder.rglob("*.py*"))


def run(folder: Path, program: str) -> str:
    """Returns the output of a program that has the types of the folder."""
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, cwd=folder.parent, capture_output=True, text=True, check=False, timeout=60)
    return (done.stdout + done.stderr).strip()


def test_members_are_keyword_arguments() -> None:
    assert frame_t(frame=3, encoding="gray8").encode() == set_one_by_one().encode()
    assert frame_t(header=header_t(tick=7)).header.tick == 7
    assert frame_t().header.tick == 0


def set_one_by_one() -> frame_t:
    made = frame_t()
    made.frame = 3
    made.encoding = "gray8"
    return made


def test_an_unknown_member_is_named() -> None:
    with pytest.raises(TypeError, match="command_t has no member 'expires'; its members are expires_us"):
        command_t(expires=1)  # type: ignore[call-arg]


def test_a_message_shows_the_members_that_are_set() -> None:
    assert repr(odometry_t()) == "odometry_t()"
    message = odometry_t(header=header_t(tick=3, writer="a/b"), x_m=1.5)
    assert repr(message) == "odometry_t(header=header_t(tick=3, writer='a/b'), x_m=1.5)"
    assert eval(repr(message)).encode() == message.encode()


def test_nested_messages_show_their_members(folder: Path) -> None:
    write(folder, "tracking")
    generate(folder)
    program = "from lcmtypes.tracking import *\nprint(track_t(newest=point_t(x_m=1.0), points=[point_t(y_m=2.0)], n=1))"
    assert run(folder, program) == "track_t(newest=point_t(x_m=1.0), n=1, points=[point_t(y_m=2.0)])"


def test_classes_of_a_renamed_struct_are_removed(folder: Path) -> None:
    write(folder, "tracking")
    generate(folder)
    assert "tracking/point_t.py" in files(folder)
    write(folder, "tracking", SOURCE.replace("point_t", "place_t"))
    generate(folder)
    assert files(folder) == [
        "tracking/__init__.py",
        *(f"tracking/{name}" for name in ("place_t.py", "place_t.pyi", "track_t.py", "track_t.pyi")),
    ]


def test_classes_of_a_removed_file_are_removed(folder: Path) -> None:
    write(folder, "one")
    source = write(folder, "two")
    generate(folder)
    source.unlink()
    assert [package.name for package in generate(folder)] == ["one"]
    assert {file.partition("/")[0] for file in files(folder)} == {"one"}


def test_one_package_of_two_files_keeps_both(folder: Path) -> None:
    write(folder, "one", "package both; struct a_t { int8_t a; }")
    other = write(folder, "two", "package both; struct b_t { int8_t b; }")
    generate(folder)
    assert run(folder, "from lcmtypes.both import a_t, b_t\nprint(a_t(a=1), b_t())") == "a_t(a=1) b_t()"
    other.unlink()
    generate(folder)
    assert run(folder, "import lcmtypes.both as both\nprint([n for n in dir(both) if n.endswith('_t')])") == "['a_t']"


def test_own_modules_among_the_types_stay(folder: Path) -> None:
    source = write(folder, "tracking")
    generate(folder)
    (folder / "tracking" / "helpers.py").write_text('"""By hand."""\n')
    source.unlink()
    generate(folder)
    assert (folder / "tracking" / "helpers.py").exists()


def test_nothing_is_written_when_nothing_changed(folder: Path) -> None:
    write(folder, "tracking")
    generate(folder)
    before = {file: file.stat().st_mtime_ns for file in folder.rglob("*")}
    generate(folder)
    assert {file: file.stat().st_mtime_ns for file in folder.rglob("*")} == before


def test_an_init_file_of_the_user_is_kept_and_explained(folder: Path) -> None:
    write(folder, "tracking")
    (folder / "__init__.py").write_text("mine = 1\n")
    with pytest.raises(
        TypeGenerationError, match=r"lcmtypes/__init__\.py: this file hides all other message types; rem"
    ):
        generate(folder)
    assert (folder / "__init__.py").read_text() == "mine = 1\n"


def test_a_comment_in_latin_1_is_refused_with_its_line(folder: Path) -> None:
    (folder / "tracking.lcm").write_bytes("package tracking;\n// Größe\n".encode("latin-1"))
    with pytest.raises(TypeGenerationError, match=r"tracking\.lcm:2: byte 0xf6 is not UTF-8; save the file as UTF-8"):
        generate(folder)


QUIET = "import warnings; warnings.simplefilter('ignore'); "


def test_types_that_moved_to_core_keep_their_former_names(folder: Path) -> None:
    write(folder, "robot")
    generate(folder)
    program = f"{QUIET}from lcmtypes.robot import frame_t, transforms_t, point_t; from lcmtypes import core; "
    assert run(folder, f"{program}print(frame_t is core.frame_t, transforms_t is core.transforms_t)") == "True True"
    warned = run(folder, "from lcmtypes.robot import frame_t")
    told = "DeprecationWarning: 'lcmtypes.robot.frame_t' is now 'lcmtypes.core.frame_t'"
    assert [line for line in warned.splitlines() if line.endswith(told)]
    assert "cannot import name 'frame' from 'lcmtypes.robot'" in run(folder, "from lcmtypes.robot import frame")


def test_type_of_a_former_name_in_ones_own_package_counts(folder: Path) -> None:
    write(folder, "robot", "package NAME;\nstruct frame_t { int32_t mine; }\n")
    generate(folder)
    program = f"{QUIET}from lcmtypes.robot import frame_t, transforms_t; print(frame_t(mine=1), transforms_t.__name__)"
    assert run(folder, program) == "frame_t(mine=1) transforms_t"


def test_a_file_is_parsed_again_once_it_changes(tmp_path: Path) -> None:
    file = tmp_path / "walk.lcm"
    file.write_text("package walk;\nstruct step_t { int32_t x; }\n")
    first = read_lcm_file(file)
    assert read_lcm_file(file) is first
    file.write_text("package walk;\nstruct step_t { int32_t y; }\n")
    assert [member.name for member in read_lcm_file(file).structs[0].members] == ["y"]
