"""A second, unrelated checker: does Coq accept the printed equations?

The statements are made from what the derivations print (``derivations.export.coq``); the theory
that proves them is written by hand (``proofs/``). Neither SymPy nor the package's own kernel takes
part in the verdict.
"""

import hashlib
import os
import re
import shutil
import subprocess
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from enum import StrEnum
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from force_diffusion.derivations.api.equation import equation
from force_diffusion.derivations.export.coq import NotStatedError, Statement, header, statement
from force_diffusion.derivations.export.coq_packings import packing_statement
from force_diffusion.derivations.framework.catalogue import Number, load, paper
from force_diffusion.derivations.framework.record import Derivation
from force_diffusion.derivations.framework.runner import SEEDS
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError
from force_diffusion.symbolic.kernel.decisions import Verdict as Proof
from force_diffusion.symbolic.kernel.mutants import mutants as made_mutants

ALLOWED = frozenset(
    {
        "ClassicalDedekindReals.sig_not_dec",
        "ClassicalDedekindReals.sig_forall_dec",
        "FunctionalExtensionality.functional_extensionality_dep",
    }
)
"""Axioms that a theorem may rest on: those of Coq's real numbers, and equality of functions."""

IN_THE_LIBRARY = frozenset({"Classical_Prop.classic"})
"""Axioms that Coq's library of the reals declares besides, and that no theorem here may use."""

INSTALL = "on Debian and Ubuntu: apt-get install coq; elsewhere: https://coq.inria.fr"
LIBRARY = "ForceDiffusion"
EXISTENCE = "Existence"  # no proof rests on it: it says that hypotheses can be fulfilled
LIMIT = 600  # seconds for one file; the slowest takes about ten
MUTANT_LIMIT = 30  # seconds for one changed statement


class Verdict(StrEnum):
    """What Coq says of an equation."""

    ACCEPTED = "accepted"
    NOT_ACCEPTED = "not accepted"
    NOT_STATED = "not stated"
    ABSENT = "Coq absent"


@dataclass(frozen=True)
class Change:
    """A printed equation with one mechanical change (``symbolic.kernel.mutants``).

    Attributes:
        part: which of the printed equations.
        change: in words.
        accepted: whether Coq accepts it.
        equivalent: of an accepted one, whether ``derive`` proves it too.
    """

    part: int
    change: str
    accepted: bool
    equivalent: bool


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
        mutants: the changes tried.
    """

    number: Number
    verdict: Verdict
    checker: str = ""
    theorems: tuple[tuple[str, str], ...] = ()
    axioms: tuple[str, ...] = ()
    note: str = ""
    mutants: tuple[Change, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether it is accepted, and no change of it that makes it another equation."""
        wrong = any(change.accepted and not change.equivalent for change in self.mutants)
        return self.verdict is Verdict.ACCEPTED and not wrong

    def __str__(self) -> str:
        said = f"{self.verdict} by {self.checker}" if self.checker else str(self.verdict)
        return said if self.verdict is not Verdict.NOT_STATED else str(self.verdict)


