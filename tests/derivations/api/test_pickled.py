"""Equations and their results after pickling: the same, but no theorem is made by it."""

import pickle
from typing import Any

import pytest
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.record import load

import force_diffusion as fd
from tests.derivations.rows import each


def again(value: Any) -> Any:
    return pickle.loads(pickle.dumps(value))


@pytest.mark.parametrize("number", each(modules()))
def test_every_equation(number):
    equation = fd.equation(number)
    assert str(again(equation)) == str(equation)
    assert again(equation).latex() == equation.latex()
    assert again(load(number)) is load(number)
    for form in map(equation.exact, equation.forms):
        copy = again(form)
        assert (str(copy), copy.latex()) == (str(form), form.latex())


def test_proofs_and_steps():
    equation = fd.equation(2)
    proof = equation.prove()
    assert str(again(proof)) == str(proof)
    assert again(proof).outcomes[-1].derivation is load(2)
    assert str(again(equation.steps())) == str(equation.steps())
    ruling = equation.decide(equation.expr)
    assert again(ruling) == ruling
    form = fd.equation(13).exact()
    assert again(form).decide(form.expr).verdict == "proved"
