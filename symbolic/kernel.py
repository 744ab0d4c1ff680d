"""Verdicts: what a check may say."""

from dataclasses import dataclass
from enum import StrEnum


class Verdict(StrEnum):
    """What a decision procedure found; a witness agrees or disagrees, it never proves."""

    PROVED = "proved"
    REFUTED = "refuted"
    UNDECIDED = "undecided"
    AGREES = "agrees"
    DISAGREES = "disagrees"


@dataclass(frozen=True)
class Ruling:
    """A verdict and, in plain words, what it rests on (or the counterexample)."""

    verdict: Verdict
    note: str = ""
