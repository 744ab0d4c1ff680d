"""What is false is disproved in the kernel, in words that say how."""

import pytest
import sympy
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel.disproofs import other_leading_order
from force_diffusion.symbolic.kernel.limits import asymptotic
from force_diffusion.symbolic.symbols import i, j, k, l, p, phi, q, r, sigma

from tests.soundness.attacks.splitting import AT_CONE, TRUE, disproved


@pytest.mark.parametrize(
    ("right", "says"),
    [
        (j + p, "goes to (j + p + q)/(j + p), not to 1"),
        (2 * l + 5, "goes to 1/2, not to 1"),
        (l**2, "goes as the power -1 of what grows"),
        (sympy.Integer(7), "goes as the power 1 of what grows"),
        (l * (1 + phi), "goes to 1/(φ + 1), not to 1"),
        (l * (1 + phi**2 / 10**9), "not to 1"),
        (l + (k - i), "goes to (j + p + q)/(j + 2 p), not to 1"),
        (l * r / sigma, "goes to σ_δr/r, not to 1"),
        (-l, "goes to -1, not to 1"),
    ],
)
def test_another_leading_order_is_disproved(right: sympy.Expr, says: str) -> None:
    found = disproved(TRUE, right)
    assert says in found.reason
    assert found.reason.endswith("the left-hand side goes as j + p + q")
    assert found.theorem is TRUE


def test_what_is_disproved_is_not_proved_and_the_other_way_round() -> None:
    for right in (l, l - 7, j + p, 2 * q + l, l * (1 + 1 / (j + 1)), l + k - i):
        statement = equation(l + 3, right)
        outcomes = []
        for rule in (asymptotic(), other_leading_order(TRUE)):
            try:
                rule(statement, AT_CONE)
            except ValueError:
                outcomes.append(False)
            else:
                outcomes.append(True)
        assert sum(outcomes) == 1, right
