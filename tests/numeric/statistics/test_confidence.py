"""When an ensemble is sure enough."""

import math
from dataclasses import replace

import pytest
from force_diffusion.numeric.statistics.confidence import half_width, looks
from scipy.special import stdtrit

from tests.numeric.ensemble.cases import case, ensemble_of


@pytest.mark.parametrize(
    ("wrong", "freedom", "meant"),
    [
        # P(|T| > t) in closed form: 1 − 2 atan(t)/π for one degree of freedom,
        # 1 − t/√(2 + t²) for two
        (0.5, 1, 1.0),
        (0.1, 1, math.tan(0.45 * math.pi)),
        (0.01, 2, 0.99 * math.sqrt(2 / (1 - 0.99**2))),
        (1e-9, 2, (1 - 1e-9) * math.sqrt(2 / (1 - (1 - 1e-9) ** 2))),
    ],
)
def test_student(wrong: float, freedom: int, meant: float) -> None:
    found = half_width([1e-6], freedom + 1, 1 - wrong, 0)
    assert math.log1p(found) == pytest.approx(1e-6 * meant, rel=1e-6)


def test_student_becomes_normal_and_needs_two() -> None:
    found = half_width([1.0], 10**8, 1 - 0.31731050786291404, 0)
    assert found == pytest.approx(math.e - 1, rel=1e-6)
    assert half_width([1.0], 1, 0.95, 0) == math.inf
    assert half_width([], 1, 0.95, 0) == 0


def test_looks_are_few_and_their_shares_add_up() -> None:
    found = list(looks(10**9))
    assert found == sorted(set(found))
    assert len(found) < 60
    assert sum(1 / (k * (k + 1)) for k in range(1, len(found) + 1)) < 1


def test_more_looks_and_more_confidence_ask_for_more() -> None:
    found = ensemble_of(m := case("profile"), 40)
    t = stdtrit(39, 1 - 0.05 / m.groups / 2)
    error = max(e / s for e, s in zip(found.std_error, found.std, strict=True) if e)
    # σ (e^2ε − 1)/2 is stated of σ, of whose logarithm ε is the error
    assert math.log1p(found.half_width) == pytest.approx(t * math.log1p(2 * error) / 2)
    first, second = (replace(found, looks=k).half_width for k in (1, 2))
    assert found.half_width < first < second
    assert found.half_width < replace(found, confidence=0.99).half_width
    assert ensemble_of(m, 1).half_width == math.inf


def test_two_packings_tell_not_how_well_the_scatter_of_a_contact_is_known() -> None:
    found = replace(ensemble_of(case("contact of a slab"), 2), until=0.01)
    assert math.isnan(found.std_error[0])
    assert (found.half_width, found.reached) == (math.inf, False)
