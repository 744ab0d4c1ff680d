"""Equations and what is found of them after a journey: the same, and no theorem comes of it."""

import inspect
import pickle
import pydoc
from typing import Any

import numpy as np
import pytest
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.loading import load

import force_diffusion as fd
from tests.derivations.rows import each


def again(thing: Any) -> Any:
    return pickle.loads(pickle.dumps(thing))


@pytest.mark.parametrize("number", each(modules(), share=2))
def test_every_equation(number):
    found = fd.equation(number)
    assert str(again(found)) == str(found)
    assert again(found).latex() == found.latex()
    assert again(load(number)) is load(number)
    for form in map(found.exact, found.forms):
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


def test_a_function_goes_to_other_processes():
    equation = fd.equation(13)
    function = equation.function()
    found = again(function)
    given = {"M": np.array([3, 10]), "z": 0.5, "phi": 0.1, "sigma": 0.01, "r": 1}
    assert np.array_equal(found(**given), function(**given))
    assert inspect.signature(found) == inspect.signature(function)
    assert inspect.getdoc(found) == inspect.getdoc(function)
    assert repr(found) == repr(function)
    assert "0 ≤ z ≤ 1" in pydoc.render_doc(equation.function())
