"""Stored results of pieces: which are whole, and their samples."""

import json
import math

import pytest

from procs.evaluation.results import flaw_in, samples_in
from procs.evaluation.table import MEASURES

FALSE = "balls that do not exist, a frame"
NUMBERS, PAIRS = "'ball known' should be a list of numbers", "'pose jumps' should be a list of pairs of numbers"


@pytest.mark.parametrize(
    ("text", "flaw"),
    [
        ("[1]", "it holds no measure of a match"),
        ("7", "it holds no measure of a match"),
        ('"ball known"', "it holds no measure of a match"),
        ('{"a": 1}', "it holds no measure of a match"),
        ('{"ball known": ["1"]}', NUMBERS),
        ('{"ball known": [null, "1"]}', NUMBERS),
        ('{"ball known": 3}', NUMBERS),
        ('{"ball known": null}', NUMBERS),
        ('{"ball known": {"1": 1}}', NUMBERS),
        ('{"ball known": [{}]}', NUMBERS),
        ('{"ball known": [[1.0, 2.0]]}', NUMBERS),
        ('{"ball known": [[1.0], [1.0, 2.0]]}', NUMBERS),
        (f'{{"ball known": [{"9" * 400}]}}', NUMBERS),
        ('{"pose jumps": [1.0, 2.0]}', PAIRS),
        ('{"pose jumps": [[1.0]]}', PAIRS),
        ('{"pose jumps": [[[1.0, 2.0]]]}', PAIRS),
        ('{"won by cyan": [2.0]}', "'won by cyan' should be a list of ones and zeros"),
        ('{"ball known": [1.0, 2.0, null]}', "'ball known' should be a list of ones and zeros"),
        ('{"balls that do not exist, a frame": [-1e999]}', f"'{FALSE}' should be a list of ones and zeros"),
        ('{"won by cyan": [1e999]}', "'won by cyan' should be a list of ones and zeros"),
        ('{"pose, position": [-4.0]}', "'pose, position' has a value below zero"),
        ('{"shots": [[-1, 2.0]]}', "'shots' has a value below zero"),
    ],
)
def test_damaged_result_is_named(text: str, flaw: str) -> None:
    assert flaw_in(json.loads(text)) == flaw


def test_whole_result_has_no_flaw() -> None:
    assert flaw_in({each.name: [] for each in MEASURES}) == ""
    assert flaw_in({"ball known": [True, 0, 1.0], "kidnapped, time until found": [math.inf], "shots": [[1, 0.5]]}) == ""


def test_null_is_a_sample_without_a_value() -> None:
    samples = samples_in({"ball known": [None, 1.0], "opponents, lag": [[None, 2.0]]})
    assert math.isnan(samples["ball known"][0])
    assert samples["opponents, lag"].shape == (1, 2)
    assert samples["shots"].shape == (0, 2)
