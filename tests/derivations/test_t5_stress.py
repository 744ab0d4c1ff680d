"""Statements about the mean stress that say nothing of it somewhere: none is proved."""

import pytest
import sympy
from force_diffusion.derivations.beyond.t5_stress import PRINTED, RATIO, SUBJECTS
from force_diffusion.derivations.framework.loading import load
from force_diffusion.symbolic.symbols import M, j, phi, t

STRESS, SHEAR, TURNED = PRINTED["B10"][0], PRINTED["B18"][0], SUBJECTS["surface"]


@pytest.mark.parametrize(
    ("number", "left", "right"),
    [
        ("B10", RATIO, RATIO),
        ("B10", STRESS.lhs, RATIO - 1),
        ("B10", 0 * RATIO, sympy.Integer(0)),
        ("B10", (2 * j - M) * STRESS.lhs, (2 * j - M) * STRESS.rhs),
        ("B10", phi * STRESS.lhs, phi * STRESS.rhs),
        ("B18", TURNED, TURNED),
        ("B18", (1 - t) * SHEAR.lhs, (1 - t) * SHEAR.rhs),
        ("B18", SHEAR.lhs / (1 - t), SHEAR.rhs / (1 - t)),
        ("B18", SHEAR.lhs**2, SHEAR.rhs**2),
    ],
)
def test_not_proved(number: str, left: sympy.Expr, right: sympy.Expr) -> None:
    ruling = load(number).rule_on(0, sympy.Eq(left, right, evaluate=False))
    assert not ruling.verdict.is_proved, ruling.note


def test_the_same_multiplied_by_what_never_vanishes_is_proved() -> None:
    told = sympy.Eq((1 + t) * SHEAR.lhs, (1 + t) * SHEAR.rhs, evaluate=False)
    assert load("B18").rule_on(0, told).verdict.is_proved
