import pytest

from fwk.web.words import options_of


def test_quotes_keep_a_setting_with_spaces_together() -> None:
    assert options_of("a/agent.speed_m_s=2 'a/agent.places=[1, 2]'") == [
        "--set",
        "a/agent.speed_m_s=2",
        "--set",
        "a/agent.places=[1, 2]",
    ]
    assert options_of("  ") == []


def test_a_quote_that_is_not_closed_is_refused() -> None:
    with pytest.raises(ValueError, match="quotation"):
        options_of("a.b='1")
