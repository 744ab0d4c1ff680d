"""What Coq said of the printed equations: now, and when it was last asked."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cache
from typing import Any

from ..framework.catalogue import Number
from .files import PROOFS

RECORD = "certificate.json"


@dataclass(frozen=True)
class Certificate:
    """Coq's verdict on one equation.

    Attributes:
        number: of the equation.
        accepted: whether Coq proved all statements about it.
        checker: "Coq 8.16.1".
        theorems: SHA-256 of the statement of each theorem, by name.
        axioms: on which the theorems rest.
        note: why it is not accepted.
        about: ranges of the indices and sites for which it is stated, in the words of Model.v.
    """

    number: Number
    accepted: bool
    checker: str
    theorems: Mapping[str, str]
    axioms: tuple[str, ...] = ()
    note: str = ""
    about: tuple[str, ...] = ()

    def __str__(self) -> str:
        return f"{'accepted' if self.accepted else 'not accepted'} by {self.checker}"


@dataclass(frozen=True)
class Certification:
    """Coq's verdicts on several equations.

    Attributes:
        equations: the printed equations.
        theory: SHA-256 of the theory that the proofs rest on.
    """

    equations: tuple[Certificate, ...]
    theory: str

    @property
    def passed(self) -> bool:
        """Whether all is accepted."""
        return all(equation.accepted for equation in self.equations)

    def data(self) -> dict[str, Any]:
        """The verdicts as data for JSON."""
        return asdict(self)


@cache
def record() -> dict[str, Any]:
    """What ``certify`` found when Coq was last asked, as ``Certification.data`` gives it."""
    certificates: dict[str, Any] = json.loads((PROOFS / RECORD).read_text(encoding="utf-8"))
    return certificates
