"""Coq's verdicts. They take minutes, so they are asked for: FORCE_DIFFUSION_TEST_COQ=required."""

import os
import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import pytest
import sympy
from force_diffusion.derivations.api import certificates
from force_diffusion.derivations.api.certificates import (
    Answer,
    answers,
    certificate,
    certify,
    tried,
)
from force_diffusion.derivations.coq.files import Statement, head_of, theory
from force_diffusion.derivations.coq.folder import ALLOWED, CoqFolder
from force_diffusion.derivations.coq.packings import packing_statement
from force_diffusion.derivations.coq.record import Certificate, Verdict
from force_diffusion.derivations.coq.statements import (
    STATED,
    exact_statement,
    mirror_image,
    statement,
    statements,
)
from force_diffusion.derivations.coq.words import NotStatedError
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.framework.runner import SEEDS
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.search.mutants import NUMBER, SIGN, mutants

from tests.derivations.test_soundness import FALSE, TRUE, Change

pytestmark = pytest.mark.skipif(
    os.environ.get("FORCE_DIFFUSION_TEST_COQ") != "required",
    reason="takes minutes; asked for by FORCE_DIFFUSION_TEST_COQ=required",
)


@pytest.fixture(scope="module", autouse=True)
def cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """A cache of their own."""
    with pytest.MonkeyPatch.context() as changed:
        folder = tmp_path_factory.mktemp("cache")
        changed.setenv("XDG_CACHE_HOME", str(folder))
        yield folder


def test_a_theory_from_the_cache_is_checked_too(cache: Path, tmp_path: Path) -> None:
    """What lies there may be compiled of other files; coqchk finds the axiom.

    The theory itself is left in the cache, for the tests that follow.
    """
    first = certify([3])
    (held,) = (cache / "force-diffusion" / "coq").iterdir()
    true, again = held.read_bytes(), certify([3])
    assert first.passed
    assert again.equations == first.equations
    bent = CoqFolder(tmp_path)
    says = "Axiom trust_me : forall P : Prop, P.\n"
    bent.restore(theory())
    assert bent.kept
    del bent.said["Counterexamples.v"]
    bent.compile({"Counterexamples.v": theory()["Counterexamples.v"] + says}, print)
    bent.kept = False  # as if all of it had been compiled here
    held.unlink()
    bent.keep()
    assert list((cache / "force-diffusion" / "coq").iterdir()) == [held]
    (one,) = certify([3]).equations
    assert one.verdict is Verdict.NOT_ACCEPTED
    assert one.note == "coqchk: the axiom ForceDiffusion.Counterexamples.trust_me"
    held.write_bytes(true)


@pytest.fixture(scope="module")
def coq(tmp_path_factory: pytest.TempPathFactory) -> CoqFolder:
    made = CoqFolder(tmp_path_factory.mktemp("coq"))
    made.restore(theory())
    made.compile(theory(), print)
    assert made.trouble(theory()) == ""
    return made


def ask(coq: CoqFolder, made: Statement) -> Certificate:
    for name in made.files:
        coq.said.pop(name, None)
    coq.compile(made.files, print)
    return certificate(coq, 0, [made])


def test_every_equation_and_packing_is_accepted() -> None:
    found = certify()
    assert found.passed
    assert [one.number for one in found.equations] == list(STATED)
    assert [one.number for one in found.packings] == list(SEEDS)
    for one in (*found.equations, *found.packings):
        assert one.verdict is Verdict.ACCEPTED, one
        assert set(one.axioms) <= ALLOWED


def reworded(true: Statement, words: str, others: str) -> Statement:
    """A statement with other words in place of some."""
    assert words in true.proposition
    return replace(
        true,
        hypotheses=tuple(line.replace(words, others) for line in true.hypotheses),
        conclusion=true.conclusion.replace(words, others),
        companions=(),
    )


