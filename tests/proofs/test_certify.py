"""Coq's verdicts. They take minutes, so they are asked for: FORCE_DIFFUSION_TEST_COQ=required."""

import os
import shutil
from contextlib import nullcontext
from dataclasses import dataclass, fields, replace
from pathlib import Path
from types import SimpleNamespace

import pytest
import sympy
from force_diffusion.derivations.api import certificates
from force_diffusion.derivations.api.certificates import certificate, certify
from force_diffusion.derivations.coq.files import CoqStatement, theory
from force_diffusion.derivations.coq.folder import ALLOWED, CoqFolder
from force_diffusion.derivations.coq.record import Certificate, Certification
from force_diffusion.derivations.coq.statements import statements
from force_diffusion.derivations.framework.catalogue import paper
from force_diffusion.derivations.framework.record import load
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import terms, times
from force_diffusion.symbolic.trees import equation

pytestmark = pytest.mark.skipif(
    os.environ.get("FORCE_DIFFUSION_TEST_COQ") != "required",
    reason="takes minutes; asked for by FORCE_DIFFUSION_TEST_COQ=required",
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("coq")


@pytest.fixture(scope="module")
def certified(folder: Path) -> Certification:
    """What ``certify`` finds, in a folder that stays."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(certificates, "TemporaryDirectory", lambda: nullcontext(str(folder)))
        return certify()


@pytest.fixture
def coq(folder: Path, certified: Certification) -> CoqFolder:
    """A folder in which the theory is compiled."""
    assert certified.passed
    return CoqFolder(folder)


def accepted(coq: CoqFolder, asked: dict[str, CoqStatement]) -> dict[str, Certificate]:
    """What Coq says of statements, each in files of its own."""
    named = {key: replace(goal, name=f"asked_{n}") for n, (key, goal) in enumerate(asked.items())}
    coq.compile({name: text for goal in named.values() for name, text in goal.files.items()}, print)
    return {key: certificate(coq, 0, [goal]) for key, goal in named.items()}


def test_every_equation_is_accepted(certified):
    assert certified.passed
    assert [verdict.number for verdict in certified.equations] == paper()
    for verdict in certified.equations:
        assert verdict.accepted, verdict
        assert set(verdict.axioms) <= ALLOWED


def wrong(number: int) -> CoqStatement:
    """The first statement of an equation with another right side, without its companions."""
    derivation = load(number)
    first, *others = derivation.printed
    if number == 6:  # the right side is 0: the load enters twice
        other = equation(terms(first.lhs, sy.LoadForce(sy.k, sy.l)), first.rhs)
    else:  # Eq. 15 holds up to a factor
        other = equation(first.lhs, times(sy.M if number == 15 else 2, first.rhs))
    changed = replace(derivation, printed=(other, *others))
    return replace(statements(changed)[0], companions=())


def wrong_variance(number: int) -> CoqStatement:
    """The exact variance of an equation with a thousandth more in one case."""
    derivation = load(number)
    ((name, form),) = derivation.exact_forms.items()
    first, *others = form.pieces
    wrong_value = first.expr + sympy.Rational(1, 1000) * sy.phi
    other = SimpleNamespace(where=first.where, expr=wrong_value)
    changed = replace(derivation, exact=lambda: {name: SimpleNamespace(pieces=(other, *others))})
    (made,) = (goal for goal in statements(changed) if goal.name.endswith("_exact"))
    return replace(made, companions=())


def reworded(true: CoqStatement, words: str, others: str) -> CoqStatement:
    """A statement with other words in place of some."""
    assert words in true.proposition
    return replace(
        true,
        hypotheses=tuple(line.replace(words, others) for line in true.hypotheses),
        conclusion=true.conclusion.replace(words, others),
        companions=(),
    )


def test_what_is_false_is_not_accepted(coq):
    asked = {f"Eq. {number}": wrong(number) for number in paper()}
    asked |= {f"the variance of Eq. {number}": wrong_variance(number) for number in (13, 14)}
    exact = statements(load(13))[-1]
    asked["the mean of Eq. 13"] = reworded(exact, "f_load / (2 * n_y G)", "f_load / (2 * n_x G)")
    assert not [what for what, verdict in accepted(coq, asked).items() if verdict.accepted]


UNPROVED = {
    "0 = 1": ("exact I. Qed.", "0 = 1"),
    "0 = 2": ("lra. Qed.", "Cannot find witness"),
    "0 = 3": ("Admitted.", "rests on Asked_2.statement"),
    "True \\/ ~ True": ("apply Classical_Prop.classic. Qed.", "rests on Classical_Prop.classic"),
}
"""Statements, what is said to prove them, and what is found."""


def test_what_is_not_proved_is_not_accepted(coq):
    asked = {says: Planted("", (), says, proof) for says, (proof, _) in UNPROVED.items()}
    for says, verdict in accepted(coq, asked).items():
        assert not verdict.accepted
        assert UNPROVED[says][1] in verdict.note


class Planted(CoqStatement):
    """A statement with a proof that is given."""

    @property
    def proof(self) -> str:
        """The file that would prove it."""
        head, _, _ = super().proof.partition("\nTheorem")
        says = f"{self.statement_in}.statement"
        return f"{head}Theorem statement : {says}.\nProof. unfold {says}. {self.tactic}\n"


BENT = {
    "a word": "Definition first_order_vector (one other : R -> vector) : Prop := True.",
    "a notation": "Notation \"'first_order_vector'\" := (fun _ _ => True).",
    "a file": "Module STATED. Definition statement : Prop := True. End STATED.",
    "a library": "Module ForceDiffusion. Module STATED.\n"
    "Definition statement : Prop := True. End STATED. End ForceDiffusion.",
    "an axiom": "Axiom trust_me : forall P : Prop, P.",
}
"""What a file of the theory may say to change what a statement says, or what proves it."""


@dataclass(frozen=True)
class Bent(CoqStatement):
    """A statement with a proof that imports such a file, which has a tactic for it."""

    bent: str = ""

    @property
    def proof(self) -> str:
        """The file that would prove it."""
        return super().proof.replace("Import Certify.", f"Import {self.module}_bent.")

    @property
    def files(self) -> dict[str, str]:
        """The three, and the one that is imported."""
        at_once = "intros; first [exact I" + "|exact (trust_me _)" * ("Axiom" in self.bent) + "]"
        source = (
            "From ForceDiffusion Require Export Certify.\n"
            f"{self.bent.replace('STATED', self.statement_in)}\nLtac prove_3 ::= {at_once}.\n"
        )
        return {f"{self.module}_bent.v": source, **super().files}


def test_no_file_of_the_theory_can_change_what_is_stated(coq):
    """Twice the right side of Eq. 3, with a tactic that proves what is bent at once."""
    twice = {field.name: getattr(wrong(3), field.name) for field in fields(CoqStatement)}
    verdicts = accepted(coq, {kind: Bent(**twice, bent=source) for kind, source in BENT.items()})
    for number, (kind, verdict) in enumerate(verdicts.items()):
        assert not verdict.accepted
        files = [f"Asked_{number}_{part}.v" for part in ("bent", "statement")]
        assert not coq.trouble(files)
        assert (kind == "an axiom") == (verdict.note == f"it rests on Asked_{number}_bent.trust_me")


def test_a_theory_that_does_not_compile_accepts_nothing(monkeypatch):
    broken = {**theory(), "Model.v": "Definition r := ."}
    monkeypatch.setattr(certificates, "theory", lambda: broken)
    (verdict,) = certify([1]).equations
    assert not verdict.accepted
    assert "Model.v" in verdict.note


def test_coqchk_finds_what_was_never_compiled(tmp_path, monkeypatch):
    """The real coqchk behind a coqc that says that all is well and writes nothing."""
    liar = tmp_path / "coqc"
    liar.write_text(
        '#!/bin/sh\nif [ "$1" = --print-version ]; then echo "8.16.1 4.14.1"\n'
        "else echo Closed under the global context\nfi\n"
    )
    liar.chmod(0o755)
    checker = shutil.which("coqchk")
    assert checker
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{Path(checker).parent}{os.pathsep}/bin")
    (verdict,) = certify([1]).equations
    assert not verdict.accepted
    assert "coqchk" in verdict.note
