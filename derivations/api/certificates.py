"""A second, unrelated checker: does Coq accept the printed equations?

The statements are made from what the derivations print (``derivations.coq.statements``); the theory
that proves them is written by hand (``proofs/``). Neither SymPy nor the package's own kernel takes
part in the verdict.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from force_diffusion.numeric.arithmetic.errors import checked

from ..coq.files import CoqStatement, theory, theory_hash
from ..coq.folder import ALLOWED, CoqFolder, Notice, axioms_in
from ..coq.record import Certificate, Certification
from ..coq.statements import statements
from ..framework.catalogue import NoSuchFormError, Number, paper
from ..framework.record import Derivation, load
from .equation import numbers_of


def coq_statements(numbers: Iterable[Number] | None = None) -> dict[Number, list[CoqStatement]]:
    """What ``certify`` asks of each equation.

    Raises:
        NoSuchFormError: there is no equation of that number in the paper.
    """
    wanted = numbers_of(paper() if numbers is None else numbers, "certify")
    for number in wanted:
        if number not in paper():
            raise NoSuchFormError(
                f"Eq. {number} is not stated for Coq: give a number from 1 to {max(paper())}"
            )
    derivations = ((number, load(number)) for number in wanted)
    return {n: statements(whole) for n, whole in derivations if isinstance(whole, Derivation)}


def sources(asked: Mapping[Number, Sequence[CoqStatement]]) -> dict[str, str]:
    """Names and sources of all that Coq reads: the theory, and the files of these statements."""
    files = (statement.files for several in asked.values() for statement in several)
    return theory() | {name: text for each in files for name, text in each.items()}


@checked
def certify(
    numbers: Iterable[Number] | None = None, *, notice: Notice = lambda _: None
) -> Certification:
    """Ask Coq about the paper's equations, by default all of them; takes about two minutes.

    Each equation is stated and proved in files of its own, and the axioms that it rests on are
    compared with those allowed. Then coqchk checks all accepted proofs and the theory again.

    Args:
        numbers: of equations.
        notice: called with words about what is being done.

    Raises:
        CoqAbsentError: there is no Coq on this machine.
        NoSuchFormError: the paper has no equation of that number.
        WrongTypeError: ``numbers`` is a single number.
    """
    asked = coq_statements(numbers)
    with TemporaryDirectory() as folder:
        coq = CoqFolder(Path(folder))
        coq.compile(sources(asked), notice)
        certificates = [certificate(coq, number, several) for number, several in asked.items()]
        notice("coqchk")
        accepted = (asked[answer.number] for answer in certificates if answer.accepted)
        modules = [statement.accepted_in for several in accepted for statement in several]
        if trouble := coq.check([*modules, "Beside"]) if modules else "":
            certificates = [
                replace(answer, accepted=False, note=trouble) if answer.accepted else answer
                for answer in certificates
            ]
    return Certification(tuple(certificates), theory_hash())


def certificate(coq: CoqFolder, number: Number, asked: Sequence[CoqStatement]) -> Certificate:
    """Read what Coq has said of the statements of one equation."""
    trouble = coq.trouble((*theory(), *(name for statement in asked for name in statement.files)))
    axioms: set[str] = set()
    for statement in asked:
        if not trouble:
            named = axioms_in(coq.answers[f"{statement.accepted_in}.v"].printed)
            if named is None:
                trouble = f"{statement.accepted_in}: Coq does not say what it rests on"
            elif foreign := sorted({*named} - ALLOWED):
                trouble = f"it rests on {', '.join(foreign)}"
            axioms |= {*(named or ())}
    return Certificate(
        number,
        accepted=not trouble,
        checker=coq.checker,
        theorems={statement.name: statement.hash for statement in asked},
        axioms=tuple(sorted(axioms)),
        note=trouble,
        about=tuple(dict.fromkeys(words for statement in asked for words in statement.about)),
    )
