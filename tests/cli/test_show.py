"""``show`` and ``list``: true to the derivations."""

import re
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import pytest
import sympy
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.loading import load
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.printing.structure import rebuilt

from force_diffusion.__main__ import main

ROOT = Path(__file__).parents[2]
NUMBERS = list(modules())
EXACT = [(number, place) for number in NUMBERS for place in (load(number).exact or dict)()]


def shown(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main(["show", *arguments]) == 0
    printed = capsys.readouterr()
    assert printed.err == ""
    return printed.out


def test_several_are_printed_one_below_the_other(capsys: pytest.CaptureFixture[str]) -> None:
    both = shown(capsys, "13", "T9", "--as", "latex")
    each = [shown(capsys, number, "--as", "latex") for number in ("13", "T9")]
    assert both == "\n".join(each)


def names() -> dict[str, object]:
    return {**vars(sympy), **vars(sy)}


@pytest.mark.parametrize("arguments", [["--help"], ["show", "--help"], ["show", "99"]])
def test_sympy_is_not_imported(arguments: list[str]) -> None:
    program = (
        "import sys; from force_diffusion.__main__ import main; "
        "main(sys.argv[1:]); sys.exit(any(m in sys.modules for m in ('sympy', 'numpy', 'flint')))"
    )
    subprocess.run(
        [sys.executable, "-c", program, *arguments],
        cwd=ROOT,
        check=True,
        capture_output=True,
        timeout=600,
    )


def test_list_names_every_equation(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == [str(number) for number in NUMBERS]
    assert "surface_diffusion" in lines[12]


@pytest.mark.long(sample=96)
@pytest.mark.parametrize("number", NUMBERS)
@pytest.mark.parametrize("form", ["text", "latex", "sympy", "python", "steps"])
def test_every_form_of_every_equation(capsys, number: int, form: str) -> None:
    assert shown(capsys, str(number), "--as", form).strip()


def test_the_right_hand_side_of_13_in_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    text = shown(capsys, "13", "--as", "sympy")
    assert text.count("\n") == 1
    assert set(re.findall(r"[A-Za-z_]+", text)) == {"M", "z", "phi", "sigma", "r"}
    M, z, phi, sigma, r = (Fraction(n, d) for n, d in ((40, 1), (1, 4), (1, 3), (1, 7), (3, 2)))
    value = eval(text, {"M": M, "z": z, "phi": phi, "sigma": sigma, "r": r})
    expected = 2 * M**3 / (1 - phi**2) ** 2 * (1 - z) ** 2 * (2 * z + 1) * (sigma / r) ** 2
    assert value == expected


@pytest.mark.parametrize("number", NUMBERS)
def test_sympy_source_reads_back(capsys: pytest.CaptureFixture[str], number: int) -> None:
    lines = shown(capsys, str(number), "--as", "sympy").splitlines()
    equations = load(number).printed
    assert len(lines) == len(equations)
    for line, equation in zip(lines, equations, strict=True):
        side = equation.lhs if equation.rhs == 0 else equation.rhs
        assert rebuilt(eval(line, names())) == rebuilt(side)


@pytest.mark.parametrize("number", NUMBERS)
def test_python_source_is_python(capsys: pytest.CaptureFixture[str], number: int) -> None:
    compile(shown(capsys, str(number), "--as", "python"), "shown", "exec")


@pytest.mark.long(sample=70)
@pytest.mark.parametrize(("number", "place"), EXACT)
def test_exact_forms(capsys: pytest.CaptureFixture[str], number: int, place: str) -> None:
    exact_forms = load(number).exact
    assert exact_forms is not None
    form = exact_forms()[place]
    arguments = [str(number), "--exact", "--at-j", place]
    source = shown(capsys, *arguments, "--as", "sympy")
    assert source.count("\n") == 1
    known = {"M", "N", "i", "j", "k", "l", "q", "t", "phi", "sigma", "r", "S", "Sum", "tau_"}
    assert set(re.findall(r"[A-Za-z_]+", source)) <= known
    assert sympy.expand(eval(source, names()) - form.expression) == 0

    scope: dict[str, object] = {}
    exec(shown(capsys, *arguments, "--as", "python"), scope)
    (function,) = (value for name, value in scope.items() if name != "__builtins__")
    values: dict[str, int | Fraction] = {"M": 9, "i": 1, "j": 4, "k": 3, "l": 12, "q": 5, "N": 7}
    values |= {"t": Fraction(5, 3), "tau_1": Fraction(7, 4), "tau_2": Fraction(9, 5)}
    values |= {"phi": Fraction(7, 25), "sigma": Fraction(1, 3), "r": Fraction(2)}
    code = function.__code__  # type: ignore[attr-defined]
    taken = code.co_varnames[: code.co_argcount]
    found = function(**{name: values[name] for name in taken})  # type: ignore[operator]
    exact = form.expression.xreplace(
        {getattr(sy, name): sympy.Rational(values[name]) for name in taken}
    ).doit()
    assert isinstance(found, Fraction)
    assert sympy.Rational(found) == exact

    text = shown(capsys, *arguments)
    assert form.validity in text
    for missed in form.missed:
        assert f"{missed.where}: " in text


def test_a_theorem_is_all_its_equations(capsys: pytest.CaptureFixture[str]) -> None:
    text = shown(capsys, "t4")
    titles = [load(number).title for number in ("B4", "B5", "B6", "B15", "B16")]
    places = [text.index(f"{title}\n") for title in titles]
    assert places == sorted(places)
    assert text.count("A case of theorem T4: mean positions and forces, to second order") == 5


def test_interior_is_the_default(capsys: pytest.CaptureFixture[str]) -> None:
    plain = shown(capsys, "13", "--exact", "--as", "sympy")
    assert plain == shown(capsys, "13", "--exact", "--as", "sympy", "--at-j", "interior")
