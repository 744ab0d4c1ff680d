"""Closed forms as they are written: parts of a domain, numbers, Python and LaTeX agree."""

import re
from collections.abc import Callable, Iterator
from fractions import Fraction
from itertools import product
from random import Random
from typing import Any

import pytest
import sympy
from force_diffusion.numeric.arithmetic.errors import ArgumentError

import force_diffusion as fd
from force_diffusion.symbols import (
    M, N, delta_r, delta_x, dot, e_y, f_along, f_minus, f_plus, i, j, k, l, n_plus, p, p_plus,
    q, t,
)  # fmt: skip

a = sympy.Symbol("a")
CALLS: dict[str, Callable[[], fd.ClosedForm]] = {
    **{f"Eq. {number}": lambda number=number: fd.equation(number).exact()
       for number in (13, 14, 16)},
    "averages": lambda: fd.equation(15).exact("bulk"),
    "difference": lambda: fd.variance(f_plus(i, j) - a * f_minus(i, j)),
    "two layers": lambda: fd.covariance(f_plus(i, j), f_plus(i + p, l)),
    "layers of a bulk load": lambda: fd.covariance(f_plus(i, j), f_minus(i + 2, l), load="bulk"),
    "neighbours": lambda: fd.variance(fd.mean_over(f_plus(i, j), N)),
    "bare": lambda: fd.variance(f_plus(i, j), load=fd.leaning(t, "bulk"), relative=False),
    "response": lambda: fd.variance(fd.response(i, j), load=fd.point(k, l)),
    "second order": lambda: fd.mean(p_plus(i, j) * f_plus(i + 1, j + 1), order=2),
    "heights": lambda: fd.variance(dot(e_y, delta_x(i, j) - delta_x(k, l))),
    "spheres": lambda: fd.variance(f_along(1, 0, k, j), load="surface leaning", dimension=3),
    "steps of three": lambda: fd.covariance(
        delta_r(i + 3 * p, j), dot(n_plus, delta_x(i, j + 2 * q + 1))
    ),
    "no layers": lambda: fd.variance(f_plus(0, 2), where=M <= 9),
}  # fmt: skip
NUMBERS = {"phi": Fraction(-2, 7), "sigma": Fraction(3, 2), "r": 5, "t": Fraction(4, 3), "a": 7,
           "t_2": 2, "t_3": Fraction(1, 3), "L_plus": 3, "n_y": Fraction(1, 2)}  # fmt: skip


SOON = ("Eq. 13", "averages", "bare")
"""Those that take less than a second to derive and to ask."""


@pytest.fixture(
    scope="module",
    params=[name if name in SOON else pytest.param(name, marks=pytest.mark.long) for name in CALLS],
)
def form(request: pytest.FixtureRequest) -> fd.ClosedForm:
    return CALLS[request.param]()


def points(form: fd.ClosedForm) -> Iterator[dict[str, int]]:
    """All indices of a box around the origin, more of them where there are fewer indices."""
    names = [name for name, symbol in form.symbols.items() if symbol.is_integer]
    far = {1: 12, 2: 9, 3: 6, 4: 4}[len(names)]
    ranges = (range(-far if name in "ikpq" else -1, far + 1) for name in names)
    return (dict(zip(names, values, strict=True)) for values in product(*ranges))


def others(form: fd.ClosedForm) -> dict[str, Any]:
    """Values of the symbols that are no indices."""
    return {name: NUMBERS[name] for name, symbol in form.symbols.items() if not symbol.is_integer}


def is_inside(form: fd.ClosedForm, at: dict[str, int]) -> bool:
    values = {form.symbols[name]: number for name, number in at.items()}
    relations = [relation.subs(values) for relation in form.kernel_domain.relations]
    even = [expr.subs(values) for expr in form.even]
    relations += [values[symbol] >= 1 for symbol in values if symbol.is_positive]
    return not {sympy.false, False} & {*relations} and not any(
        number.is_Integer and number % 2 for number in map(sympy.sympify, even)
    )


def test_each_place_of_the_domain_is_in_one_piece(form):
    tests = [
        [sympy.lambdify([*form.symbols.values()], sympy.And(*part), "math") for part in piece.where]
        for piece in form.pieces
    ]
    rest, inside = dict.fromkeys(others(form), 0), 0
    for at in points(form):
        if is_inside(form, at):
            values = [{**at, **rest}[name] for name in form.symbols]
            pieces = [any(holds(*values) for holds in parts) for parts in tests]
            assert sum(pieces) == 1, (at, [piece.domain for piece in form.pieces])
            inside += 1
    assert inside > 9 or form.symbols.keys() <= {"M", "phi", "sigma", "r"}