def test_another_packing_is_not_accepted(coq: CoqFolder) -> None:
    true = packing_statement(SEEDS[0])
    for number, other in (("(29 / 50)", "(29 / 51)"), ("n_x G = (20 / 29)", "n_x G = (3 / 5)")):
        assert ask(coq, reworded(true, number, other)).verdict is Verdict.NOT_ACCEPTED


NOT_REFUTED = {8: 1, 9: 1, 10: 1, 12: 100, 15: 100}
"""Of how many mutants, at most, the contrary is not proved: a force divided by one that is 0, and
what is said of whole sums of squares or of all layers together."""


@pytest.mark.long(share=3)
@pytest.mark.parametrize("number", STATED)
def test_mutants_are_proved_false(coq: CoqFolder, number: Number) -> None:
    """The printed equation is asked about with them, and accepted."""
    some = tried(coq, load(number), chosen=lambda at: at % 21 == STATED.index(number) % 7)
    assert some.stated
    assert not [one for one in some.accepted if not one.equivalent]
    assert some.stated - some.refuted <= NOT_REFUTED.get(number, 0)


def exact_and_changed(number: int) -> Iterator[tuple[str, Statement]]:
    """One coefficient of one layer's exact form changed, in a packing that has that layer."""
    forms = load(number).exact()
    places = {"interior": (6, 3), "base": (5, 0), "base+1": (5, 1), "surface": (5, 4)}
    assert places.keys() == forms.keys()
    for name, (height, layer) in places.items():
        form = forms[name]
        changes = [*mutants(sympy.Eq(form.quantity, form.expression, evaluate=False))]
        for one in changes[:: len(changes) // 2]:
            changed = {**forms, name: replace(form, expression=one.equation.rhs)}
            at = {sy.M: height, sy.i: layer, sy.j: layer}
            yield f"{name}: {one.change}", exact_statement(load(number), changed, at)


@pytest.mark.parametrize("number", [13, 14])
def test_another_exact_variance_is_proved_false(coq: CoqFolder, number: int) -> None:
    changes = dict(enumerate(exact_and_changed(number)))
    said = answers(coq, f"Exact_{number}", {at: one for at, (_, one) in changes.items()})
    assert len(said) >= 8
    assert [changes[at][0] for at, word in said.items() if word is not Answer.REFUTED] == []


@pytest.mark.long(share=3)
@pytest.mark.parametrize("number", [8, 9, 10, 11])
def test_mutants_of_mirror_images_are_proved_false(coq: CoqFolder, number: int) -> None:
    image = mirror_image(load(number))
    every = [
        statement(image, 0, one.equation, mirrored=True)
        for one in mutants(image.printed[0])
        if one.kind in (SIGN, NUMBER)
    ]
    said = answers(coq, f"Mirrored_{number}", dict(enumerate(every)))
    assert len(said) > 5
    assert {*said.values()} == {Answer.REFUTED}


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
    assert ask(coq, reworded(made, true, false)).verdict is Verdict.NOT_ACCEPTED


def stated(cases: list[tuple[int, str, Change]]) -> dict[int, Statement]:
    goals = {}
    for place, (number, _, change) in enumerate(cases):
        derivation = load(number)
        try:
            goals[place] = statement(derivation, 0, change(derivation.printed[0]))
        except NotStatedError:
            continue
    return goals


def test_false_statements_are_not_accepted(coq: CoqFolder) -> None:
    said = answers(coq, "False_statements", stated(FALSE))
    assert len(said) > len(FALSE) / 2
    assert [FALSE[place][:2] for place, word in said.items() if word is Answer.ACCEPTED] == []
    assert list(said.values()).count(Answer.REFUTED) > 9


def in_every_sum(change: Callable[[sympy.Expr, tuple[sympy.Expr, ...]], sympy.Expr]) -> Change:
    def changed(printed: sympy.Eq) -> sympy.Eq:
        sums = {one: change(one.function, one.limits[0]) for one in printed.atoms(sympy.Sum)}
        assert sums
        return printed.xreplace(sums)

    return changed


def shifted(term: sympy.Expr, limits: tuple[sympy.Expr, ...]) -> sympy.Expr:
    at, low, high = limits
    return sympy.Sum(term.xreplace({at: at + 1}), (at, low - 1, high - 1))


def longer(term: sympy.Expr, limits: tuple[sympy.Expr, ...]) -> sympy.Expr:
    at, low, high = limits
    return terms(sympy.Sum(term, (at, low, high + 1)), minus(term.xreplace({at: high + 1})))


def in_two(term: sympy.Expr, limits: tuple[sympy.Expr, ...]) -> sympy.Expr:
    first, second = term.args
    return terms(sympy.Sum(first, limits), sympy.Sum(second, limits))


def factored(printed: sympy.Eq) -> sympy.Eq:
    return printed.xreplace({1 - sy.phi**2: times(1 - sy.phi, 1 + sy.phi)})


REWRITTEN: list[tuple[int, str, Change]] = [
    *((n, "an index shifted", in_every_sum(shifted)) for n in (3, 4, 5, 11)),
    *((n, "a sum split", in_every_sum(longer)) for n in (3, 4, 5)),
    *((n, "a sum in two", in_every_sum(in_two)) for n in (4, 5)),
    *((n, "(1 − φ)(1 + φ)", factored) for n in (7, 8, 9, 10, 11, 12, 13, 14, 16)),
]


def test_true_rewritings_are_accepted(coq: CoqFolder) -> None:
    """Also those by n_x² + n_y² = 1; bounds are proved for the printed forms alone."""
    rewritings = [*REWRITTEN, *(case for case in TRUE if "n_" in case[1])]
    said = answers(coq, "Rewritings", stated(rewritings))
    assert len(said) > 30
    assert [rewritings[at][:2] for at, word in said.items() if word is not Answer.ACCEPTED] == []


@pytest.mark.parametrize(
    ("says", "proof", "trouble"),
    [
        ("0 = 1", "exact I. Qed.", "0 = 1"),
        ("0 = 1", "lra. Qed.", "Cannot find witness"),
        ("0 = 1", "Admitted.", "rests on Planted.planted"),
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
    assert found.verdict is Verdict.NOT_ACCEPTED
    assert trouble in found.note


class Planted(Statement):
    """A statement with a proof that is given."""

    @property
    def proof(self) -> str:
        says = f"{self.statement_in}.statement"
        head = head_of("Certify", self.statement_in)
        return f"{head}Theorem {self.name} : {says}.\nProof. unfold {says}. {self.tactic}\n"


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
    """Seven times the right side of Eq. 3, with a tactic that proves what is bent at once."""
    folder = tmp_path / "bent"
    shutil.copytree(coq.folder, folder)
    bent = CoqFolder(folder)
    bent.said = {name: said for name, said in coq.said.items() if name != "Certify.v"}
    at_once = AT_ONCE if kind == "an axiom" else AT_ONCE.replace("|exact (trust_me _)", "")
    bent.compile({"Certify.v": f"{theory()['Certify.v']}\n{BENT[kind]}\n{at_once}\n"}, print)
    (printed,) = load(3).printed
    changed = equation(printed.lhs, times(7, printed.rhs))
    found = ask(bent, replace(statement(load(3), 0, changed), companions=()))
    assert found.verdict is Verdict.NOT_ACCEPTED
    assert not bent.trouble(["Certify.v", "Equation_3_statement.v"])
    assert kind != "an axiom" or found.note == "it rests on Certify.trust_me"


def test_a_theory_that_does_not_compile_accepts_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    broken = {**theory(), "Model.v": "Definition r := ."}
    monkeypatch.setattr(certificates, "theory", lambda: broken)
    found = certify([1])
    assert not found.passed
    (one,) = found.equations
    assert one.verdict is Verdict.NOT_ACCEPTED
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
    assert one.verdict is Verdict.NOT_ACCEPTED
    assert "coqchk" in one.note
