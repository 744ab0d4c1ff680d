"""Answers are the same from several threads, and after pickling."""

import copy
import pickle
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic import systems
from force_diffusion.numeric.arithmetic.carried import CARRYING
from force_diffusion.numeric.arithmetic.systems import FLOAT64
from hypothesis import given
from hypothesis import strategies as st

import force_diffusion as fd
from tests.numeric.scenes import question

QUANTITIES = ("contact_forces", "profile", "positions", "histogram")


def scene(quantity: str, seed: int = 1, **effects: Any) -> fd.Scene:
    return question(quantity, 4, 8, std=0.01, seed=seed, effects=effects)


@pytest.fixture
def _often() -> Iterator[None]:
    """Let threads take turns as often as they can."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(before)


def answer(number: int) -> Any:
    """Answer one of many questions, each with other bits, and give all of the answer."""
    if number % 7 == 6:  # of packings whose contacts open, beside those that stay on the lattice
        return scene("contact_forces", number, contacts="unilateral").run().decimals()
    digits, certified = (None, 30, 40, 110, 150)[number % 5], bool(number % 2)
    tolerance = None if digits is None else Fraction(1, 10**digits)
    asked = scene(QUANTITIES[number % 4], number)
    outcome = asked.run(tolerance, certified=certified and digits is not None)
    return outcome.decimals(), outcome.accuracy, outcome.decimals()


@pytest.mark.usefixtures("_often")
def test_threads_give_what_one_gives():
    alone = [answer(number) for number in range(20)]
    for threads in (1, 4):
        with ThreadPoolExecutor(threads) as pool:
            assert list(pool.map(answer, range(20))) == alone


@given(
    middle=st.tuples(st.integers(-(2**400), 2**400), st.integers(-9000, 9000)),
    radius=st.tuples(st.integers(0, 2**30 - 1), st.integers(-9000, 9000)),
)
def test_a_ball_comes_back_hardly_wider(middle, radius):
    arb = systems.flint().arb
    ball = arb(arb(middle), arb(radius))
    for again in (pickle.loads(pickle.dumps(ball)), copy.deepcopy(ball)):
        assert again.mid() == ball.mid()
        assert ball.rad() <= again.rad() <= ball.rad() * (1 + arb(2) ** -28)


@pytest.mark.parametrize("system", [FLOAT64, CARRYING])
def test_there_is_one_system_of_doubles(system):
    assert pickle.loads(pickle.dumps(system)) is system
    assert copy.deepcopy(system) is system


RADII = 1 + 0.001 * np.random.default_rng(1).standard_normal((5, 10))


@pytest.mark.parametrize(
    "how", [{}, {"tolerance": "1e-30"}, {"tolerance": "1e-40", "certified": True}]
)
def test_solutions_can_be_pickled(how):
    solution = fd.solve(RADII, **how)
    again = pickle.loads(pickle.dumps(solution))
    assert again.error == solution.error
    assert again.forces.decimals() == solution.forces.decimals()
    assert again.positions.decimals() == solution.positions.decimals()
    assert np.array_equal(again.force.astype(float), solution.force.astype(float))


@pytest.mark.parametrize(
    ("quantity", "effects"),
    [
        *product(QUANTITIES, [{}, {"geometry": "first-order"}, {"geometry": "ordered"}]),
        *product(["contact_forces", "positions"], [{"contacts": "unilateral"}]),
    ],
)
def test_outcomes_can_be_pickled(quantity, effects):
    outcome = scene(quantity, **effects).run()
    assert pickle.loads(pickle.dumps(outcome)).data() == outcome.data()


def test_ensembles_can_be_pickled():
    ensemble = fd.ensemble(scene("profile"), 40)
    assert pickle.loads(pickle.dumps(ensemble)).data() == ensemble.data()
