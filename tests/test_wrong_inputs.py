"""Wrong inputs in Python: the package's own errors, of a few lines, that say what is allowed."""

import builtins
import inspect
import re
import types
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.errors import LONGEST

import force_diffusion as fd
from force_diffusion.symbols import f_plus, i, j

R = 1 + 0.01 * np.random.default_rng(7).standard_normal((5, 8))
LONG, DIGITS = 10**5000, "9" * 5000
SCENES = Path(__file__).parents[1] / "scenes"
SCENE = fd.read_scene(SCENES / "measured.toml")

WRONG: dict[str, tuple[Callable[[], object], str]] = {
    "negative radii": (lambda: fd.solve(-R), r"^radii: must be positive"),
    "a keyword": (lambda: fd.solve(R, spacng=3), "did you mean spacing"),  # type: ignore[call-arg]
    "text": (lambda: fd.solve(["a"]), "array of real numbers"),
    "a long spacing": (lambda: fd.solve(R, spacing=LONG), "at most 5000 digits"),
    "a long tolerance": (lambda: fd.solve(R, tolerance=DIGITS), "between 0 and 1"),
    "a class": (lambda: fd.solve(R, load=fd.BulkLoad), r"BulkLoad\(\)"),  # type: ignore[arg-type]
    "equation 99": (lambda: fd.equation(99), "from 1 to 16, or B1 to B25"),
    "long words": (lambda: fd.equation(DIGITS), "from 1 to 16"),
    "columns": (lambda: fd.equation(13).latex(columns=3), "must be 1 or 2"),
    "columns of a form": (lambda: fd.equation(13).exact().latex(columns=LONG), "must be 1 or 2"),
    "no form": (lambda: fd.equation(3).exact(), "13, 14, 15, 16, B2"),
    "another form": (lambda: fd.equation(16).exact("leg"), "Give bead or contact"),
    "a form": (lambda: fd.equation(13).exact(DIGITS), "Give layer"),
    "a long z": (lambda: fd.equation(13).at(M=9, z=LONG, phi=0, sigma=1, r=1), "0 ≤ z ≤ 1"),
    "one number": (lambda: fd.derive(13), r"derive\(\[13\]\)"),  # type: ignore[arg-type]
    "Coq's number": (lambda: fd.certify(13), r"certify\(\[13\]\)"),  # type: ignore[arg-type]
    "no scene": (lambda: fd.run(3), "takes a scene, its path"),  # type: ignore[arg-type]
    "an ensemble of none": (lambda: fd.ensemble(3), "takes a scene"),  # type: ignore[arg-type]
    "a cost of none": (lambda: fd.cost(3), "takes a scene"),  # type: ignore[arg-type]
    "a table": (lambda: fd.run(SCENES / "radii.csv"), "is not a scene"),
    "no packings": (lambda: fd.ensemble(SCENES / "ensemble.toml", -3), "from 2 to"),
    "many packings": (lambda: fd.ensemble(SCENES / "ensemble.toml", LONG), "from 2 to"),
    "workers": (lambda: fd.ensemble(SCENES / "ensemble.toml", 4, workers=DIGITS), "between 1 and"),  # type: ignore[arg-type]
    "progress": (lambda: fd.ensemble(SCENE, 4, progress=3), "True, False or a function"),  # type: ignore[arg-type]
    "no folder": (lambda: fd.solve(R).to_vtk("nowhere/a.vtk"), "can't be written"),
    "keys of images": (lambda: fd.Disorder(kind="file", y_down=True), "fd.read_radii"),  # type: ignore[call-arg]
    "figure 7": (lambda: fd.figure(7), "give 1, 2, 3"),
    "a model": (lambda: fd.figure("3", beside=["double-y"]), "no model 'double-y' beside figure 3"),
    "few packings": (lambda: fd.figure(4, realisations=3), "from 16 to"),
    "arrays": (lambda: fd.figure(4, realisations=np.array([20])), "from 16 to"),  # type: ignore[arg-type]
    "a kind": (lambda: fd.figure(3, kinds=("gif",)), "png, svg, pdf"),
    "seconds": (lambda: fd.cost(SCENE, "a"), "positive number"),  # type: ignore[arg-type]
    "a path": (lambda: fd.read_scene(3), "the path of a file"),  # type: ignore[arg-type]
    "a key": (lambda: fd.read_scene("a", {3: "a"}), "keys of changes are text"),  # type: ignore[dict-item]
    "a store": (lambda: fd.read_store(3), "the path of a file"),  # type: ignore[arg-type]
    "an order": (lambda: fd.Packing(3, 4), "by name: height=…"),  # type: ignore[call-arg]
    "a field": (lambda: fd.Packing(hight=3), 'did you mean "height"'),  # type: ignore[call-arg]
    "a quantity": (lambda: fd.Ask(quantity=DIGITS), '"profile"'),
    "an observable": (lambda: fd.variance("f_plus"), "symbols of force_diffusion.symbols"),  # type: ignore[arg-type]
    "a load": (lambda: fd.variance(f_plus(i, j), laod="bulk"), "did you mean load"),  # type: ignore[call-arg]
    "neighbours": (lambda: fd.mean_over(f_plus(i, j), LONG), "a whole number from 1 up"),
    "a far bead": (lambda: fd.variance(f_plus(i, j + 2**62)), "whole numbers up to 1000000000"),
    "many neighbours": (lambda: fd.mean_over(f_plus(i, j), 2**62), "1 up to 1000000000"),
    "a layer": (lambda: fd.variance(f_plus(i, j)).profile(M=3, j=1), "leave j out"),
    "orders": (lambda: fd.variance(f_plus(i, j)).leading(LONG), "from 1 to 100"),
    "layers": (lambda: fd.variance(f_plus(i, j)).profile(M=LONG, phi=0, sigma=1, r=1), "at.j=…"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_input_is_answered_in_three_lines(name):
    call, allowed = WRONG[name]
    with pytest.raises(fd.ForceDiffusionError, match=allowed) as raised:
        call()
    message = str(raised.value)
    assert len(message.splitlines()) <= 3
    assert len(message) < LONGEST + 300


def test_a_misspelt_attribute_suggests_the_right_one():
    with pytest.raises(AttributeError, match=r"did you mean fd\.solve\?"):
        fd.slove  # noqa: B018
    assert re.fullmatch(r"\d+\.\d+\.\d+", fd.__version__)


@pytest.mark.parametrize("word", ["eq13", "Eq. 13", "(13)", "Eq. (13)", "equation 13", " 13 "])
def test_equations_answer_to_how_papers_call_them(word):
    assert fd.equation(word).number == 13


def test_errors_that_docstrings_name_are_there():
    """Of functions that users call, and of methods of their results."""
    for name in fd.__all__:
        public = getattr(fd, name)
        kinds = types.FunctionType | property
        members = [value for value in vars(public).values() if isinstance(value, kinds)]
        for documented in (public, *members):
            for error in re.findall(r"\b[A-Z]\w+Error\b", inspect.getdoc(documented) or ""):
                assert hasattr(fd, error) or hasattr(builtins, error), (name, error)
