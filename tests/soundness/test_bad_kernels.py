"""Checkers with a planted fault: attacks, changes of an equation, or other statements notice it."""

from dataclasses import replace
from typing import Any

import pytest
import sympy
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.framework.proving import Line
from force_diffusion.derivations.framework.record import KernelError
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra import affine, signs
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.algebra.linear_forms import LinearForm
from force_diffusion.symbolic.kernel import limits, rules, theorem
from force_diffusion.symbolic.kernel.decisions import proved, refuted

import force_diffusion as fd
from tests.soundness import trial
from tests.soundness.attacks.every import succeeded
from tests.soundness.trial import DERIVED

pytestmark = pytest.mark.usefixtures("nothing_is_remembered")

Plant = pytest.MonkeyPatch


def is_noticed(number: Number) -> bool:
    """Whether one equation, its premises taken as proved, or an attack shows a fault."""
    return trial.is_noticed(replace(load(number), premises=())) or any(succeeded())


@pytest.mark.long(sample=7)
@pytest.mark.parametrize("number", DERIVED)
def test_it_proves_all(monkeypatch: Plant, number: Number) -> None:
    monkeypatch.setattr(Line, "rule_on", lambda *_: proved("of course"))
    assert trial.is_noticed(replace(load(number), premises=()))


def test_what_is_proved_and_explicit_values_refute_is_an_error(monkeypatch: Plant) -> None:
    monkeypatch.setattr(Line, "rule_on", lambda *_: proved("of course"))
    eq = fd.equation(3)
    with pytest.raises(KernelError, match=r"the checker is at fault.*Eq\. 3 .*proved, yet false"):
        eq.decide(2 * eq.rhs)


@pytest.mark.long(sample=7)
@pytest.mark.parametrize("number", DERIVED)
def test_it_refutes_all(monkeypatch: Plant, number: Number) -> None:
    monkeypatch.setattr(Line, "rule_on", lambda *_: refuted("never"))
    assert trial.is_noticed(replace(load(number), premises=()))


# Eq. 2 is solved for, and Eq. 3 read in Cartesian components, of which a change changes both.
@pytest.mark.long(sample=4)
@pytest.mark.parametrize(
    ("fault", "number"),
    [
        *(("any for all", number) for number in (1, 4, 5)),
        *(("a component skipped", number) for number in (1, 2, 4, 5)),
    ],
)
def test_vectors_are_compared_in_part(monkeypatch: Plant, number: int, fault: str) -> None:
    if fault == "any for all":
        for module in (theorem, rules):
            monkeypatch.setattr(module, "all", any, raising=False)
    else:
        whole = theorem.Normal.__call__

        def first_alone(self: theorem.Normal, side: sympy.Expr) -> theorem.Forms:
            return tuple(
                one if place == 0 else LinearForm() for place, one in enumerate(whole(self, side))
            )

        monkeypatch.setattr(theorem.Normal, "__call__", first_alone)
    assert is_noticed(number)


def test_eq_12_keeps_an_order_too_many(monkeypatch: Plant) -> None:
    one_force = limits._one_force

    def larger(*about: Any) -> Any:
        force, factor = one_force(*about)
        return force, factor * FIELD.generator(sy.M)

    monkeypatch.setattr(limits, "_one_force", larger)
    assert is_noticed(12)


@pytest.mark.parametrize("number", [13, 14])
def test_an_order_too_many(monkeypatch: Plant, number: int) -> None:
    """Of what something is to be small against: the printed form holds φ in its divisor alone."""
    order, phi = limits.order, FIELD.position[sy.phi]
    monkeypatch.setattr(
        limits, "order", lambda one, limit: order(one, limit) + (one.numerator.degrees()[phi] == 0)
    )
    assert is_noticed(number)


@pytest.mark.long(sample=17)
@pytest.mark.parametrize("number", DERIVED)
def test_only_one_sign_of_phi(monkeypatch: Plant, number: Number) -> None:
    """Roots are counted for 0 < φ < ½ alone: n_x² is between ¼ and ½ there."""
    whole = signs._on_interval

    def half(polynomial: sympy.Poly, low: sympy.Expr, high: sympy.Expr) -> int:
        return whole(polynomial, low, sympy.Rational(1, 2) if low else high)

    monkeypatch.setattr(signs, "_on_interval", half)
    assert is_noticed(number)


def test_a_base_case_is_dropped(monkeypatch: Plant) -> None:
    whole = rules.induct

    def step_alone(over: sympy.Symbol, start: sympy.Expr, _: rules.Rule, step: Any) -> rules.Rule:
        return whole(over, start, lambda f, where: theorem.made(f, where, "unseen"), step)

    monkeypatch.setattr(rules, "induct", step_alone)
    assert is_noticed(3)


def test_layers_are_dropped_from_an_induction(monkeypatch: Plant) -> None:
    whole = rules.induct

    def from_layer_5(over: sympy.Symbol, start: sympy.Expr, base: Any, step: Any) -> rules.Rule:
        def later(supposed: tuple[theorem.Theorem, ...]) -> rules.Rule:
            return lambda formula, where: step(supposed)(formula, where.also(over >= 5))

        return whole(over, start, base, later)

    monkeypatch.setattr(rules, "induct", from_layer_5)
    assert is_noticed(3)


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("number", [3, 4, 5])
@pytest.mark.parametrize(("low", "high"), [(1, 0), (0, 1), (0, -1)])
def test_a_sum_is_off_by_one(monkeypatch: Plant, number: int, low: int, high: int) -> None:
    whole = LinearForm.summed

    def off(form: LinearForm, index: sympy.Symbol, *ends: affine.Affine) -> LinearForm:
        return whole(form, index, affine.shifted(ends[0], low), affine.shifted(ends[1], high))

    monkeypatch.setattr(LinearForm, "summed", off)
    assert is_noticed(number)


@pytest.mark.long
def test_the_kernel_without_a_plant_is_right() -> None:
    assert not is_noticed(3)
