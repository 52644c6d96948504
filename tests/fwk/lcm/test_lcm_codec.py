"""The codec writes and reads the same bytes as lcm-gen's code, for every kind of member that LCM has."""

import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as some

from fwk.lcm import codec, messages
from fwk.lcm.messages import MessageError, to_dict
from fwk.lcm.typegen import generate

SHAPES = """
package shapes;
struct inner_t { int8_t a; boolean b; string s; double d[2]; }
struct plain_t { int8_t i8; int16_t i16; int32_t i32; int64_t i64; float f; double d; boolean b; byte y; string s; }
struct fixed_t {
  boolean b[3]; byte y[4]; string s[2]; int16_t i[2]; double d[3][2]; boolean bb[2][2]; inner_t inner[2];
}
struct varied_t {
  int32_t n; int32_t m; boolean b[n]; byte y[n]; string s[n]; float f[m]; double d[m]; int8_t i[n]; inner_t inner[m];
  inner_t one; int64_t last;
}
struct lists_t {
  int32_t a; int32_t i[a]; int32_t b; byte y[b]; int32_t c; boolean t[c]; double d[c]; int32_t e; string s[e];
  int32_t f; inner_t inner[f]; int64_t last; int32_t g; int8_t k[g]; int32_t h; inner_t m[h];
  int32_t o; int32_t p[o]; int32_t q; int32_t u[q]; int32_t w[o]; int32_t x; int8_t z[x];
}
struct deep_t { int32_t n; varied_t varied[n]; fixed_t fixed; string end; }
struct rare_t { int32_t n; int32_t m; double d[n][m]; }
struct tree_t { int32_t n; tree_t kids[n]; }
struct empty_t { }
"""
NAMES = ("plain_t", "fixed_t", "varied_t", "lists_t", "deep_t", "empty_t", "rare_t", "tree_t")
Draw = Callable[[some.SearchStrategy[Any]], Any]
RANGES = {"int8_t": 8, "int16_t": 16, "int32_t": 32, "int64_t": 64}


@pytest.fixture(scope="module", autouse=True)
def shapes(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    folder = tmp_path_factory.mktemp("shapes") / "lcmtypes"
    folder.mkdir()
    (folder / "shapes.lcm").write_text(SHAPES)
    generate(folder)
    sys.path.insert(0, str(folder.parent))
    yield
    sys.path.remove(str(folder.parent))


def shape(name: str) -> Any:
    """Returns a type of `SHAPES`."""
    return messages.type_named(f"shapes.{name}")


def filled(draw: Draw, message_type: Any, depth: int = 0) -> Any:
    """Draws a message with any values."""
    made = message_type()
    counts: dict[str, int] = {}
    for name, kind, dimensions in zip(
        made.__slots__, message_type.__typenames__, message_type.__dimensions__, strict=True
    ):
        if not dimensions:
            if name not in ("n", "m"):
                setattr(made, name, value(draw, kind, depth))
            continue
        sizes = [
            size if isinstance(size, int) else counts.setdefault(size, draw(some.integers(0, 3 if depth < 2 else 0)))
            for size in dimensions
        ]
        setattr(made, name, array(draw, kind, sizes, depth))
    for name, count in counts.items():
        setattr(made, name, count)
    return made


def array(draw: Draw, kind: str, sizes: list[int], depth: int) -> Any:
    first, *others = sizes
    if not others and kind == "byte":
        return draw(some.binary(min_size=first, max_size=first))
    return [array(draw, kind, others, depth) if others else value(draw, kind, depth) for _ in range(first)]


def value(draw: Draw, kind: str, depth: int) -> Any:
    if kind in RANGES:
        bits = RANGES[kind]
        return draw(some.integers(-(2 ** (bits - 1)), 2 ** (bits - 1) - 1))
    if kind in ("float", "double"):
        return draw(some.floats(width=32))
    if kind == "boolean":
        return draw(some.booleans())
    if kind == "byte":
        return draw(some.integers(0, 255))
    if kind == "string":
        return draw(some.text("aé{%", max_size=5))
    package, _, name = kind.rpartition(".")
    return filled(draw, getattr(import_module(package), name), depth + 1)


def shown(message: Any) -> str:
    """Returns all values of a message; NaN equals NaN."""
    return repr(to_dict(message))


@given(some.data())
@pytest.mark.parametrize("name", NAMES)
def test_the_bytes_are_those_of_lcm_gen(name: str, data: some.DataObject) -> None:
    message_type = shape(name)
    message = filled(data.draw, message_type)
    expected = message.encode()
    assert messages.encode(message, "channel") == expected
    assert shown(messages.decode(message_type, expected, "channel")) == shown(message_type.decode(expected))


@given(some.data())
@pytest.mark.parametrize("name", NAMES[:5])
def test_bytes_that_end_too_early_are_refused(name: str, data: some.DataObject) -> None:
    message_type = shape(name)
    message = filled(data.draw, message_type)
    encoded = message.encode()
    cut = data.draw(some.integers(0, len(encoded) - 1))
    with pytest.raises(MessageError):
        messages.decode(message_type, encoded[:cut], "channel")


@given(some.binary(max_size=200))
@pytest.mark.parametrize("name", NAMES[:5])
def test_any_bytes_give_a_message_or_a_clear_error(name: str, rest: bytes) -> None:
    message_type = shape(name)
    with suppress(MessageError):
        messages.decode(message_type, messages.fingerprint(message_type) + rest, "channel")


def test_usual_shapes_use_this_codec_and_rare_ones_lcm_gen() -> None:
    for name in NAMES:
        rare = name in ("rare_t", "tree_t")
        message_type = shape(name)
        assert (codec.encoder(message_type) is None) == rare
        assert (codec.decoder(message_type) is None) == rare


def test_counts_are_set_to_the_lengths_of_lists() -> None:
    message = shape("varied_t")()
    message.b, message.y, message.s, message.i = [True], b"x", ["s"], [1]
    assert messages.decode(type(message), messages.encode(message, "channel"), "channel").n == 1
    message.s = ["s", "t"]
    with pytest.raises(MessageError, match="the lists counted by 'n' differ in length"):
        messages.encode(message, "channel")


def test_lists_that_are_empty_together_are_those_of_lcm_gen() -> None:
    message_type = shape("lists_t")
    message = message_type()
    message.a, message.i, message.e, message.h = 2, [1, 2], 5, 7
    decoded = messages.decode(message_type, messages.encode(message, "channel"), "channel")
    assert (message.e, message.h) == (0, 0)
    for name in ("i", "y", "t", "d", "s", "inner", "k", "m"):
        own, expected = getattr(decoded, name), getattr(message_type.decode(message.encode()), name)
        assert (type(own), own) == (type(expected), expected)


def test_arrays_of_a_fixed_size_have_that_size() -> None:
    message = shape("fixed_t")()
    message.y = b"12345"
    with pytest.raises(MessageError, match="y"):
        messages.encode(message, "channel")


def test_the_projects_types_are_all_of_usual_shapes() -> None:
    root = Path(messages.__file__).parents[2]
    names = [f"{file.parent.name}.{file.stem}" for file in sorted(root.glob("lcmtypes/*/*_t.py"))]
    assert len(names) > 40
    for name in names:
        message_type = messages.type_named(name)
        assert None not in (codec.encoder(message_type), codec.decoder(message_type)), name
        assert messages.encode(message_type(), "channel") == message_type().encode()