def test_python_gives_the_same_and_refuses_the_same(form):
    names: dict[str, Any] = {}
    exec(form.python("function"), names)
    numbers, places = others(form), list(points(form))
    for at in Random(1).sample(places, min(len(places), 500)):
        try:
            expected = form.at(**at, **numbers)
        except ArgumentError:
            with pytest.raises(ValueError, match="outside of"):
                names["function"](**at, **numbers)
            continue
        value = names["function"](**at, **_fractions(numbers))
        if isinstance(value, float):  # Python divides whole numbers in 1/m, and takes roots
            assert value == pytest.approx(float(expected), rel=1e-13)
        else:
            assert value == expected


@pytest.mark.parametrize("steps", [(2048, 1463), (-2048, -1463), (7 * 10**17, 5 * 10**17)])
def test_python_compares_whole_numbers_as_such(steps):
    names: dict[str, Any] = {}
    exec(fd.covariance(delta_r(i + 10 * p, j), delta_r(i + 14 * q, j)).python("function"), names)
    for further in (0, 1):
        at = {"p": steps[0] + further, "q": steps[1]}
        expected = int(5 * at["p"] == 7 * at["q"])
        assert names["function"](**at, j=0, sigma=1, r=1) == expected


def _fractions(given: dict[str, Any]) -> dict[str, Fraction]:
    return {name: Fraction(value) for name, value in given.items()}


def test_latex_says_the_same(form):
    formulas = list(_formulas(form.latex()))
    assert len(formulas) == len(form.pieces)
    numbers = _fractions(NUMBERS) | {name: Fraction(7, n) for n, name in enumerate("MijklNp", 5)}
    numbers["H_M"] = Fraction(5, 3)
    for formula, piece in zip(formulas, form.pieces, strict=True):
        plain = {s: numbers[getattr(s, "in_code", s.name)] for s in piece.expr.free_symbols}
        expected = piece.expr.subs({s: sympy.Rational(value) for s, value in plain.items()})
        assert eval(formula, {"__builtins__": {}}, dict(numbers)) == expected, formula


_RELATION = re.compile(r"\\leq|\\geq|=|otherwise")


def _formulas(latex: str) -> Iterator[str]:
    """The right-hand sides of cases, as Python."""
    latex = re.sub(r"\\(?:begin|end)\{aligned\}|\\times|\\[bB]igg?[lr]|\\quad", " ", latex)
    before, _, cases = latex.partition(" = ")[2].partition(r"\begin{cases}")
    before = before.replace(r"\\", " ").replace("&", " ").strip()
    several = cases.replace(r"\end{cases}", " ").split(r"\\[3pt]") if cases else [before]
    for case in several:
        lines = (line.split("&")[0] for line in case.split(r"\\"))
        formula = " ".join(line for line in lines if not _RELATION.search(line))
        yield _python(f"({before}) ({formula})" if cases and before else formula)


def _python(latex: str) -> str:
    """A formula without functions; juxtaposed factors are multiplied."""
    for old, new in ((r"\sigma_{\delta r}", "sigma"), (r"\phi", "phi"), (r"n_{y}", "n_y"),
                     (r"L^{+}", "L_plus"), (r"t_{2}", "t_2"), (r"t_{3}", "t_3"), (r"H_{M}", "H_M"),
                     (r"\quad", ""), (r"\left", ""), (r"\right", ""), ("[", "("), ("]", ")"),
                     (r"\{", "("), (r"\}", ")")):  # fmt: skip
        latex = latex.replace(old, new)
    fraction = re.compile(r"\\frac\{([^{}]*)\}\{([^{}]*)\}")
    latex = re.sub(r"\^\{(\d+)\}", r"**\1", latex)
    while fraction.search(latex):
        latex = fraction.sub(r"((\1)/(\2))", latex)
    spaced = re.sub(r"(?<=[\w)])\s*(?=\()|(?<=\))\s*(?=\w)|(?<=\w)\s+(?=\w)", "*", latex)
    # whole numbers are divided as fractions
    return re.sub(r"(?<![\w*.])(\d+)(?!\w)", r"(\1)", spaced.strip())
