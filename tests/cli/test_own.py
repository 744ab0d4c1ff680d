"""``derive my_file.py``: a user's own derivation is proved, attacked and exported."""

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.framework.own import (
    OwnDerivationError,
    derivations_in,
    premises_unnamed,
)
from force_diffusion.derivations.framework.record import ExactCase
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError
from force_diffusion.symbolic import symbols as sy

import force_diffusion as fd
from force_diffusion.__main__ import main

GUIDE = Path(__file__).parents[2] / "docs" / "guides" / "derive.md"
(EXAMPLE,) = re.findall(
    r"^```\{code-block\} python\n:caption: two_forces\.py\n\n(.*?)\n```$",
    GUIDE.read_text(encoding="utf-8"),
    re.MULTILINE | re.DOTALL,
)
PLAIN = (
    EXAMPLE.replace("premises=(premise(4), premise(5), premise(11))", "premises=()")
    .replace("    steps=steps,", "    steps=lambda: Lines(Where()),")
    .replace("    exact=variance.exact,\n", "")
)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def save(text: str, name: str = "mine.py") -> str:
    Path(name).write_text(text, encoding="utf-8")
    return name


def alone(text: str) -> str:
    """The same without its premises, which take seconds; they are run as well otherwise."""
    return text.replace("premises=(premise(4), premise(5), premise(11))", "premises=()")


@pytest.mark.long
def test_the_guide_s_example_is_proved_attacked_and_exported(folder: Path, capsys) -> None:
    assert main(["derive", save(EXAMPLE), "--out", "own"]) == 0
    printed = capsys.readouterr()
    assert "premises" not in printed.err
    lines = printed.out.splitlines()
    own = next(line for line in lines if line.startswith(" S1"))
    assert re.search(r"proved .* 1 witness, (\d+) of \d+ mutants refuted", own)
    assert "12 proved. Written to own." in lines[-1]
    assert r"\sigma^2(f^+ + f^-)" in (folder / "own" / "eqS1.tex").read_text(encoding="utf-8")
    assert r"\input{eqS1}" in (folder / "own" / "equations.tex").read_text(encoding="utf-8") or (
        "S1" in (folder / "own" / "equations.tex").read_text(encoding="utf-8")
    )
    manifest = json.loads((folder / "own" / "manifest.json").read_text(encoding="utf-8"))
    assert manifest["equations"][-1]["number"] == "S1"
    assert manifest["equations"][-1]["premises"] == [4, 5, 11]


def test_premises_that_are_not_named_are_told(folder: Path, capsys) -> None:
    assert main(["derive", save(alone(EXAMPLE))]) == 0
    said = " ".join(capsys.readouterr().err.split())
    assert "S1: its steps rest on more than its premises name" in said
    assert "add premise(11)" in said


@pytest.mark.long
def test_the_premises_that_the_guide_names_are_all(folder: Path) -> None:
    (own,) = derivations_in(Path(save(EXAMPLE)))
    assert premises_unnamed(own) == []
    for number in (5, 11, 13, 14, 16, "B3"):
        assert premises_unnamed(load(number)) == []


def test_a_wrong_guess_is_refuted(folder: Path, capsys) -> None:
    wrong = alone(EXAMPLE).replace("4 * M**3", "3 * M**3")
    assert main(["derive", save(wrong)]) == 1
    printed = capsys.readouterr().out
    assert "refuted: printed equation" in printed
    assert "at φ = 0, j = M/2, as M → ∞, it stays off by 0.25 of the true value" in " ".join(
        printed.split()
    )
    assert "3 changed to 4: proved, unlike the printed equation" in printed
    assert "equivalent" not in printed


