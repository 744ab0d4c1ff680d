"""Statements for Coq: what is written for what, without Coq."""

import hashlib
import json
import re
from pathlib import Path

import pytest
import sympy
from force_diffusion.derivations.api import certificates
from force_diffusion.derivations.export import coq
from force_diffusion.derivations.export.coq_packings import packing_statement
from force_diffusion.derivations.framework.catalogue import load
from force_diffusion.derivations.witnesses.draws import draw
from force_diffusion.numeric.mechanics import taylor
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import equation, minus, terms, times
from force_diffusion.symbolic.kernel.mutants import mutants

import force_diffusion as fd
from force_diffusion.__main__ import main

i, j, m = sy.i, sy.j, sy.m


@pytest.mark.parametrize(
    ("expression", "written"),
    [
        (sympy.Integer(-3), "- 3"),
        (sympy.Rational(1, 2), "1 / 2"),
        (terms(sy.M, -j), "IZR M - IZR j"),
        (times(2, terms(1, minus(sy.phi))), "2 * (1 - phi G)"),
        (1 / (1 - sy.phi**2), "1 / (1 - phi G ^ 2)"),
        (minus(times(sy.r, sy.DeltaR(i + 1, j - 1))), "- (r G * delta_r rho (i + 1) (j - 1) e)"),
        (sympy.Sum(sy.DeltaR(i - j + m, m), (m, 1, j - 1)),
         "Sum 1 (j - 1) (fun m => delta_r rho (i - j + m) m e)"),
        (sy.Dot(sy.n_minus, terms(sy.DeltaNPlus(i, j), minus(sy.DeltaNPlus(i, 2 * j)))),
         "dot (n_minus G) (minus (delta_n_plus G X i j e) (delta_n_plus G X i (2 * j) e))"),
    ],
)  # fmt: skip
def test_numbers_are_written_as_they_stand(expression: sympy.Expr, written: str) -> None:
    assert coq.real(expression) == written


def test_powers_are_written_with_roots() -> None:
    assert coq.real(sy.M ** sympy.Rational(3, 2)) == "root 2 (IZR M) ^ 3"
    assert coq.real(sy.sigma ** sympy.Rational(-2, 3)) == "/ root 3 sigma ^ 2"


def test_vectors_are_written_as_they_stand() -> None:
    weighed = times(terms(sy.DeltaR(i, j), 1), sy.b_plus)
    assert coq.vector(weighed) == "scale (delta_r rho i j e + 1) (b_plus G)"
    assert coq.vector(terms(sy.b_plus, minus(sy.n_plus))) == "minus (b_plus G) (n_plus G)"
    assert coq.vector(sympy.Integer(0)) == "zero"


@pytest.mark.parametrize(
    "expression",
    [sympy.sin(sy.phi), sympy.Symbol("phi"), sy.DeltaR(i * j, j), sy.DeltaR(i / 2, j), sy.z**i],
)
def test_what_there_are_no_words_for_is_not_stated(expression: sympy.Expr) -> None:
    with pytest.raises(coq.NotStatedError):
        coq.real(expression)


def test_ranges_are_what_the_assumptions_say() -> None:
    assert list(coq.ranges(load(1))) == []
    assert list(coq.ranges(load(3))) == ["(j >= 1)%Z"]
    assert list(coq.ranges(load(9))) == ["(k - i = l - j)%Z", "(l - j >= 1)%Z"]
    assert list(coq.ranges(load(10))) == ["(1 <= n)%Z", "(n < l - j)%Z"]
    assert list(coq.ranges(load(11))) == ["(0 <= j)%Z", "(j < M)%Z"]
    assert list(coq.ranges(load(12))) == []  # 0 < z < 1 is of no index; every layer is meant
    assert list(coq.ranges(load(16))) == ["(p >= 1)%Z", "(q >= 1)%Z"]


