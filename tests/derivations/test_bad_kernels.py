"""Checkers with a planted fault: ``derive`` itself must end with a status that is not 0."""

import re
from collections.abc import Callable, Iterator
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
import sympy
from force_diffusion.derivations.framework import runner
from force_diffusion.derivations.framework.catalogue import Number, modules
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.framework.proving import Line
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra import affine, signs
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.algebra.linear_forms import LinearForm
from force_diffusion.symbolic.algebra.reading import read_with
from force_diffusion.symbolic.kernel import decisions, limits, moments, rules, theorem
from force_diffusion.symbolic.kernel.decisions import proved, refuted

from force_diffusion.__main__ import main

FAULT = "force-diffusion: the checker is at fault"
Plant = pytest.MonkeyPatch


@pytest.fixture(autouse=True)
def _nothing_is_remembered() -> Iterator[None]:
    remembering = (
        signs.sign,
        read_with,
        moments.value,
        moments.worked_out,
        moments.in_the_radii,
        moments._between,
        theorem._instance_of,
    )
    for one in remembering:
        one.cache_clear()
    yield
    for one in remembering:
        one.cache_clear()


@pytest.fixture
def derive(monkeypatch: Plant, capsys: pytest.CaptureFixture[str]) -> Callable[..., Any]:
    """Derive one equation through the command, its premises taken as proved."""

    def command(number: Number, *arguments: str, **planted: Any) -> tuple[int, str, str]:
        table = {number: replace(load(number), premises=(), **planted)}
        for module in ("commands.deriving", "api.derived"):
            monkeypatch.setattr(f"force_diffusion.derivations.{module}.load", table.__getitem__)
        status = main(["derive", str(number), *arguments])
        printed = capsys.readouterr()
        return status, printed.out, printed.err

    return command


def in_all_derivations(monkeypatch: Plant, name: str, planted: object) -> None:
    """Put a function of the kernel's in place of the true one, wherever it has been imported."""
    monkeypatch.setattr(decisions, name, planted)
    for stem in modules().values():
        module = import_module(f"force_diffusion.derivations.{stem}")
        if hasattr(module, name):
            monkeypatch.setattr(module, name, planted)


@pytest.mark.long(sample=7)
@pytest.mark.parametrize("number", modules())
def test_it_proves_all(derive: Callable[..., Any], monkeypatch: Plant, number: Number) -> None:
    monkeypatch.setattr(runner, "attacked", lambda: None)  # they are not fooled
    monkeypatch.setattr(Line, "rule_on", lambda *_: proved("of course"))
    status, _, said = derive(number)
    assert status == 1
    assert said.startswith(FAULT)


@pytest.mark.long(sample=7)
@pytest.mark.parametrize("number", modules())
def test_it_refutes_all(derive: Callable[..., Any], monkeypatch: Plant, number: Number) -> None:
    monkeypatch.setattr(runner, "attacked", lambda: None)
    monkeypatch.setattr(Line, "rule_on", lambda *_: refuted("never"))
    status, printed, said = derive(number)
    assert status == 1
    assert said.startswith(FAULT) or re.search(r"^1 (refuted|undecided)\b", printed, re.MULTILINE)


def test_nothing_is_written_by_a_checker_at_fault(
    derive: Callable[..., Any], monkeypatch: Plant, tmp_path: Path
) -> None:
    folder = tmp_path / "out"
    monkeypatch.setattr(Line, "rule_on", lambda *_: proved("of course"))
    status, _, said = derive(3, "--out", str(folder))
    assert status == 1
    assert said.startswith(FAULT)
    assert not folder.exists() or not list(folder.iterdir())


# Eq. 2 is solved for, and Eq. 3 read in Cartesian components, of which a change changes both.
@pytest.mark.long(sample=4)
@pytest.mark.parametrize(
    ("fault", "number"),
    [
        *(("any for all", number) for number in (1, 4, 5)),
        *(("a component skipped", number) for number in (1, 2, 4, 5)),
    ],
)
def test_vectors_are_compared_in_part(
    derive: Callable[..., Any], monkeypatch: Plant, number: int, fault: str
) -> None:
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
    status, printed, said = derive(number)
    assert status == 1
    assert said.startswith(FAULT) or "1 undecided." in printed


