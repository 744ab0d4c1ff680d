"""``show`` and ``list``: true to the derivations."""

import json
import re
import subprocess
import sys
from fractions import Fraction
from pathlib import Path
from random import Random

import pytest
import sympy
from force_diffusion.derivations.framework.catalogue import modules, paper
from force_diffusion.derivations.framework.closed_form import ClosedForm
from force_diffusion.derivations.framework.loading import load
from force_diffusion.numeric.arithmetic.errors import ArgumentError
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.printing.text import text

from force_diffusion.__main__ import main
from tests.derivations.rows import each

ROOT = Path(__file__).parents[2]
NUMBERS = list(modules())
BEYOND = [number for number in NUMBERS if number not in {*paper(), "B1"}]


def shown(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main(["show", *arguments]) == 0
    printed = capsys.readouterr()
    assert printed.err == ""
    return printed.out


def test_several_are_printed_one_below_the_other(capsys: pytest.CaptureFixture[str]) -> None:
    both = shown(capsys, "13", "B5", "--as", "latex")
    each = [shown(capsys, number, "--as", "latex") for number in ("13", "B5")]
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


@pytest.mark.parametrize("number", each(NUMBERS, share=4))
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


@pytest.mark.parametrize("number", each([13, 14, 15, 16, *BEYOND], share=3))
def test_exact_forms(capsys: pytest.CaptureFixture[str], number: int | str) -> None:
    """SymPy source, Python source, JSON and text are those of the closed forms."""
    forms = load(number).exact_forms
    sources = shown(capsys, str(number), "--exact", "--as", "sympy").split("\n\n")
    scope: dict[str, object] = {}
    exec(shown(capsys, str(number), "--exact", "--as", "python"), scope)
    functions = [value for name, value in scope.items() if name != "__builtins__"]
    texts = shown(capsys, str(number), "--exact")
    data = json.loads(shown(capsys, str(number), "--as", "json"))["equations"][0]["exact"]
    assert list(data) == list(forms)
    random = Random(number)
    for (name, form), source, function in zip(forms.items(), sources, functions, strict=True):
        assert form.decide(sympy.sympify(eval(source, names()))).verdict == "proved"
        # str leaves some lines of a long form out
        assert f"Eq. {number}, {name}: " + "\n".join([*form.lines(), ""]) in f"{texts}\n"
        assert [one["domain"] for one in data[name]] == [one.domain for one in form.pieces]
        assert [one["text"] for one in data[name]] == [text(one.expr) for one in form.pieces]
        for _ in range(20):
            values = draw(form, random)
            found, expected = function(**values), form.at(**values)  # type: ignore[operator]
            assert float(found) == pytest.approx(float(expected), rel=1e-13)


def draw(form: ClosedForm, random: Random) -> dict[str, int | Fraction]:
    """Arguments in its domain."""
    near = {"phi": Fraction(7, 25), "sigma": Fraction(1, 3), "r": Fraction(2)}
    near |= {"t": Fraction(5, 3), "t_2": Fraction(7, 4), "t_3": Fraction(9, 5)}
    while True:
        values = {name: near.get(name, random.randint(-3, 12)) for name in form.symbols}
        try:
            form.at(**values)
        except ArgumentError:
            continue
        return values
