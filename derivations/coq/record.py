"""What Coq said of the printed equations: now, and when it was last asked."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from enum import StrEnum
from functools import cache
from typing import Any

from ..framework.catalogue import Number
from ..framework.record import Derivation
from .files import PROOFS, theory_hash
from .statements import statements
from .words import NotStatedError

RECORD = "certificate.json"


class Verdict(StrEnum):
    """What Coq says of an equation."""

    ACCEPTED = "accepted"
    NOT_ACCEPTED = "not accepted"
    NOT_STATED = "not stated"
    ABSENT = "Coq absent"


@dataclass(frozen=True)
class Change:
    """A printed equation with one mechanical change (``symbolic.search.mutants``), accepted by Coq.

    Attributes:
        part: which of the printed equations, from 0.
        change: in words.
        equivalent: whether ``derive`` proves it too.
    """

    part: int
    change: str
    equivalent: bool


@dataclass(frozen=True)
class Changes:
    """What came of the mechanical changes of an equation.

    Attributes:
        made: how many there are.
        stated: of how many of them Coq was asked; of the others ``Model.v`` can't speak.
        refuted: of how many of these Coq proved the contrary, in a packing of given numbers.
        accepted: those that it accepts.
    """

    made: int
    stated: int
    refuted: int
    accepted: tuple[Change, ...]


@dataclass(frozen=True)
class Certificate:
    """What came of one equation, or of one exact packing.

    Attributes:
        number: of the equation; of a packing, the seed with which it is drawn.
        verdict: Coq's.
        checker: "Coq 8.16.1"; empty where there is none.
        theorems: SHA-256 of the statement of each theorem, by name.
        axioms: what the theorems rest on.
        note: why it is not accepted.
        changes: what came of its mechanical changes, where Coq was asked.
        about: ranges of the indices and sites for which it is stated, in the words of Model.v.
    """

    number: Number
    verdict: Verdict
    checker: str = ""
    theorems: Mapping[str, str] | None = None
    axioms: tuple[str, ...] = ()
    note: str = ""
    changes: Changes | None = None
    about: tuple[str, ...] = ()

    @property
    def wrong(self) -> tuple[Change, ...]:
        """Changes that make it another equation, and that Coq accepts nevertheless."""
        accepted = self.changes.accepted if self.changes else ()
        return tuple(change for change in accepted if not change.equivalent)

    @property
    def passed(self) -> bool:
        """Whether it is accepted, and no change of it that makes it another equation."""
        return self.verdict is Verdict.ACCEPTED and not self.wrong

    def __str__(self) -> str:
        if self.verdict in (Verdict.NOT_STATED, Verdict.ABSENT):
            return str(self.verdict)
        return f"{self.verdict} by {self.checker}"


@dataclass(frozen=True)
class Certification:
    """All that Coq was asked.

    Attributes:
        equations: the printed equations.
        packings: exact packings, whose Taylor coefficients ``numeric`` computes as fractions; the
            theory must have the same. Asked about together with all equations.
        theory: SHA-256 of the theory that the proofs rest on.
    """

    equations: tuple[Certificate, ...]
    packings: tuple[Certificate, ...]
    theory: str

    @property
    def passed(self) -> bool:
        """Whether all is accepted."""
        return all(one.passed for one in (*self.equations, *self.packings))

    def data(self) -> dict[str, Any]:
        """What JSON can hold."""
        return asdict(self)


@dataclass(frozen=True)
class Recorded:
    """What Coq said of an equation when it was last asked, and whether that still holds.

    Attributes:
        verdict: "accepted"; "stale", if the statement or the theory has changed since; "not
            on record"; or "not stated", where there are no words for it.
        checker: "Coq 8.16.1", if it was accepted.
        theorems: SHA-256 of the statements as they are now, by name.
        theory: SHA-256 of the theory as it is now.
    """

    verdict: str
    checker: str
    theorems: Mapping[str, str]
    theory: str

    def __str__(self) -> str:
        if not self.checker:
            return self.verdict
        since = "" if self.verdict == Verdict.ACCEPTED else ", and has changed since"
        return f"{Verdict.ACCEPTED} by {self.checker}{since}"


@cache
def _record() -> dict[str, Any]:
    try:
        text = (PROOFS / RECORD).read_text(encoding="utf-8")
    except FileNotFoundError:
        return {"theory": "", "equations": []}
    found: dict[str, Any] = json.loads(text)
    return found


_theory_now = cache(theory_hash)


def recorded(derivation: Derivation) -> Recorded:
    """Compare what Coq accepted with what is printed now."""
    try:
        now = {one.name: one.hash for one in statements(derivation)}
    except NotStatedError:
        now = {}
    record, verdict, checker = _record(), "not on record" if now else str(Verdict.NOT_STATED), ""
    for one in record["equations"]:
        if one["number"] == derivation.number and one["verdict"] == Verdict.ACCEPTED:
            same = one["theorems"] == now and record["theory"] == _theory_now()
            verdict, checker = str(Verdict.ACCEPTED) if same else "stale", one["checker"]
    return Recorded(verdict, checker, now, _theory_now())