def test_eq_12_keeps_an_order_too_many(derive: Callable[..., Any], monkeypatch: Plant) -> None:
    one_force = limits._one_force

    def larger(*about: Any) -> Any:
        force, factor = one_force(*about)
        return force, factor * FIELD.generator(sy.M)

    monkeypatch.setattr(limits, "_one_force", larger)
    status, _, said = derive(12)
    assert status == 1
    assert said.startswith(FAULT)


@pytest.mark.parametrize("number", [13, 14])
def test_an_order_too_many(derive: Callable[..., Any], monkeypatch: Plant, number: int) -> None:
    """Of what something is to be small against: the printed form holds φ in its divisor alone."""
    order, phi = limits.order, FIELD.position[sy.phi]
    monkeypatch.setattr(
        limits, "order", lambda one, limit: order(one, limit) + (one.numerator.degrees()[phi] == 0)
    )
    status, _, said = derive(number)
    assert status == 1
    assert said.startswith(FAULT)


@pytest.mark.long(sample=17)
@pytest.mark.parametrize("number", modules())
def test_only_one_sign_of_phi(
    derive: Callable[..., Any], monkeypatch: Plant, number: Number
) -> None:
    """Roots are counted for 0 < φ < ½ alone: n_x² is between ¼ and ½ there."""
    whole = signs._on_interval

    def half(polynomial: sympy.Poly, low: sympy.Expr, high: sympy.Expr) -> int:
        return whole(polynomial, low, sympy.Rational(1, 2) if low else high)

    monkeypatch.setattr(signs, "_on_interval", half)
    status, _, said = derive(number)
    assert status == 1
    assert said.startswith(FAULT)


def test_a_base_case_is_dropped(derive: Callable[..., Any], monkeypatch: Plant) -> None:
    whole = rules.induct

    def step_alone(over: sympy.Symbol, start: sympy.Expr, _: rules.Rule, step: Any) -> rules.Rule:
        return whole(over, start, lambda f, where: theorem.made(f, where, "unseen"), step)

    monkeypatch.setattr(rules, "induct", step_alone)
    status, _, said = derive(3)
    assert status == 1
    assert said.startswith(FAULT)


def test_layers_are_dropped_from_an_induction(
    derive: Callable[..., Any], monkeypatch: Plant
) -> None:
    whole = rules.induct

    def from_layer_5(over: sympy.Symbol, start: sympy.Expr, base: Any, step: Any) -> rules.Rule:
        def later(supposed: tuple[theorem.Theorem, ...]) -> rules.Rule:
            return lambda formula, where: step(supposed)(formula, where.also(over >= 5))

        return whole(over, start, base, later)

    monkeypatch.setattr(rules, "induct", from_layer_5)
    status, _, said = derive(3)
    assert status == 1
    assert said.startswith(FAULT)


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("number", [3, 4, 5])
@pytest.mark.parametrize(("low", "high"), [(1, 0), (0, 1), (0, -1)])
def test_a_sum_is_off_by_one(
    derive: Callable[..., Any], monkeypatch: Plant, number: int, low: int, high: int
) -> None:
    whole = LinearForm.summed

    def off(form: LinearForm, index: sympy.Symbol, *ends: affine.Affine) -> LinearForm:
        return whole(form, index, affine.shifted(ends[0], low), affine.shifted(ends[1], high))

    monkeypatch.setattr(LinearForm, "summed", off)
    status, printed, said = derive(number)
    assert status == 1
    assert said.startswith(FAULT) or "undecided" in printed


@pytest.mark.long
def test_the_kernel_without_a_plant_is_right(derive: Callable[..., Any]) -> None:
    assert derive(3)[0] == 0
