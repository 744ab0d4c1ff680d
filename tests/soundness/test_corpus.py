"""The corpus: how much there is of it, of how many kinds, and what single rules make."""

import pytest
import sympy
from force_diffusion.derivations.framework.loading import load
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import equation, in_place
from force_diffusion.symbolic.search.counterexample import counterexample

from tests.properties.mutants import mutants
from tests.soundness.corpus import statements
from tests.soundness.sources import Source
from tests.soundness.trial import DERIVED, source_of
from tests.soundness.variations import larger_domains

AT_LEAST: dict[int | str, tuple[int, int, int]] = {
    1: (18, 231, 17), 2: (64, 232, 17), 3: (58, 290, 20), 4: (64, 264, 20),
    5: (64, 264, 20), 6: (40, 220, 17), 7: (70, 414, 15), 8: (69, 400, 15),
    9: (37, 221, 15), 10: (32, 226, 15), 11: (64, 292, 18), 12: (35, 334, 18),
    13: (22, 294, 16), 14: (22, 294, 16), 15: (8, 410, 13), 16: (13, 289, 15),
    "B1": (134, 576, 17),
}  # fmt: skip
"""Mutants, statements and kinds of statements of each equation: they may grow, and never fall."""


@pytest.mark.long(sample=14)
@pytest.mark.parametrize("number", DERIVED)
def test_mutants_and_statements_do_not_fall(number: int | str) -> None:
    derivation, found, kinds = load(number), 0, set()
    for part in range(len(derivation.printed)):
        for one in statements(source_of(derivation, part)):
            found += 1
            kinds.add((one.holds, one.kind))
    changes = sum(1 for printed in derivation.printed for _ in mutants(printed))
    least = AT_LEAST[number]
    assert changes >= least[0]
    assert found >= least[1]
    assert len(kinds) >= least[2]


@pytest.mark.long(sample=17)
@pytest.mark.parametrize("number", DERIVED)
def test_every_statement_says_why(number: int | str) -> None:
    derivation = load(number)
    for part in range(len(derivation.printed)):
        for one in statements(source_of(derivation, part)):
            assert one.reason
            assert isinstance(one.equation, sympy.Eq)
            same = one.equation == derivation.printed[part] and one.where is None
            assert one.holds or not same, one


def test_a_radius_too_much_is_one_of_a_bead_that_the_equation_names() -> None:
    for number in DERIVED:
        derivation = load(number)
        for part in range(len(derivation.printed)):
            source = source_of(derivation, part)
            for radius in source.radii():
                assert radius.free_symbols <= source.free, number


def test_the_larger_domain_of_a_limit_is_none() -> None:
    source = source_of(load(13), 0)
    assert source.where is not None
    assert source.where.limit is not None
    assert list(larger_domains(source)) == []


def test_a_larger_domain_on_which_it_still_holds_is_none() -> None:
    """δr = δr from layer 3 on: it holds in layer 2 as well."""
    from force_diffusion.symbolic.kernel.where import Where

    here = sy.DeltaR(sy.i, sy.j)
    for relation, expected in ((sy.j >= 3, 0), (sy.j >= 0, 1)):
        source = Source(equation(here, here), "=", where=Where.of(relation))
        assert len(list(larger_domains(source))) == expected


def test_statements_made_by_the_new_rules_are_as_false_as_they_say() -> None:
    """An explicit packing shows it of Eq. 3, where the kernel is not asked."""
    source = source_of(load(3), 0)
    assert source.where is not None
    shown = 0
    for one in statements(source):
        if not one.holds and one.kind in ("a factor in an index", "another definition"):
            shown += counterexample(one.equation, source.where, at_most=12) is not None
    assert shown >= 8


def test_what_is_in_place_leaves_divisors_as_they_are() -> None:
    zero = sympy.Mul(sy.phi, sympy.Pow(sy.phi, -1), sy.spacing, evaluate=False)
    image = {sy.spacing: 4 * sy.r * sy.n_x}
    assert not zero.xreplace(image).has(sy.phi)  # what SymPy does
    kept = in_place(zero, image)
    assert kept.has(sympy.Pow(sy.phi, -1))
    assert not kept.has(sy.spacing)
    assert in_place(zero, {sy.z: sy.r}) is zero
    both = in_place(equation(zero, sy.spacing), image)
    assert isinstance(both, sympy.Eq)
    assert both.rhs == 4 * sy.r * sy.n_x
    radius = in_place(sy.DeltaR(sy.i, sy.j), {sy.DeltaR: lambda across, layer: across * layer})
    assert radius == sy.i * sy.j
