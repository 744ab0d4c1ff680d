"""Statements for Coq: what is written for what, without Coq."""

import re
from dataclasses import replace

import pytest
import sympy
from force_diffusion.derivations.coq import statements as coq
from force_diffusion.derivations.coq import words
from force_diffusion.derivations.coq.files import theory
from force_diffusion.derivations.framework.catalogue import paper
from force_diffusion.derivations.framework.loading import load
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import minus, terms, times
from force_diffusion.symbolic.kernel.domain import Domain
from force_diffusion.symbolic.trees import equation

i, j, m = sy.i, sy.j, sy.m


@pytest.mark.parametrize(
    ("expression", "written"),
    [
        (sympy.Integer(-3), "-3"),
        (sympy.Rational(1, 2), "1/2"),
        (terms(sy.M, -j), "IZR M - IZR j"),
        (times(2, terms(1, minus(sy.phi))), "2*(1 - phi G)"),
        (1 / (1 - sy.phi**2), "1/(1 - phi G ^ 2)"),
        (minus(sy.phi) ** 2, "phi G ^ 2"),
        (sympy.Pow(-sy.phi, 2, evaluate=False), "(-phi G) ^ 2"),
        (terms(1, minus(terms(sy.phi, sy.sigma))), "1 - (phi G + sigma)"),
        (sy.sigma / (sy.phi * sy.r), "sigma/(phi G*r G)"),
        (minus(times(sy.r, sy.DeltaR(i + 1, j - 1))), "-r G*delta_r rho (i + 1) (j - 1) e"),
        (sympy.Sum(sy.DeltaR(i - j + m, m), (m, 1, j - 1)),
         "Sum 1 (j - 1) (fun m => delta_r rho (i - j + m) m e)"),
        (sy.Dot(sy.n_minus, terms(sy.DeltaNPlus(i, j), minus(sy.n_plus))),
         "dot (n_minus G) (add (delta_n_plus G X i j e) (scale (-1) (n_plus G)))"),
        (sy.DeltaNPlus(i, 2 * j), "delta_n_plus G X i (2*j) e"),
        (sy.M ** sympy.Rational(3, 2), "root 2 (IZR M) ^ 3"),
        (sy.sigma ** sympy.Rational(-2, 3), "1/root 3 sigma ^ 2"),
        (times(terms(sy.DeltaR(i, j), 1), sy.b_plus), "scale (delta_r rho i j e + 1) (b_plus G)"),
        (terms(sy.b_plus, minus(sy.n_plus)), "add (b_plus G) (scale (-1) (n_plus G))"),
    ],
)  # fmt: skip
def test_expressions_are_written_as_they_stand(expression: sympy.Expr, written: str) -> None:
    assert words.words(expression) == written


def test_ranges_are_those_of_the_domain() -> None:
    def about(number: int) -> tuple[str, ...]:
        return coq.statement(load(number), 0).about

    assert about(1) == ("bead M i j", "(j >= 0)%Z")
    assert about(3) == ("bead M i j", "(j >= 1)%Z")
    assert about(9)[2:] == ("(-i + k = -j + l)%Z", "(-j + l >= 1)%Z", "(j >= 0)%Z")
    turned = "(2*n = i - j - k + l)%Z"
    assert about(10)[2:] == ("(n >= 1)%Z", "(n < -j + l)%Z", turned, "(j >= 0)%Z")
    assert about(11)[1:] == ("(j >= 0)%Z", "(j < M)%Z")
    steps = ("(p >= 1)%Z", "(q >= 1)%Z")
    assert about(16)[:4] == (*steps, "(k = i + p - q)%Z", "(l = j + p + q)%Z")


def test_asymptotic_ones_are_stated_of_every_contact() -> None:
    assert coq.statement(load(12), 0).about == ("contact M i j",)
    for number in (13, 14):
        made = coq.statement(load(number), 0)
        assert made.about == ("contact M i j", "(0 <= j)%Z", "(j < M)%Z")
        assert all(one in "".join(made.hypotheses) for one in made.about)


