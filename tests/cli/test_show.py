"""``show`` and ``list``: true to the derivations."""

import json
import subprocess
import sys
from collections.abc import Callable
from functools import partial

import pytest
import sympy
from force_diffusion.derivations.framework.catalogue import modules, paper
from force_diffusion.derivations.framework.record import load
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.printing.text import text

from tests.derivations.rows import each

NUMBERS = list(modules())
BEYOND = [number for number in NUMBERS if number not in {*paper(), "B1"}]


@pytest.fixture
def show(printed: Callable[..., str]) -> Callable[..., str]:
    return partial(printed, "show")


def test_several_are_printed_one_below_the_other(show):
    each = [show(number, "--as", "latex") for number in (13, "B5")]
    assert show(13, "B5", "--as", "latex") == "\n".join(each)


@pytest.mark.parametrize("arguments", [["--help"], ["show", "--help"], ["show", "99"]])
def test_sympy_is_not_imported(arguments):
    program = (
        "import sys; from force_diffusion.__main__ import main; "
        "main(sys.argv[1:]); sys.exit(any(m in sys.modules for m in ('sympy', 'numpy', 'flint')))"
    )
    subprocess.run([sys.executable, "-c", program, *arguments], check=True, capture_output=True)


def test_list_names_every_equation(call):
    lines = call("list")[1].splitlines()
    assert [line.split()[0] for line in lines] == [str(number) for number in NUMBERS]
    assert "surface_diffusion" in lines[12]


@pytest.mark.parametrize("number", each(NUMBERS))
@pytest.mark.parametrize("form", ["text", "latex", "sympy", "python", "steps"])
def test_every_form_of_every_equation(show, number, form):
    assert show(number, "--as", form).strip()


@pytest.mark.parametrize("number", each([13, 14, 15, 16, *BEYOND]))
def test_exact_forms(show, number):
    """SymPy source, JSON and text are those of the closed forms, and the Python runs."""
    forms = load(number).exact_forms
    names = {**vars(sympy), **vars(sy)}
    sources = show(number, "--exact", "--as", "sympy").split("\n\n")
    scope: dict[str, object] = {}
    exec(show(number, "--exact", "--as", "python"), scope)
    assert len(scope) == 1 + len(forms)  # and the built-in names
    texts = show(number, "--exact")
    data = json.loads(show(number, "--as", "json"))["equations"][0]["exact"]
    assert list(data) == list(forms)
    for (name, form), source in zip(forms.items(), sources, strict=True):
        assert form.decide(sympy.sympify(eval(source, names))).verdict == "proved"
        # str leaves some lines of a long form out
        assert f"Eq. {number}, {name}: " + "\n".join([*form.lines(), ""]) in f"{texts}\n"
        assert [(piece["domain"], piece["text"]) for piece in data[name]] == [
            (piece.domain, text(piece.expr)) for piece in form.pieces
        ]
