"""The glossary defines each word once, in one sentence, and defines no word that it bans."""

import re

from tests.docs.docs_pages import ROOT

PAGE, _, BANNED = (ROOT / "docs" / "glossary.md").read_text().partition("## Words that are not used")
ROWS = [row for row in re.findall(r"^\| ([^|]+) \| (.+) \|$", PAGE, re.M) if row[0] not in ("word", "---")]


def test_every_word_is_defined_once() -> None:
    words = [word for word, _ in ROWS]
    assert len(words) > 40
    assert sorted(set(words)) == sorted(words)


def test_every_meaning_is_one_sentence() -> None:
    assert not [word for word, meaning in ROWS if not meaning.endswith(".") or re.search(r"\.\s+[A-Z]", meaning)]


def test_banned_words_are_not_defined() -> None:
    banned = {word.strip() for row in re.findall(r"^\| ([^|]+) \|", BANNED, re.M) for word in row.split(",")}
    assert "wish" in banned
    assert not banned & {word for word, _ in ROWS} - {"---"}
