"""Any launch file gives a plan, or mistakes with their places, within a short time."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as some

from fwk.model.errors import PlanError
from fwk.plan.load import LaunchOptions, load_plan

GARBLED = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])


def aliases(levels: int) -> str:
    """A few words that expand to many values."""
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{level}: &a{level} [{', '.join([f'*a{level - 1}'] * 9)}]" for level in range(1, levels)]
    return "\n".join(lines)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (b"a: " + b"[" * 1200, "too deep"),
        (b"a: " + b"[" * 1200 + b"]" * 3000, "too deep"),
        ("\n".join(" " * depth + "a:" for depth in range(1200)).encode(), "too deep"),
        (aliases(9).encode(), "values when its aliases are written out"),
        (bytes(range(256)), "not UTF-8 text"),
        ("name: x".encode("utf-16"), "not UTF-8 text"),
        (b"name: a\0b", "is not allowed"),
        (b"name: x\n---\nname: y", "not valid YAML"),
        (b"seed: " + b"9" * 6000, "is not a valid int"),
        (b'name: "\\ud800"', "name"),
        (b"period_s: 1e400", "period_s"),
        (b"include: [.]", "there is no '.' to include"),
        (b"include: [" + b"x" * 5000 + b"]", "to include"),
    ],
    ids=lambda value: repr(value)[:30] if isinstance(value, bytes) else value,
)
def test_a_hostile_launch_file_is_refused_with_its_place(tmp_path: Path, text: bytes, says: str) -> None:
    file = tmp_path / "hostile.yaml"
    file.write_bytes(text)
    with pytest.raises(PlanError) as caught:
        load_plan(str(file), LaunchOptions())
    assert says in str(caught.value)
    assert "hostile.yaml" in str(caught.value)


@GARBLED
@given(some.text(alphabet="abc:{}[]&*!|>-?#%@`'\"\\,\n \t0.e~=", max_size=60))
def test_any_text_is_a_plan_or_a_list_of_mistakes(tmp_path: Path, text: str) -> None:
    file = tmp_path / "any.yaml"
    file.write_text(text)
    with pytest.raises(PlanError):
        load_plan(str(file), LaunchOptions())
