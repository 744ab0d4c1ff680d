"""Statements for Coq: what is written for what, without Coq."""

import re
from dataclasses import replace

import pytest
import sympy
from force_diffusion.derivations.coq import statements as coq
from force_diffusion.derivations.coq import words
from force_diffusion.derivations.coq.files import theory
from force_diffusion.derivations.coq.packings import packing_statement
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.witnesses.draws import draw
from force_diffusion.numeric.mechanics import taylor
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.search.mutants import mutants

i, j, m = sy.i, sy.j, sy.m


@pytest.mark.parametrize(
    ("expression", "written"),
    [
        (sympy.Integer(-3), "- 3"),
        (sympy.Rational(1, 2), "1 / 2"),
        (terms(sy.M, -j), "IZR M - IZR j"),
        (times(2, terms(1, minus(sy.phi))), "2 * (1 - phi G)"),
        (1 / (1 - sy.phi**2), "1 / (1 - phi G ^ 2)"),
        (minus(times(sy.r, sy.DeltaR(i + 1, j - 1))), "- (r G * delta_r rho (i + 1) (j - 1) e)"),
        (sympy.Sum(sy.DeltaR(i - j + m, m), (m, 1, j - 1)),
         "Sum 1 (j - 1) (fun m => delta_r rho (i - j + m) m e)"),
        (sy.Dot(sy.n_minus, terms(sy.DeltaNPlus(i, j), minus(sy.DeltaNPlus(i, 2 * j)))),
         "dot (n_minus G) (minus (delta_n_plus G X i j e) (delta_n_plus G X i (2 * j) e))"),
    ],
)  # fmt: skip
def test_numbers_are_written_as_they_stand(expression: sympy.Expr, written: str) -> None:
    assert words.real(expression) == written


def test_powers_are_written_with_roots() -> None:
    assert words.real(sy.M ** sympy.Rational(3, 2)) == "root 2 (IZR M) ^ 3"
    assert words.real(sy.sigma ** sympy.Rational(-2, 3)) == "/ root 3 sigma ^ 2"


def test_vectors_are_written_as_they_stand() -> None:
    weighed = times(terms(sy.DeltaR(i, j), 1), sy.b_plus)
    assert words.vector(weighed) == "scale (delta_r rho i j e + 1) (b_plus G)"
    assert words.vector(terms(sy.b_plus, minus(sy.n_plus))) == "minus (b_plus G) (n_plus G)"
    assert words.vector(sympy.Integer(0)) == "zero"


@pytest.mark.parametrize(
    "expression",
    [sympy.sin(sy.phi), sympy.Symbol("phi"), sy.DeltaR(i * j, j), sy.DeltaR(i / 2, j), sy.z**i],
)
def test_what_there_are_no_words_for_is_not_stated(expression: sympy.Expr) -> None:
    with pytest.raises(words.NotStatedError):
        words.real(expression)


def test_ranges_are_those_of_the_domain() -> None:
    assert list(coq.ranges(load(1))) == ["(j >= 0)%Z"]
    assert list(coq.ranges(load(3))) == ["(j >= 1)%Z"]
    at_entry = ["(- i + k = - j + l)%Z", "(- j + l >= 1)%Z", "(j >= 0)%Z"]
    assert list(coq.ranges(load(9))) == at_entry
    turned = "(2 * n = i - j - k + l)%Z"
    assert list(coq.ranges(load(10))) == ["(n >= 1)%Z", "(n < - j + l)%Z", turned, "(j >= 0)%Z"]
    assert list(coq.ranges(load(11))) == ["(j >= 0)%Z", "(j < M)%Z"]


def test_asymptotic_ones_are_stated_of_every_contact() -> None:
    assert list(coq.ranges(load(12))) == []
    for number in (13, 14):
        made = coq.statement(load(number), 0)
        assert made.about == ("contact M i j", "(0 <= j)%Z", "(j < M)%Z")
        assert all(words in "".join(made.hypotheses) for words in made.about)


def test_words_in_an_assumption_change_no_range() -> None:
    reworded = replace(load(11), assumptions=("0 ≤ j < 1",))
    assert coq.statement(reworded, 0) == coq.statement(load(11), 0)


def test_without_a_domain_nothing_is_stated() -> None:
    with pytest.raises(words.NotStatedError, match="no domain"):
        coq.statement(replace(load(11), where=None), 0)


def test_a_statement_is_read_with_the_words_of_the_model_alone() -> None:
    for number in coq.STATED:
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
        replace(made, theory="Fractions"), replace(made, companions=made.companions[:1]),
    )  # fmt: skip
    assert len({made.hash, *(one.hash for one in changed)}) == 5


def test_ranges_are_the_relations_of_a_domain() -> None:
    steps = ["(p >= 1)%Z", "(q >= 1)%Z"]
    assert list(coq.ranges(load(16))) == [*steps, "(k = i + p - q)%Z", "(l = j + p + q)%Z"]