def test_a_change_that_says_the_same_is_told_and_no_fault_of_the_checker(folder, capsys) -> None:
    """To leading order M + 1 is M."""
    shifted = alone(EXAMPLE).replace("4 * M**3", "4 * M**2 * (M + 1)")
    assert main(["derive", save(shifted)]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "proved as well, and not listed as equivalent: does it say the same?" in printed


def test_too_wide_a_domain_says_which_bound_to_raise(folder: Path, capsys) -> None:
    assert main(["derive", save(alone(EXAMPLE).replace("layers(3)", "layers(2)"))]) == 2
    message = " ".join(capsys.readouterr().err.split())
    assert message.startswith("force-diffusion: mine.py, line ")
    assert "j ≥ 3 settles it" in message
    assert "Traceback" not in message


def test_it_is_shown_and_evaluated_like_the_paper_s(folder: Path, capsys) -> None:
    path = save(EXAMPLE)
    assert main(["show", path, "--exact", "--as", "latex", "--case", "base+2"]) == 0
    assert r"\begin{equation}" in capsys.readouterr().out
    (derivation,) = derivations_in(Path(path))
    eq = fd.equation(derivation)
    assert eq.number == "S1"
    assert [one.number for one in eq.premises] == [4, 5, 11]
    assert eq.profile(M=5, phi=0, sigma=1, r=1).cases[2] == "base+2"
    assert str(eq.decide(2 * fd.equation(13).rhs).verdict) == "proved"


def test_beside_the_paper_s(folder: Path, capsys) -> None:
    assert main(["derive", "1", save(alone(EXAMPLE)), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["equations"]
    assert [one["number"] for one in found] == [1, "S1"]


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("x = 1", "mine.py states no derivation: let it hold DERIVATION"),
        ("DERIVATION = 13", "mine.py states no derivation"),
        ("DERIVATIONS = {}", "mine.py states no derivation"),
        ("x = 1\ny = x +", "mine.py, line 2: "),
        ("x = 1\ny = unknown", "mine.py, line 2: NameError: name 'unknown' is not defined"),
        ("import no_such_module", "mine.py, line 1: ModuleNotFoundError"),
        ("def f():\n    raise ValueError('α\\x1b')\nf()", "mine.py, line 2: ValueError: α\\x1b"),
        ("raise SystemExit(0)", "mine.py, line 1: SystemExit: it ends the program"),
        ("\0", "mine.py"),
        (PLAIN.replace('"S1"', "13"), "mine.py: number = 13 is taken"),
        (PLAIN.replace('"S1"', '"B5"'), "number = 'B5' is taken"),
        (PLAIN.replace('"S1"', '"T4"'), "number = 'T4' is taken"),
        (PLAIN.replace('"S1"', '"../S"'), "number = '../S': a capital letter, then"),
        (PLAIN.replace('"S1"', "99"), "number = 99: a capital letter, then"),
        (PLAIN.replace("number=\"S1\",", ""), "mine.py, line"),
    ],
)  # fmt: skip
def test_a_file_that_is_none_is_told_in_words(folder: Path, text: str, says: str, capsys) -> None:
    assert main(["derive", save(text)]) == 2
    printed = capsys.readouterr()
    assert says in " ".join(printed.err.split())
    assert "Traceback" not in printed.err
    assert printed.out == ""


@pytest.mark.parametrize(("name", "says"), [("none.py", "no such file"), ("d.py", "is a direct")])
def test_a_file_that_can_not_be_read(folder: Path, name: str, says: str, capsys) -> None:
    Path("d.py").mkdir()
    assert main(["derive", name]) == 2
    assert f"{name} can't be read: " in (told := capsys.readouterr().err)
    assert says in told


WRONG = [
    ("printed=(printed,)", "printed=printed", "printed of S1: a tuple of equations"),
    ("printed=(printed,)", "printed=(printed.rhs,)", "printed of S1: a tuple of equations"),
    ("    steps=steps,", "    steps=3,", "steps of S1: a function that gives Lines"),
    ("    steps=steps,", "    steps=lambda: 3,", "steps of S1: a function that gives Lines"),
    ("    steps=steps,", "    steps=lambda: Lines(Where()),", "no line of its steps shows it"),
    ("exact=variance.exact,", "exact=variance.exact(),", "exact of S1: a function"),
    ('relation="∼"', 'relation="~"', "relation of S1: one of = "),
    ('relation="∼"', 'relation="="', 'leading order only: write relation="∼", or print the exact'),
    (
        '    relation="∼",\n',
        "",
        "the printed sign of Eq. S1 is =, but its line is proved",
    ),
    ('relation="∼"', 'relation="≈"', 'proved to leading order only: write relation="∼"'),
    ('relation="∼"', 'relation="∝"', 'proved to leading order only: write relation="∼"'),
    (
        'variance.show_leading(lines, "At fixed z the terms of order M³ are left.", printed)',
        "import sympy; from force_diffusion.derivation import asymptotic; lines.show('f', "
        "sympy.Tuple(printed, printed), where=(Where(), variance.in_the_limit), by=asymptotic())",
        "its equations are related by = and ∼: show them in lines of their own",
    ),
    ("premises=()", "premises=(11,)", "premises of S1: derivations, as (premise(11),)"),
    ('{"+": 1, "-": 1}),)', '{"+": 1, "-": 1}), 3)', "witnesses of S1: a tuple of witnesses"),
    ('{"+": 1, "-": 1}', '{"p": 1}', "what mine.py states can't be run: ValueError: branch must"),
    ("usual(sigma, r, M, z, phi)", "(M,)", "symbols of S1: pairs of a symbol and its meaning"),
    ('name="sum_of_two_forces"', 'name="../x"', "name of S1: a word for code"),
    (
        r'r"\frac{\sigma^2(f^+ + f^-)}{\langle f\rangle^2}"',
        r'"\frac{1}{2}"',
        r"ValueError: '\x0crac{1}{2}' holds a control character: write r",
    ),
    ("forces(SURFACE)", "()", "NotProvedError: f⁻_ij is not given by the radii"),
]


@pytest.mark.parametrize(("good", "bad", "says"), WRONG)
def test_what_is_wrong_with_a_derivation_is_named(folder, good, bad, says, capsys) -> None:
    wrong = alone(EXAMPLE).replace(good, bad)
    assert wrong != alone(EXAMPLE)
    assert main(["derive", save(wrong)]) == 2
    printed = capsys.readouterr().err
    assert says in " ".join(printed.split())
    assert "Traceback" not in printed


@pytest.mark.parametrize("sign", ["=", "≈", "∝"])
def test_what_holds_to_leading_order_is_not_proved_of_another_sign(folder, sign) -> None:
    """Not by any way to ask: every one of them would read the sign that is printed."""
    (right,) = derivations_in(Path(save(alone(EXAMPLE))))
    assert fd.equation(right).decide(fd.equation(right).rhs).verdict.is_proved
    eq = fd.equation(replace(right, relation=sign))
    for candidate in (eq.rhs, eq.rhs + 1, eq.expr):
        ruling = eq.decide(candidate)
        assert str(ruling.verdict) == "undecided"
        assert f"sign of Eq. S1 is {sign}, but its line is proved to leading order" in ruling.note
    assert str(eq.prove(premises=False).verdict) == "undecided"


def test_what_holds_exactly_is_not_printed_as_a_leading_order() -> None:
    eq = fd.equation(replace(fd.equation(9)._derivation, number="S9", relation="∼"))
    assert 'its line is proved exactly: write relation="="' in eq.decide(eq.expr).note


def test_what_holds_to_leading_order_is_no_exact_form(folder) -> None:
    (right,) = derivations_in(Path(save(alone(EXAMPLE))))
    last, eq = right.steps()[-1], fd.equation(right)
    case = ExactCase(right.printed[0].lhs, "j ≥ 3", eq.rhs, line=last)
    form = fd.equation(replace(right, exact=lambda: {"interior": case})).exact()
    assert "its line is proved to leading order only" in form.decide(eq.rhs + 1).note
    assert not form.decide(eq.rhs).verdict.is_proved


def test_no_profile_takes_a_leading_order_for_exact(folder) -> None:
    (right,) = derivations_in(Path(save(alone(EXAMPLE))))
    wrong = replace(right, relation="=", domain=(sy.j <= sy.M - 1, sy.j >= 0))
    profile = fd.equation(wrong).profile(layers=[4], M=10, phi=0, sigma=0.01, r=1)
    assert profile.cases == ("interior",)
    none = replace(wrong, exact=lambda: {"base": right.exact()["base"]})
    with pytest.raises(ForceDiffusionError, match="no exact form"):
        fd.equation(none).profile(layers=[4], M=10, phi=0, sigma=0.01, r=1)


def test_two_of_one_label(folder: Path, capsys) -> None:
    save(alone(EXAMPLE), "one.py")
    save(alone(EXAMPLE), "two.py")
    assert main(["derive", "one.py", "two.py"]) == 2
    assert "two derivations are called 'S1'" in capsys.readouterr().err


def test_an_exception_in_a_step_is_told_by_its_line(folder: Path, capsys) -> None:
    broken = alone(EXAMPLE).replace("    return lines", "    return lines[99]")
    assert main(["derive", save(broken)]) == 2
    assert re.search(r"mine\.py, line \d+: IndexError: ", capsys.readouterr().err)


def test_a_file_may_use_what_lies_beside_it(folder: Path) -> None:
    save(alone(EXAMPLE), "other.py")
    assert derivations_in(Path(save("from other import DERIVATION")))[0].number == "S1"


def test_several_in_one_file(folder: Path) -> None:
    several = alone(EXAMPLE) + (
        "\nfrom dataclasses import replace\n"
        'DERIVATIONS = {"S1": DERIVATION, "S2": replace(DERIVATION, number="S2")}\n'
    )
    assert [one.number for one in derivations_in(Path(save(several)))] == ["S1", "S2"]


def test_a_premise_that_takes_the_place_of_a_paper_s_equation_is_refused(folder: Path) -> None:
    (derivation,) = derivations_in(Path(save(alone(EXAMPLE))))
    from dataclasses import replace

    false = replace(derivation, number=11)
    with pytest.raises(OwnDerivationError, match="number = 11 is taken"):
        fd.derive([replace(derivation, premises=(false,))])
    with pytest.raises(OwnDerivationError, match="number = 11 is taken"):
        fd.equation(false)


@pytest.mark.parametrize("wrong", [b"\xff\xfe", b"# coding: nonsense\n"])
def test_a_file_that_is_no_text(folder: Path, wrong: bytes, capsys) -> None:
    Path("mine.py").write_bytes(wrong)
    assert main(["derive", "mine.py"]) == 2
    assert "mine.py" in capsys.readouterr().err


def test_a_number_is_no_file(capsys: pytest.CaptureFixture[str]) -> None:
    wrong: Any = ["derive", "13.px"]
    assert main(wrong) == 2
    assert "is not an equation of this package" in " ".join(capsys.readouterr().err.split())