def test_words_in_an_assumption_change_no_range() -> None:
    reworded = replace(load(11), assumptions=("0 ≤ j < 1",))
    assert coq.statement(reworded, 0) == coq.statement(load(11), 0)


@pytest.mark.parametrize("number", paper())
def test_a_statement_is_read_with_the_words_of_the_model_alone(number: int) -> None:
    for made in coq.statements(load(number)):
        loaded = re.findall(r"^From ForceDiffusion Require.*$", made.stated, re.MULTILINE)
        assert loaded == ["From ForceDiffusion Require Import Roots Model."]
        assert "Import" not in made.acceptance
        assert made.proposition in made.stated
        assert made.proposition not in made.proof


def test_its_hash_covers_all_that_is_written() -> None:
    made = coq.statement(load(3), 0)
    changed = (
        replace(made, conclusion="True"), replace(made, tactic="exact I"),
        replace(made, companions=made.companions[:1]),
    )  # fmt: skip
    assert len({made.hash, *(one.hash for one in changed)}) == 4


def test_a_statistic_is_the_one_that_is_printed() -> None:
    (printed,) = load(13).printed
    other = replace(load(13), printed=(equation(sympy.Symbol("another"), printed.rhs),))
    with pytest.raises(KeyError, match="another"):
        coq.statement(other, 0)


@pytest.mark.parametrize(
    ("load_of", "shown"), [("surface", "surface M f_load"), ("bulk", "bulk f_load")]
)
def test_the_load_is_the_one_that_the_derivation_names(load_of: str, shown: str) -> None:
    made = coq.statement(replace(load(13), loads=(load_of,)), 0)
    assert f"carries M (Xs rho) ({shown}) (Fs rho)" in made.proposition
    assert f"carries M (Xs rho) ({shown}) (Fs rho)" in made.companions[0].proposition


def test_the_mirror_image_of_a_bead_is_entered_by_the_other_force() -> None:
    made = {one.name: one.proposition for one in coq.statements(load(8))}
    entered = "near (fun e => f_{} F site_r site_s e = 0 /\\ f_{} F site_r site_s e <> 0)"
    assert entered.format("minus", "plus") in made["equation_8_part_1"]
    assert entered.format("plus", "minus") in made["equation_8_part_1_mirrored"]


def test_a_change_of_the_ranges_or_the_formula_changes_the_statement() -> None:
    narrower = replace(load(11), domain=Domain.of(sy.j >= 0, sy.j < sy.M - 1))
    assert "(j < M - 1)%Z" in coq.statement(narrower, 0).proposition
    assert "(j < M - 1)%Z" not in coq.statement(load(11), 0).proposition
    (printed,) = load(11).printed
    other = replace(load(11), printed=(equation(printed.lhs, times(2, printed.rhs)),))
    assert coq.statement(other, 0).conclusion != coq.statement(load(11), 0).conclusion
    assert coq.statement(other, 0).hypotheses == coq.statement(load(11), 0).hypotheses


@pytest.mark.parametrize("number", paper())
def test_all_that_is_supposed_is_shown_to_be_possible(number: int) -> None:
    for made in coq.statements(load(number)):
        for line in made.hypotheses:
            if line.endswith(" ->") and "forall" not in line.split("(")[0]:
                supposed = line.strip().removesuffix(" ->")
                assert any(supposed in one.proposition for one in made.companions)


def test_reversed_bounds_are_asked_about() -> None:
    printed = equation(sy.DeltaX(i, j), sympy.Sum(sy.DeltaR(i, m), (m, 3, j)) * sy.b_plus)
    in_order = coq.statement(replace(load(3), printed=(printed,)), 0).companions[-1]
    assert in_order.name == "sums_in_order"
    assert "(3 <= j + 1)%Z" in in_order.proposition


def test_the_theory_declares_no_axiom_and_admits_nothing() -> None:
    sources = theory()
    assert "Model.v" in sources
    forbidden = r"\b(Admitted|Axiom|Parameter|Conjecture|admit|Unset|bypass_check)\b"
    for name, source in sources.items():
        assert not re.search(forbidden, source), name