@pytest.mark.long(sample=2)
@pytest.mark.parametrize("number", coq.STATED)
def test_a_change_changes_the_statement_and_not_its_hypotheses(number: int) -> None:
    derivation = load(number)
    for part, printed in enumerate(derivation.printed):
        true = coq.statement(derivation, part)
        for mutant in mutants(printed):
            try:
                other = coq.statement(derivation, part, mutant.equation)
            except words.NotStatedError:
                continue
            assert other.proposition != true.proposition
            assert other.hypotheses == true.hypotheses


def test_a_statistic_is_the_one_that_is_printed() -> None:
    printed = load(13).printed[0]
    other = equation(sympy.Symbol("another"), printed.rhs)
    with pytest.raises(words.NotStatedError, match="another"):
        coq.statement(load(13), 0, other)


@pytest.mark.parametrize(
    ("load_of", "words"), [("surface", "surface M f_load"), ("bulk", "bulk f_load")]
)
def test_the_load_is_the_one_that_the_derivation_names(load_of: str, words: str) -> None:
    made = coq.statement(replace(load(13), loads=(load_of,)), 0)
    assert f"carries M (Xs rho) ({words}) (Fs rho)" in made.proposition
    assert f"({words.replace('M', '1000000%Z').replace('f_load', '5')})" in made.companions[0].proof


def test_the_mirror_image_of_a_bead_is_entered_by_the_other_force() -> None:
    made = {one.name: one.proposition for one in coq.statements(load(8))}
    entered = "near (fun e => f_{} F site_r site_s e = 0 /\\ f_{} F site_r site_s e <> 0)"
    assert entered.format("minus", "plus") in made["equation_8_part_1"]
    assert entered.format("plus", "minus") in made["equation_8_part_1_mirrored"]


def test_a_force_is_divided_by_a_load_that_is_positive() -> None:
    for part, (positive, other) in enumerate((("plus", "minus"), ("minus", "plus"))):
        made = coq.statement(load("B1"), part)
        assert f"  0 < L_{positive} ->" in made.hypotheses
        assert f"0 < L_{other}" not in made.proposition
        assert "L_minus = t * L_plus" in made.proposition


def test_of_the_other_branch_the_inverse_ratio_is_stated() -> None:
    forms = {one.name: one.conclusion for one in coq.statements(load("B2"))}
    of_plus, of_minus = (forms[f"equation_B2_part_{part}_exact"] for part in (1, 2))
    assert "f_plus F i j e) f" in of_plus
    assert "expect L f = L_plus" in of_plus
    assert "f_minus F i j e) f" in of_minus
    assert "expect L f = L_minus" in of_minus
    assert "12 * IZR M * (IZR j ^ 2) * (t ^ 2)" in of_plus
    assert "12 * IZR M * (IZR j ^ 2) / t ^ 2" in of_minus


def test_two_contacts_of_one_diagonal_are_stated_on_its_domain() -> None:
    made = coq.statement(load("B12"), 0)
    assert {"(j >= 2)%Z", "(j <= l - 2)%Z", "(l <= M - 2)%Z"} < set(made.about)
    assert "f_plus F (i - j + l) l e) g" in made.conclusion
    assert "(Z.abs i + 2 * M + 2 <= W)%Z" in made.proposition


def test_a_change_of_the_ranges_changes_the_statement() -> None:
    narrower = replace(load(11), where=Where.of(sy.j >= 0, sy.j < sy.M - 1))
    assert "(j < M - 1)%Z" in coq.statement(narrower, 0).proposition
    assert "(j < M - 1)%Z" not in coq.statement(load(11), 0).proposition


def test_all_that_is_supposed_is_shown_to_be_possible() -> None:
    for number in coq.STATED:
        for made in coq.statements(load(number)):
            for line in made.hypotheses:
                if line.endswith(" ->") and "forall" not in line.split("(")[0]:
                    supposed = line.strip().removesuffix(" ->")
                    assert any(supposed in one.proposition for one in made.companions)


def test_reversed_bounds_are_asked_about() -> None:
    printed = equation(sy.DeltaX(i, j), sympy.Sum(sy.DeltaR(i, m), (m, 3, j)) * sy.b_plus)
    in_order = coq.statement(load(3), 0, printed).companions[-1]
    assert in_order.name == "sums_in_order"
    assert "(3 <= j + 1)%Z" in in_order.proposition


def test_the_theory_declares_no_axiom_and_admits_nothing() -> None:
    sources = theory()
    assert "Model.v" in sources
    forbidden = r"\b(Admitted|Axiom|Parameter|Conjecture|admit|Unset|bypass_check)\b"
    for name, source in sources.items():
        assert not re.search(forbidden, source), name


def test_fractions_of_a_packing_are_stated() -> None:
    made = packing_statement(20021)
    packing = draw(20021)
    solved = taylor.solve(
        packing.width, packing.height, n=packing.n, rho=packing.rho, loads=packing.surface_load()
    )
    i, j = packing.contacts[0]
    order_0, order_1 = solved.force(i, j, "+")
    stated = re.search(rf"expands \(f_plus F {i} {j}\) \((.*?)\) \((.*?)\)[ )]", made.conclusion)
    assert stated
    assert (sympy.Rational(stated[1]), abs(sympy.Rational(stated[2].strip("-( ")))) == (
        order_0,
        abs(order_1),
    )
