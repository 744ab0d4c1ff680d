"""Checkers with a planted fault in what they read: statements of known truth notice it."""

from dataclasses import replace

import pytest
import sympy
from force_diffusion.derivations.framework import record
from force_diffusion.derivations.framework.loading import load
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel import language, rules, theorem
from force_diffusion.symbolic.kernel.decisions import proved
from force_diffusion.symbolic.kernel.theorem import NotProvedError
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.mechanics import lattice

from tests.soundness import trial
from tests.soundness.attacks.every import succeeded
from tests.soundness.trial import source_of
from tests.soundness.variations import larger_domains

pytestmark = pytest.mark.usefixtures("nothing_is_remembered")

Plant = pytest.MonkeyPatch


def is_noticed(number: int | str) -> bool:
    """Whether trying one equation, its premises taken as proved, shows that something is wrong.

    Its lines are made anew, as a theorem is proved once in a process.
    """
    return trial.is_noticed(replace(load(number), premises=()))


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("number", [3, 6, 11, 13, 15])
def test_without_a_plant_nothing_is_noticed(number: int) -> None:
    assert not is_noticed(number)


@pytest.mark.long(sample=2)
@pytest.mark.parametrize("number", range(1, 17))
def test_what_is_put_in_cancels_zero_over_zero(monkeypatch: Plant, number: int) -> None:
    monkeypatch.setattr(language, "in_place", lambda side, image: side.xreplace(image))
    assert is_noticed(number)


@pytest.mark.long(sample=4)
@pytest.mark.parametrize("number", [1, 2, 3, 4, 5, 6])
def test_any_component_will_do(monkeypatch: Plant, number: int) -> None:
    monkeypatch.setattr(record, "_component", lambda *_: proved("a component"))
    assert is_noticed(number)


# of Eq. 3 the induction's step mixes both components
@pytest.mark.parametrize("number", [1, 2, 4, 5, 6])
def test_one_component_is_unread(monkeypatch: Plant, number: int) -> None:
    whole = theorem.Normal.__call__
    zero = theorem.LinearForm()

    def first_alone(self: theorem.Normal, side: sympy.Expr) -> theorem.Forms:
        return tuple(one if place == 0 else zero for place, one in enumerate(whole(self, side)))

    monkeypatch.setattr(theorem.Normal, "__call__", first_alone)
    assert is_noticed(number)


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("number", [3, 4, 5, 11])
def test_bounds_are_unchecked(monkeypatch: Plant, number: int) -> None:
    monkeypatch.setattr(Where, "nonnegative", lambda *_: True)
    assert is_noticed(number)


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("number", range(1, 12))
def test_divisors_are_unchecked(monkeypatch: Plant, number: int) -> None:
    monkeypatch.setattr(theorem, "_check_power", lambda *_: None)
    monkeypatch.setattr(Where, "never_zero", lambda *_: True)
    assert is_noticed(number)


# elsewhere the divisor that a factor becomes is refused as well
@pytest.mark.long(sample=2)
@pytest.mark.parametrize("number", [1, 3, 4, 5, 6])
def test_a_statement_may_say_nothing_somewhere(monkeypatch: Plant, number: int) -> None:
    monkeypatch.setattr(record, "fixes_it", lambda *_: "")
    monkeypatch.setattr(theorem, "fixes", lambda *_: True)
    monkeypatch.setattr(theorem.Normal, "never_zero", lambda *_: True)
    assert is_noticed(number)


def test_an_index_that_is_free_and_summed_over_is_attacked(monkeypatch: Plant) -> None:
    whole = theorem._check
    monkeypatch.setattr(theorem, "_check", lambda node, where, _: whole(node, where, frozenset()))
    assert "an index summed over and free" in {one.tried for one in succeeded()}


@pytest.mark.parametrize("number", [1, 2, 3, 4, 5, 6, 9, 10, 11])
def test_larger_domains_are_refused_one_by_one(number: int) -> None:
    """Each end of a domain, one layer further: not proved, and the corpus says why."""
    source = source_of(load(number), 0)
    assert source.where is not None
    made = list(larger_domains(source))
    ends = [one for one in source.where.relations if not isinstance(one, sympy.Eq)]
    assert len(made) == len(ends) > 0
    for _, where in made:
        assert not load(number).rule_on(0, source.printed, where).verdict.is_proved


def mirrored_wrongly(monkeypatch: Plant, fault: str) -> None:
    if fault == "places stay":
        monkeypatch.setattr(lattice, "mirrored_place", lambda across, layer: (across, layer))
    elif fault == "directions stay":
        monkeypatch.setattr(lattice, "MIRRORED_SYMBOLS", {})
    else:
        monkeypatch.setattr(lattice, "MIRRORED_FUNCTIONS", {})


@pytest.mark.parametrize("fault", ["places stay", "directions stay", "contacts stay"])
def test_a_mirror_that_leaves_something_as_it_is(monkeypatch: Plant, fault: str) -> None:
    mirrored_wrongly(monkeypatch, fault)
    source = load(4)
    mirrored = rules.mirror(source.theorems[0])
    statement = load(5).printed[0]
    with pytest.raises(ValueError, match=r".+"):
        rules.follows(mirrored)(statement, load(5).where)


SUM = sympy.Sum(sy.m, (sy.m, 1, sy.n))


@pytest.mark.parametrize("more", [1, sy.M, sympy.Rational(1, 10**6), -1])
def test_a_certificate_starts_at_zero(more: sympy.Expr) -> None:
    right, where = sy.n * (sy.n + 1) / 2, Where.of(sy.n >= 0, indices=(sy.M,))
    assert rules.rewrite()(equation(SUM, right), where).rule == "rewrite"
    with pytest.raises(NotProvedError, match="differ"):
        rules.rewrite()(equation(SUM, right + more), where)
