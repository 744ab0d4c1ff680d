"""A second, unrelated checker: does Coq accept the printed equations?

The statements are made from what the derivations print (``derivations.coq.statements``); the theory
that proves them is written by hand (``proofs/``). Neither SymPy nor the package's own kernel takes
part in the verdict.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from dataclasses import replace
from enum import StrEnum
from pathlib import Path
from tempfile import TemporaryDirectory

from force_diffusion.symbolic.search.mutants import mutants as made_mutants

from ..coq.files import (
    Statement,
    files_of,
    proof_of,
    theory,
    theory_hash,
    words_of,
)
from ..coq.folder import (
    ALLOWED,
    CoqAbsentError,
    CoqFolder,
    Notice,
    axioms_in,
)
from ..coq.packings import packing_statement
from ..coq.record import (
    Certificate,
    Certification,
    Change,
    Changes,
    Verdict,
)
from ..coq.statements import STATED, statement, statements
from ..coq.words import NotStatedError
from ..framework.catalogue import Number
from ..framework.loading import load
from ..framework.record import Derivation
from ..framework.runner import SEEDS
from .equation import equation

MUTANT_LIMIT = 30  # seconds for one changed statement
IN_ONE_FILE = 20  # changed statements


def _silent(_: str) -> None:
    """Tell nobody."""


Asked = list[Statement] | NotStatedError
"""The statements of an equation or packing, or why there are none."""


def asked_of(number: Number) -> Asked:
    """What ``certify`` asks about an equation, or about the packing of a seed."""
    try:
        return [packing_statement(number)] if number in SEEDS else statements(load(number))
    except NotStatedError as reason:
        return reason


def stated(numbers: Iterable[Number] | None = None) -> list[Statement]:
    """The statements that ``certify`` tries; of what can't be stated there is none."""
    found: list[Statement] = []
    for number in (*STATED, *SEEDS) if numbers is None else numbers:
        asked = asked_of(number)
        found += [] if isinstance(asked, NotStatedError) else asked
    return found


def certify(
    numbers: Iterable[Number] | None = None,
    *,
    mutants: bool = False,
    notice: Notice = _silent,
    told: Callable[[Certificate], None] = lambda _: None,
) -> Certification:
    """Ask Coq about equations, by default all that are stated; takes about two minutes.

    The theory is compiled, and kept in the user's cache; each statement is made and proved in files
    of its own, the axioms that it rests on are compared with those that are allowed, and all that
    was accepted is checked once more by coqchk, the theory with it. Without Coq every verdict is
    *Coq absent*.

    Args:
        numbers: of equations.
        mutants: whether to ask about mechanical changes of them too, several minutes more.
        notice: told what is being done.
        told: told each verdict as it comes; coqchk, which comes last, may take it back.

    Raises:
        NoSuchFormError: there is no equation of that number.
        TypeError: ``numbers`` is a single one.
    """
    if isinstance(numbers, int | str):
        raise TypeError(f"certify takes several numbers: certify([{numbers!r}])")
    wanted: list[Number] = list(STATED)
    if numbers is not None:
        wanted = [equation(number).number for number in numbers]
    seeds = SEEDS if numbers is None else ()
    sources = theory()
    hashed = theory_hash(sources)
    with TemporaryDirectory() as folder:
        try:
            coq = CoqFolder(Path(folder))
        except CoqAbsentError as absent:
            equations, packings = (
                tuple(Certificate(n, Verdict.ABSENT, note=str(absent)) for n in of)
                for of in (wanted, seeds)
            )
            for one in (*equations, *packings):
                told(one)
            return Certification(equations, packings, hashed)
        asked = {number: asked_of(number) for number in (*wanted, *seeds)}
        files = {
            number: {} if isinstance(made, NotStatedError) else files_of(made)
            for number, made in asked.items()
        }
        by_number: dict[Number, Certificate] = {}

        def look() -> None:
            for number, made in asked.items():
                if number not in by_number and coq.said.keys() >= files[number].keys():
                    by_number[number] = certificate(coq, number, made)
                    told(by_number[number])

        coq.restore(sources)
        everything = {name: text for own in files.values() for name, text in own.items()}
        coq.compile(sources | everything, notice, look)
        notice("coqchk")
        found = checked(coq, [by_number[number] for number in (*wanted, *seeds)])
        if mutants:
            notice("mutants")
            found = [
                one
                if one.number in seeds or not one.passed
                else replace(one, changes=tried(coq, load(one.number), notice))
                for one in found
            ]
        return Certification(tuple(found[: len(wanted)]), tuple(found[len(wanted) :]), hashed)


