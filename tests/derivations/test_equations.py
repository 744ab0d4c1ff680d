"""Every printed equation: proved, and felt when it is wrong."""

import ast
from pathlib import Path

import pytest
import sympy
from force_diffusion.derivations import eq06_force_balance
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.framework.record import Derivation, Statement
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel import axioms
from force_diffusion.symbolic.kernel.decisions import Verdict
from force_diffusion.symbolic.kernel.theorem import made

ALL = [load(number) for number in modules()]

every_equation = pytest.mark.parametrize("derivation", ALL, ids=lambda d: f"eq{d.number:02}")


@every_equation
def test_proved(derivation: Statement) -> None:
    for part, equation in enumerate(derivation.printed):
        ruling = derivation.rule_on(part, equation)
        assert ruling.verdict is Verdict.PROVED, ruling.note
    for claim in derivation.all_claims:
        ruling = claim.decide()
        assert ruling.verdict is Verdict.PROVED, (claim.name, ruling.note)
    for one in derivation.refuted:
        assert one.ruling.verdict is Verdict.REFUTED, one.reading


@pytest.mark.parametrize(
    ("number", "left"),
    [
        (3, 7 * sy.DeltaX(sy.i + 3, sy.j)),
        (4, 3 * sy.r * sy.DeltaNPlus(sy.i, sy.j)),
        (4, 2 * sy.r * sy.DeltaNMinus(sy.i + 5, sy.j)),
        (9, sy.ForcePlus(sy.i + 2, sy.j) / sy.ForcePlus(sy.k - 1, sy.l - 1)),
        (11, sy.ForceMinus(sy.i, sy.j) / sy.f_load),
        (12, sy.ForcePlus(sy.i, sy.j) / (sy.f_load / (2 * sy.n_y))),
        (14, sy.M),
        (15, sy.M),
        (16, sy.M),
    ],
)
def test_a_wrong_left_hand_side_is_not_proved(number: int, left: sympy.Expr) -> None:
    derivation = ALL[number - 1]
    wrong = sympy.Eq(left, derivation.printed[0].rhs, evaluate=False)
    assert derivation.rule_on(0, wrong).verdict is not Verdict.PROVED


@pytest.mark.parametrize(
    ("number", "part", "factor"),
    [(15, 0, sy.z), (15, 0, -1), (15, 0, sy.n), (15, 1, -1), (15, 1, sy.j)],
)
def test_a_factor_that_the_equation_does_not_have_is_refuted(
    number: int, part: int, factor: sympy.Expr
) -> None:
    """By its line; a symbol without a meaning there does not come so far, or has no value."""
    derivation = ALL[number - 1]
    printed = derivation.printed[part]
    wrong = sympy.Eq(printed.lhs, factor * printed.rhs.doit(), evaluate=False)
    by_line = derivation._line_of(printed)[0].rule_on(0, wrong).verdict
    assert by_line is (Verdict.REFUTED if factor in (-1, sy.z) else Verdict.NOT_A_STATEMENT)
    told = Verdict.REFUTED if factor == -1 else Verdict.NOT_A_STATEMENT
    assert derivation.rule_on(part, wrong).verdict is told


@pytest.mark.parametrize("stranger", [sy.M, sy.i, sy.n])
def test_a_term_that_stays_as_the_load_rises_but_is_not_of_the_cone_is_not_proved(
    stranger: sympy.Symbol,
) -> None:
    derivation = ALL[15]
    left, right = derivation.printed[0].args
    wrong = sympy.Eq(left, right.doit() + stranger * (sy.sigma / sy.r) ** 2, evaluate=False)
    ruling = derivation._line_of(derivation.printed[0])[0].rule_on(0, wrong)
    assert not ruling.verdict.is_proved
    assert "neither grows nor is fixed" in ruling.note or "does not say what" in ruling.note
    assert derivation.rule_on(0, wrong).verdict is Verdict.NOT_A_STATEMENT


def test_a_wrong_premise_is_felt(monkeypatch: pytest.MonkeyPatch) -> None:
    """With the sign of δn⁺ turned in the balance of a bead, Eqs. 6 to 11 no longer follow."""
    true = axioms.balance()
    turned = sy.DeltaNPlus(sy.site_r - 1, sy.site_s - 1)
    false = sympy.Eq(true.formula.lhs.xreplace({turned: -turned}), 0, evaluate=False)
    monkeypatch.setattr(axioms, "balance", lambda: made(false, true.where, "axiom"))
    felt = ALL[5:11]

    def forget() -> None:
        eq06_force_balance._balance.cache_clear()
        for derivation in felt:
            derivation.steps.cache_clear()
            derivation.__dict__.pop("_lines", None)

    forget()
    try:
        for derivation in felt:
            for part, printed in enumerate(derivation.printed):
                ruling = derivation.rule_on(part, printed)
                assert ruling.verdict is Verdict.UNDECIDED, derivation.number
    finally:
        forget()


def _imported(module: str) -> set[str]:
    """Modules of equations that one imports."""
    folder = Path(eq06_force_balance.__file__).parent
    tree = ast.parse(folder.joinpath(*module.split(".")).with_suffix(".py").read_text("utf-8"))
    stems = {one.split(".")[-1]: one for one in modules().values()}
    found = set()
    for node in ast.walk(tree):
        within = node.module or "" if isinstance(node, ast.ImportFrom) else ""
        if within == "force_diffusion.derivations":
            found |= {stems[alias.name] for alias in node.names if alias.name in stems}
    return found


def test_premises_are_the_imports() -> None:
    """The proof graph that is stated is the import graph; rows rest on what their loads do."""
    for derivation in ALL:
        premises = [premise.number for premise in derivation.premises]
        if isinstance(derivation, Derivation):
            module = modules()[derivation.number]
            assert {modules()[number] for number in premises} == _imported(module), module
        assert all(number == "B1" or isinstance(number, int) for number in premises)


def test_premises_come_first() -> None:
    numbers = [one.number for one in ALL]
    for derivation in ALL:
        assert all(
            numbers.index(one.number) < numbers.index(derivation.number)
            for one in derivation.premises
        )