@pytest.mark.parametrize("number", coq.STATED)
def test_a_change_changes_the_statement_and_not_its_hypotheses(number: int) -> None:
    derivation = load(number)
    for part, printed in enumerate(derivation.printed):
        true = coq.statement(derivation, part)
        for mutant in mutants(printed):
            try:
                other = coq.statement(derivation, part, mutant.equation)
            except coq.NotStatedError:
                continue
            assert other.proposition != true.proposition
            assert other.hypotheses == true.hypotheses


def test_reversed_bounds_are_asked_about() -> None:
    printed = equation(sy.DeltaX(i, j), sympy.Sum(sy.DeltaR(i, m), (m, 3, j)) * sy.b_plus)
    assert "(3 <= j + 1)%Z" in coq.statement(load(3), 0, printed).companions


def test_the_theory_declares_no_axiom_and_admits_nothing() -> None:
    sources = certificates.theory()
    assert "Model.v" in sources
    forbidden = r"\b(Admitted|Axiom|Parameter|Conjecture|admit|Unset|bypass_check)\b"
    for name, source in sources.items():
        assert not re.search(forbidden, source), name


def test_assumptions_are_read_whole() -> None:
    printed = "Axioms:\nA.b : Prop\nC.d\n  : forall x : nat,\n    x = x\n"
    assert certificates.axioms_in(printed) == ("A.b", "C.d")
    assert certificates.axioms_in("Closed under the global context\n") == ()
    assert certificates.axioms_in("Section Variables:\nx : nat\n") != ()


SUMMARY = """
CONTEXT SUMMARY
===============

* Theory: Set is predicative
  
* Axioms:
    Coq.Reals.ClassicalDedekindReals.sig_not_dec
  
* Constants/Inductives relying on type-in-type: <none>
  
* Constants/Inductives relying on unsafe (co)fixpoints: <none>
  
* Inductives whose positivity is assumed: <none>
"""  # noqa: W293


def test_the_second_check_is_read_whole() -> None:
    assert certificates.unexpected(SUMMARY) == ""
    axiom = "Coq.Reals.ClassicalDedekindReals.sig_not_dec"
    for good, bad in (
        (axiom, f"{axiom}\n    ForceDiffusion.Model.trust_me"),
        ("type-in-type: <none>", "type-in-type: ForceDiffusion.Model.t"),
        ("Set is predicative", "Set is impredicative"),
        ("* Inductives whose positivity is assumed: <none>", ""),
    ):
        assert certificates.unexpected(SUMMARY.replace(good, bad)) != ""


def test_without_coq_nothing_is_accepted(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("PATH", "")
    assert main(["certify"]) == 1
    printed = capsys.readouterr().out
    assert "Coq absent" in printed
    assert "accepted" not in printed
    assert "apt-get install coq" in printed
    assert not fd.certify([3]).passed


def test_statements_and_hashes_are_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    assert main(["certify", "7", "--out", str(tmp_path)]) == 1
    said = json.loads((tmp_path / "certificate.json").read_text())
    assert [one["verdict"] for one in said["equations"]] == ["Coq absent"]
    for name in ("Model.v", "Equation_7_part_1.v", "Equation_7_part_2.v"):
        content = (tmp_path / name).read_bytes()
        assert said["files"][name] == hashlib.sha256(content).hexdigest()
    listed = json.loads((tmp_path / "manifest.json").read_text())["files"]
    assert set(listed) == {*said["files"], "certificate.json"}


def test_fractions_of_a_packing_are_stated() -> None:
    made = packing_statement(20021)
    packing = draw(20021)
    solved = taylor.solve(
        packing.width, packing.height, n=packing.n, rho=packing.rho, loads=packing.surface_load()
    )
    i, j = packing.contacts[0]
    order_0, order_1 = solved.force(i, j, "+")
    stated = re.search(rf"expands \(f_plus F {i} {j}\) \((.*?)\) \((.*?)\)[ )]", made.conclusion)
    assert stated
    assert (sympy.Rational(stated[1]), abs(sympy.Rational(stated[2].strip("-( ")))) == (
        order_0,
        abs(order_1),
    )