def certificate(coq: CoqFolder, number: Number, asked: Asked) -> Certificate:
    """Read what Coq has said of the statements of one equation or packing."""
    if isinstance(asked, NotStatedError):
        return Certificate(number, Verdict.NOT_STATED, coq.checker, note=str(asked))
    trouble = coq.trouble((*theory(), *files_of(asked)))
    axioms: set[str] = set()
    for one in asked:
        if not trouble:
            named = axioms_in(coq.said[one.accepted_in].printed)
            if named is None:
                trouble = f"{one.accepted_in}: Coq does not say what it rests on"
            elif foreign := sorted({*named} - ALLOWED):
                trouble = f"it rests on {', '.join(foreign)}"
            axioms |= {*(named or ())}
    return Certificate(
        number,
        Verdict.NOT_ACCEPTED if trouble else Verdict.ACCEPTED,
        coq.checker,
        {one.name: one.hash for one in asked},
        tuple(sorted(axioms)),
        trouble,
        about=tuple(dict.fromkeys(words for one in asked for words in one.about)),
    )


def checked(coq: CoqFolder, found: list[Certificate]) -> list[Certificate]:
    """Let coqchk check all that was accepted; nothing of it is, if there is trouble."""
    accepted = [one for one in found if one.passed]
    names = [Statement.accepted_file(name) for one in accepted for name in one.theorems or ()]
    trouble = coq.check(names) if names else ""
    if not trouble:
        if names:
            coq.keep()
        return found
    return [
        replace(one, verdict=Verdict.NOT_ACCEPTED, note=trouble) if one in accepted else one
        for one in found
    ]


def tried(
    coq: CoqFolder,
    derivation: Derivation,
    notice: Notice = _silent,
    chosen: Callable[[int], bool] = lambda _: True,
) -> Changes:
    """Ask about mechanical changes of an equation, those whose place in the list is chosen."""
    made = [
        (part, mutant)
        for part, printed in enumerate(derivation.printed)
        for mutant in made_mutants(printed)
    ]
    controls = {-1 - part: one for part, one in enumerate(statements(derivation))}
    goals = {}
    for place, (part, mutant) in enumerate(made):
        if chosen(place):
            with suppress(NotStatedError):
                goals[place] = statement(derivation, part, mutant.equation)
    said = answers(coq, f"Mutants_{derivation.number}", controls | goals, notice)
    if any(said.pop(place) is not Answer.ACCEPTED for place in controls):
        raise RuntimeError(f"Eq. {derivation.number} itself is not accepted beside its mutants")
    accepted = []
    for place in [place for place, word in said.items() if word is Answer.ACCEPTED]:
        part, mutant = made[place]
        ruling = derivation.rule_on(part, mutant.equation)
        accepted.append(Change(part, mutant.change, ruling.verdict.is_proved))
    refuted = list(said.values()).count(Answer.REFUTED)
    return Changes(len(made), len(goals), refuted, tuple(accepted))


class Answer(StrEnum):
    """What Coq says of a statement that need not be true."""

    ACCEPTED = "accepted"  # proved
    REFUTED = "refuted"  # its contrary is
    OPEN = "open"  # neither


_ANSWER = re.compile(rf"^({'|'.join(Answer)}) (-?\d+)$", re.MULTILINE)


def answers(
    coq: CoqFolder, name: str, goals: Mapping[int, Statement], notice: Notice = _silent
) -> dict[int, Answer]:
    """What Coq says of many statements: each is disproved if it can be, or else proved.

    Raises:
        RuntimeError: Coq did not get to the end of them.
    """
    places = list(goals)
    asked: list[str] = []
    sources: dict[str, str] = {}
    for start in range(0, len(places), IN_ONE_FILE):
        some = {place: goals[place] for place in places[start : start + IN_ONE_FILE]}
        module, stated_in = f"{name}_from_{start}", f"{name}_from_{start}_statements"
        beside = {one.beside.name: one.beside for one in some.values() if one.beside}
        says = {known.name: known.proposition for known in beside.values()}
        says |= {_statement_of(place): one.proposition for place, one in some.items()}
        lemmas = [("Lemma", one.name, one.name, f"{one.tactic}.") for one in beside.values()]
        goals_of = "\n".join(_goal(place, stated_in, one) for place, one in some.items())
        sources |= {
            f"{stated_in}.v": words_of(says),
            f"{module}.v": f"{proof_of('Counterexamples', stated_in, *lemmas)}\n{goals_of}",
        }
        asked.append(f"{module}.v")
    coq.compile(sources, notice)
    said = {
        int(place): Answer(word)
        for file in asked
        for word, place in _ANSWER.findall(coq.said[file].printed)
    }
    if list(said) != places:
        raise RuntimeError(f"{name}: {coq.trouble(sources) or 'an answer is missing'}")
    return said


def _statement_of(place: int) -> str:
    return f"statement_{place}".replace("-", "printed_")


def _goal(place: int, stated_in: str, one: Statement) -> str:
    says = f"{stated_in}.{_statement_of(place)}"
    tries = [
        (Answer.REFUTED, f"right; solve [abstract ({one.disproof or 'fail'})]"),
        (Answer.ACCEPTED, f"left; solve [abstract ({one.tactic})]"),
    ]
    limited = "\n  |".join(
        f'timeout {MUTANT_LIMIT} ({tactics}); idtac "{word} {place}"' for word, tactics in tries
    )
    return (
        f"Goal {says} \\/ ~ {says}.\ncbv delta [{says}].\n"
        f'first\n  [{limited}\n  |idtac "{Answer.OPEN} {place}"].\nAbort.\n'
    )
