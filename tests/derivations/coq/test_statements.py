"""Statements for Coq: what is written for what, without Coq."""

import re
from dataclasses import replace

import pytest
import sympy
from force_diffusion.derivations.coq import statements as coq
from force_diffusion.derivations.coq.files import theory
from force_diffusion.derivations.framework.catalogue import paper
from force_diffusion.derivations.framework.record import load
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel import axioms
from force_diffusion.symbolic.trees import equation

i, j, m = sy.i, sy.j, sy.m


@pytest.mark.parametrize("number", paper())
def test_a_statement_is_read_with_the_words_of_the_model_alone(number):
    for made in coq.statements(load(number)):
        loaded = re.findall(r"^From ForceDiffusion Require.*$", made.statement, re.MULTILINE)
        assert loaded == ["From ForceDiffusion Require Import Roots Model."]
        assert "Import" not in made.acceptance
        assert made.proposition in made.statement
        assert made.proposition not in made.proof


def test_its_hash_covers_all_that_is_written():
    made = coq.statement(load(3), 0)
    changed = (
        replace(made, conclusion="True"), replace(made, tactic="exact I"),
        replace(made, companions=made.companions[:1]),
    )  # fmt: skip
    assert len({made.hash, *(statement.hash for statement in changed)}) == 4


def test_a_statistic_is_the_one_that_is_printed():
    (printed,) = load(13).printed
    other = replace(load(13), printed=(equation(sympy.Symbol("another"), printed.rhs),))
    with pytest.raises(KeyError, match="another"):
        coq.statement(other, 0)


@pytest.mark.parametrize(
    ("loading", "shown"), [(axioms.SURFACE, "surface M f_load"), (axioms.BULK, "bulk f_load")]
)
def test_the_load_is_that_of_the_domain(loading, shown):
    derivation = load(13)
    made = coq.statement(replace(derivation, domain=derivation.domain.loaded(loading)), 0)
    assert f"carries M (Xs rho) ({shown}) (Fs rho)" in made.proposition
    assert f"carries M (Xs rho) ({shown}) (Fs rho)" in made.companions[0].proposition


def test_reversed_bounds_are_asked_about():
    printed = equation(sy.DeltaX(i, j), sympy.Sum(sy.DeltaR(i, m), (m, 3, j)) * sy.b_plus)
    in_order = coq.statement(replace(load(3), printed=(printed,)), 0).companions[-1]
    assert in_order.name == "sums_in_order"
    assert "(3 <= j + 1)%Z" in in_order.proposition


def test_the_theory_declares_no_axiom_and_admits_nothing():
    sources = theory()
    assert "Model.v" in sources
    forbidden = r"\b(Admitted|Axiom|Parameter|Conjecture|admit|Unset|bypass_check)\b"
    for name, source in sources.items():
        assert not re.search(forbidden, source), name