@dataclass(frozen=True)
class Certification:
    """All that Coq was asked.

    Attributes:
        equations: the printed equations.
        packings: exact packings, whose Taylor coefficients ``numeric`` computes as fractions; the
            theory must have the same. Asked about together with all equations.
    """

    equations: tuple[Certificate, ...]
    packings: tuple[Certificate, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether all is accepted."""
        return all(one.passed for one in (*self.equations, *self.packings))


Notice = Callable[[str], None]
"""Told what is being done."""


def _silent(_: str) -> None:
    """Tell nobody."""


class CoqAbsentError(ForceDiffusionError):
    """There is no Coq on this machine."""

    exit_status = 3


class Workshop:
    """A folder with the compiled theory, in which statements are tried.

    Raises:
        CoqAbsentError: when there is no Coq.
    """

    def __init__(self, folder: Path) -> None:
        """Write the theory; ``compile_theory`` compiles it."""
        missing = [name for name in ("coqc", "coqchk", "coqdep") if not shutil.which(name)]
        if missing:
            raise CoqAbsentError(f"{missing[0]} is not there. Install Coq: {INSTALL}")
        self.folder = folder
        self.checker = f"Coq {self._call('coqc', '--print-version').stdout.split()[0]}"
        for name, source in theory().items():
            (folder / name).write_text(source, encoding="utf-8")

    def _call(self, program: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        environment = {name: at for name, at in os.environ.items() if not name.startswith("COQ")}
        try:
            return subprocess.run(
                [program, *arguments],
                cwd=self.folder,
                env=environment,
                capture_output=True,
                text=True,
                timeout=LIMIT,
                check=False,
            )
        except subprocess.TimeoutExpired:
            late = f"no answer within {LIMIT} s"
            return subprocess.CompletedProcess([program], 1, "", late)

    def compile(self, name: str) -> subprocess.CompletedProcess[str]:
        """Let Coq read one file."""
        return self._call("coqc", "-q", "-R", ".", LIBRARY, name)

    def compile_theory(self, notice: Notice = _silent) -> str:
        """Compile the theory; what went wrong, or nothing."""
        in_order = self._call("coqdep", "-sort", "-R", ".", LIBRARY, *sorted(theory()))
        for name in in_order.stdout.split():
            notice(f"theory: {name}")
            done = self.compile(name)
            if done.returncode:
                return f"{name}: {_last(done.stderr)}"
        return ""

    def check(self, names: Iterable[str]) -> str:
        """Let coqchk check compiled files and all they rest on; what went wrong, or nothing."""
        names = (*names, EXISTENCE)
        compiled = [f"{LIBRARY}.{name}" for name in names]
        done = self._call("coqchk", "-silent", "-o", "-R", ".", LIBRARY, *compiled)
        if done.returncode:
            return f"coqchk: {_last(done.stderr)}"
        return unexpected(done.stdout + done.stderr)  # it prints its summary as a message


def theory() -> dict[str, str]:
    """The hand-written theory: names and sources of its files."""
    found = files("force_diffusion.proofs").iterdir()
    return {
        one.name: one.read_text(encoding="utf-8")
        for one in sorted(found, key=lambda one: one.name)
        if one.name.endswith(".v")
    }


def _last(message: str) -> str:
    """The error in what Coq prints, on one line."""
    _, _, error = message.rpartition("Error:")
    return " ".join((error or message).split())[:200]


_SECTION = re.compile(r"^\* (.*?):\s*(.*?)(?=^\* |\Z)", re.MULTILINE | re.DOTALL)


def unexpected(summary: str) -> str:
    """What coqchk's summary holds that must not be there, or nothing."""
    sections = dict(_SECTION.findall(summary))
    expected = {
        "Theory",
        "Axioms",
        "Constants/Inductives relying on type-in-type",
        "Constants/Inductives relying on unsafe (co)fixpoints",
        "Inductives whose positivity is assumed",
    }
    if set(sections) != expected:
        return "coqchk: its summary is not as expected"
    if sections["Theory"].strip() != "Set is predicative":
        return f"coqchk: {sections['Theory'].strip()}"
    for axiom in sections["Axioms"].split():
        if ".".join(axiom.split(".")[-2:]) not in ALLOWED | IN_THE_LIBRARY:
            return f"coqchk: the axiom {axiom}"
    for name in expected - {"Theory", "Axioms"}:
        if sections[name].strip() != "<none>":
            return f"coqchk: {name}: {sections[name].strip()}"
    return ""


def axioms_in(printed: str) -> tuple[str, ...]:
    """What ``Print Assumptions`` names: every word at the start of a line but its headings."""
    lines = (line for line in printed.splitlines() if line and not line[0].isspace())
    headings = ("Axioms:", "Closed under the global context")
    return tuple(sorted({line.split()[0] for line in lines if line not in headings}))


def statements(derivation: Derivation) -> list[Statement]:
    """The printed equations of a derivation in Coq, part by part."""
    return [statement(derivation, part) for part in range(len(derivation.printed))]


def file_name(made: Statement) -> str:
    """The file that holds a statement."""
    return f"{made.name.capitalize()}.v"


def sources(numbers: Iterable[Number] | None = None) -> dict[str, str]:
    """Files with the statements that ``certify`` tries; what can't be stated has none."""
    found = [packing_statement(seed) for seed in SEEDS] if numbers is None else []
    for number in paper() if numbers is None else numbers:
        with suppress(NotStatedError):
            found += statements(load(number))
    return {file_name(made): made.source for made in found}


def certify(
    numbers: Iterable[Number] | None = None,
    *,
    mutants: bool | Callable[[int], bool] = False,
    notice: Notice = _silent,
) -> Certification:
    """Ask Coq about equations, all of the paper's by default; takes about two minutes.

    The theory is compiled, each statement is made and proved in a file of its own, the axioms
    that it rests on are compared with ``ALLOWED``, and all that was accepted is checked once more
    by coqchk. Without Coq every verdict is *Coq absent*.

    Args:
        numbers: of equations.
        mutants: whether to ask about mechanical changes of them too, several minutes more; or
            which ones, by their place in the list.
        notice: told what is being done.

    Raises:
        NoSuchEquationError: there is no equation of that number.
    """
    wanted: list[Number] = list(paper())
    if numbers is not None:
        wanted = [equation(number).number for number in numbers]
    seeds = SEEDS if numbers is None else ()
    chosen = mutants if callable(mutants) else lambda _: bool(mutants)
    with TemporaryDirectory() as folder:
        try:
            shop = Workshop(Path(folder))
        except CoqAbsentError as absent:
            note = str(absent)
            return Certification(
                *(
                    tuple(Certificate(n, Verdict.ABSENT, note=note) for n in of)
                    for of in (wanted, seeds)
                )
            )
        trouble = shop.compile_theory(notice)
        found = []
        for number in wanted:
            notice(f"Eq. {number}")
            found.append(certificate(shop, number, lambda n: statements(load(n)), trouble))
        for seed in seeds:
            notice(f"packing {seed}")
            found.append(certificate(shop, seed, lambda n: [packing_statement(n)], trouble))
        notice("coqchk")
        trouble = shop.check(
            name.capitalize() for one in found if one.passed for name, _ in one.theorems
        )
        if trouble:
            found = [
                replace(one, verdict=Verdict.NOT_ACCEPTED, note=trouble) if one.passed else one
                for one in found
            ]
        equations, packings = found[: len(wanted)], found[len(wanted) :]
        if mutants:
            equations = [_with_mutants(shop, one, chosen, notice) for one in equations]
        return Certification(tuple(equations), tuple(packings))


def certificate(
    shop: Workshop, number: Number, made: Callable[[Any], list[Statement]], trouble: str
) -> Certificate:
    """Try the statements of one equation or packing; ``trouble`` is what the theory has."""
    try:
        stated = made(number)
    except NotStatedError as reason:
        return Certificate(number, Verdict.NOT_STATED, shop.checker, note=str(reason))
    axioms: set[str] = set()
    for one in stated:
        if trouble:
            break
        name = file_name(one)
        (shop.folder / name).write_text(one.source, encoding="utf-8")
        done = shop.compile(name)
        axioms |= set(axioms_in(done.stdout))
        if done.returncode:
            trouble = _last(done.stderr)
        elif axioms - ALLOWED:
            trouble = f"it rests on {', '.join(sorted(axioms - ALLOWED))}"
    return Certificate(
        number,
        Verdict.NOT_ACCEPTED if trouble else Verdict.ACCEPTED,
        shop.checker,
        tuple((one.name, sha256(one.proposition)) for one in stated),
        tuple(sorted(axioms)),
        trouble,
    )


def sha256(content: str) -> str:
    """Hash of a text."""
    return hashlib.sha256(content.encode()).hexdigest()


_ANSWER = re.compile(r"^(accepted|refused) (\d+)$", re.MULTILINE)


def _with_mutants(
    shop: Workshop, found: Certificate, chosen: Callable[[int], bool], notice: Notice
) -> Certificate:
    if found.verdict is not Verdict.ACCEPTED:
        return found
    notice(f"mutants of Eq. {found.number}")
    return replace(found, mutants=tuple(tried(shop, load(found.number), chosen)))


def tried(
    shop: Workshop, derivation: Derivation, chosen: Callable[[int], bool]
) -> Iterator[Change]:
    """Changes of an equation as goals of one file; those without words are left out."""
    changes = [
        (part, mutant)
        for part, printed in enumerate(derivation.printed)
        for mutant in made_mutants(printed)
    ]
    tries, source = [], [header()]
    for place, (part, mutant) in enumerate(changes):
        if not chosen(place):
            continue
        try:
            made = statement(derivation, part, mutant.equation)
        except NotStatedError:
            continue
        tries.append(place)
        source += [
            f"Goal\n{made.proposition}.",
            f'first [timeout {MUTANT_LIMIT} (solve [{made.tactic}]); idtac "accepted {place}"',
            f'  |idtac "refused {place}"].',
            "Abort.",
        ]
    name = f"Changes_{derivation.number}.v"
    (shop.folder / name).write_text("\n".join(source) + "\n", encoding="utf-8")
    done = shop.compile(name)
    answers = {int(place): said == "accepted" for said, place in _ANSWER.findall(done.stdout)}
    if list(answers) != tries:
        raise RuntimeError(f"{name} stopped half-way: {_last(done.stderr)}")
    for place, accepted in answers.items():
        part, mutant = changes[place]
        ruling = derivation.rule_on(part, mutant.equation) if accepted else None
        equivalent = ruling is not None and ruling.verdict is Proof.PROVED
        yield Change(part, mutant.change, accepted, equivalent)
