"""Coq's verdicts. They take minutes, so they are asked for: FORCE_DIFFUSION_TEST_COQ=required."""

import os
import shutil
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
import sympy
from force_diffusion.derivations.api import certificates
from force_diffusion.derivations.api.certificates import certificate, certify
from force_diffusion.derivations.coq.files import Statement, theory
from force_diffusion.derivations.coq.folder import ALLOWED, CoqFolder
from force_diffusion.derivations.coq.record import Certificate
from force_diffusion.derivations.coq.statements import statements
from force_diffusion.derivations.framework.catalogue import paper
from force_diffusion.derivations.framework.loading import load
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import terms, times
from force_diffusion.symbolic.trees import equation

pytestmark = pytest.mark.skipif(
    os.environ.get("FORCE_DIFFUSION_TEST_COQ") != "required",
    reason="takes minutes; asked for by FORCE_DIFFUSION_TEST_COQ=required",
)


@pytest.fixture(scope="module")
def coq(tmp_path_factory: pytest.TempPathFactory) -> CoqFolder:
    made = CoqFolder(tmp_path_factory.mktemp("coq"))
    made.compile(theory(), print)
    assert made.trouble(theory()) == ""
    return made


def ask(coq: CoqFolder, made: Statement) -> Certificate:
    for name in made.files:
        coq.said.pop(name, None)
    coq.compile(made.files, print)
    return certificate(coq, 0, [made])


def test_every_equation_is_accepted() -> None:
    found = certify()
    assert found.passed
    assert [one.number for one in found.equations] == paper()
    for one in found.equations:
        assert one.accepted, one
        assert set(one.axioms) <= ALLOWED


def wrong(number: int) -> Statement:
    """The first statement of an equation with another right side, without its companions."""
    derivation = load(number)
    first, *others = derivation.printed
    if number == 6:  # the right side is 0: the load enters twice
        other = equation(terms(first.lhs, sy.Load(sy.k, sy.l)), first.rhs)
    else:  # Eq. 15 holds up to a factor
        other = equation(first.lhs, times(sy.M if number == 15 else 2, first.rhs))
    changed = replace(derivation, printed=(other, *others))
    return replace(statements(changed)[0], companions=())


@pytest.mark.parametrize("number", paper())
def test_another_equation_is_not_accepted(coq: CoqFolder, number: int) -> None:
    true = replace(statements(load(number))[0], companions=())
    assert ask(coq, true).accepted
    assert not ask(coq, wrong(number)).accepted


@pytest.mark.parametrize("number", [13, 14])
def test_another_exact_variance_is_not_accepted(coq: CoqFolder, number: int) -> None:
    derivation = load(number)
    ((name, form),) = derivation.exact_forms.items()
    first, *others = form.pieces
    wrong = replace(first, expr=first.expr + sympy.Rational(1, 1000) * sy.phi)
    other = SimpleNamespace(pieces=(wrong, *others))
    changed = replace(derivation, exact=lambda: {name: other})
    (made,) = (one for one in statements(changed) if one.name.endswith("_exact"))
    assert not ask(coq, replace(made, companions=())).accepted


def reworded(true: Statement, words: str, others: str) -> Statement:
    """A statement with other words in place of some."""
    assert words in true.proposition
    return replace(
        true,
        hypotheses=tuple(line.replace(words, others) for line in true.hypotheses),
        conclusion=true.conclusion.replace(words, others),
        companions=(),
    )


@pytest.mark.parametrize(
    ("name", "true", "false"),
    [
        ("equation_10_else_nothing", "(k - i > l - j", "(k - i >= l - j"),
        ("equation_10_else_nothing", "i - k >= l - j)", "i - k >= l - j - 2)"),
        ("equation_10_else_nothing_mirrored", "(i - k > l - j", "(i - k >= l - j"),
        ("equation_12_second_difference", "6 * sigma", "5 * sigma"),
        ("equation_14_maximum", "M = 6 * j", "M = 7 * j"),
        ("equation_13_exact", "f_load / (2 * n_y G)", "f_load / (2 * n_x G)"),
    ],
)
def test_what_is_stated_beside_is_not_accepted_otherwise(
    coq: CoqFolder, name: str, true: str, false: str
) -> None:
    number = int(name.split("_")[1])
    (made,) = (one for one in statements(load(number)) if one.name == name)
    assert not ask(coq, reworded(made, true, false)).accepted


@pytest.mark.parametrize(
    ("says", "proof", "trouble"),
    [
        ("0 = 1", "exact I. Qed.", "0 = 1"),
        ("0 = 1", "lra. Qed.", "Cannot find witness"),
        ("0 = 1", "Admitted.", "rests on Planted.statement"),
        (
            "True \\/ ~ True",
            "apply Classical_Prop.classic. Qed.",
            "rests on Classical_Prop.classic",
        ),
    ],
)
def test_what_is_not_proved_is_not_accepted(
    coq: CoqFolder, says: str, proof: str, trouble: str
) -> None:
    found = ask(coq, Planted("planted", (), says, proof))
    assert not found.accepted
    assert trouble in found.note


class Planted(Statement):
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
    "a file": "Module Equation_3_statement.\n"
    "Definition statement : Prop := True. End Equation_3_statement.",
    "a library": "Module ForceDiffusion. Module Equation_3_statement.\n"
    "Definition statement : Prop := True. End Equation_3_statement. End ForceDiffusion.",
    "an axiom": "Axiom trust_me : forall P : Prop, P.",
}
"""What a file of the theory may say to change what a statement says, or what proves it."""
AT_ONCE = "Ltac prove_3 ::= intros; first [exact I|exact (trust_me _)]."


@pytest.mark.parametrize("kind", BENT)
def test_no_file_of_the_theory_can_change_what_is_stated(
    coq: CoqFolder, tmp_path: Path, kind: str
) -> None:
    """Twice the right side of Eq. 3, with a tactic that proves what is bent at once."""
    folder = tmp_path / "bent"
    shutil.copytree(coq.folder, folder)
    bent = CoqFolder(folder)
    bent.said = {name: said for name, said in coq.said.items() if name != "Certify.v"}
    at_once = AT_ONCE if kind == "an axiom" else AT_ONCE.replace("|exact (trust_me _)", "")
    bent.compile({"Certify.v": f"{theory()['Certify.v']}\n{BENT[kind]}\n{at_once}\n"}, print)
    found = ask(bent, wrong(3))
    assert not found.accepted
    assert not bent.trouble(["Certify.v", "Equation_3_statement.v"])
    assert kind != "an axiom" or found.note == "it rests on Certify.trust_me"


def test_a_theory_that_does_not_compile_accepts_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    broken = {**theory(), "Model.v": "Definition r := ."}
    monkeypatch.setattr(certificates, "theory", lambda: broken)
    (one,) = certify([1]).equations
    assert not one.accepted
    assert "Model.v" in one.note


def test_coqchk_finds_what_was_never_compiled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
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
    (one,) = certify([1]).equations
    assert not one.accepted
    assert "coqchk" in one.note
