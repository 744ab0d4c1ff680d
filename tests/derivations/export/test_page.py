"""The page of the report as text: what is in it, whatever the verdicts."""

import re
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest
from force_diffusion.derivations.export.page.html import prose
from force_diffusion.derivations.export.page.page import page
from force_diffusion.derivations.export.page.parts import Data, Figure, Part, Table
from force_diffusion.derivations.export.page.proof_graph import depths
from force_diffusion.derivations.framework.record import Derivation
from force_diffusion.derivations.framework.runner import run
from force_diffusion.symbolic.kernel.decisions import Verdict

from tests.derivations import fakes

ROOT = Path(__file__).parents[2]
PART = Part(
    id="part",
    title="A part <b>",
    words=("About σ/r & more.",),
    command="force-diffusion part '<x>'",
    figures=(Figure(b"<svg xmlns='http://www.w3.org/2000/svg'/>", 'alt "1"', "What it shows."),),
    tables=(
        Table(
            "Two rows",
            [{"name": "a", "value": 1.5e-9}, {"name": "b", "value": None}],
            Data("t.csv", "a,b\n"),
        ),
    ),
)


def made(*derivations: Derivation, parts: Sequence[Part] = ()) -> str:
    outcomes = [replace(run(one), seconds=0.5) for one in derivations]
    return page(outcomes, parts, "force-diffusion report", "2001-02-03 04:05 UTC")


def test_what_coq_said_stands_beside_the_verdict() -> None:
    """Of an equation that is printed otherwise it has said nothing that still holds."""
    text = made(fakes.PREMISE)
    assert 'class="verdict stale"' in text
    assert "Coq: accepted by Coq 8.16.1, and has changed since." in text
    assert 'class="verdict accepted"' not in text


class Outline(HTMLParser):
    """Open elements, to see that each is closed, and all attributes."""

    VOID = frozenset({"meta", "link", "input", "img", "br"})

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.attributes: list[tuple[str, str | None]] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.attributes += attrs
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.attributes += attrs

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def test_every_element_is_closed_and_no_address_leaves_the_page() -> None:
    outline = Outline(made(fakes.PREMISE, fakes.CONCLUSION, parts=[PART]))
    assert outline.open == []
    addresses = [value for name, value in outline.attributes if name in ("href", "src")]
    assert len(addresses) > 10
    assert all(value and re.match("#|data:", value) for value in addresses)
    assert not any(name.startswith("on") or name == "style" for name, _ in outline.attributes)


def test_all_of_a_derivation_is_told() -> None:
    text = made(fakes.PREMISE)
    for words in ("made up &amp; simple", "Add the two radii.", "Terms compared", "a witness"):
        assert words.lower() in text.lower()
    assert text.count('class="verdict refuted">refuted') == 16  # each mutant
    assert r"\Delta_{ij} = \delta r_{ij} + \delta r_{i-1,j}" in text
    assert "Rests on no other equation." in text
    assert 'href="#eq-1"' in made(fakes.PREMISE, fakes.CONCLUSION)


@pytest.mark.parametrize("verdict", [Verdict.REFUTED, Verdict.UNDECIDED])
def test_what_is_not_proved_shows(verdict: Verdict) -> None:
    text = made(fakes.PREMISE, fakes.with_claim(verdict))
    assert f'<span class="verdict {verdict}">' in text
    assert "<dd>1 <span>of 2</span></dd>" in text
    assert f'<circle class="{verdict}"' in text


def test_a_part_is_escaped_and_carries_its_data() -> None:
    text = made(fakes.PREMISE, parts=[PART])
    assert "A part &lt;b&gt;" in text
    assert "&#39;&lt;x&gt;&#39;" in text
    assert 'alt="alt &#34;1&#34;"' in text
    assert '<td class="number">1.50·10⁻⁹</td>' in text
    assert 'href="data:text/csv;base64,YSxiCg==" download="t.csv"' in text


def test_the_page_states_its_size() -> None:
    text = made(fakes.PREMISE)
    stated = re.search(r"one file of ([\d.]+) MB", text)
    assert stated
    assert abs(float(stated[1]) - len(text.encode()) / 1e6) < 0.01


def test_prose_is_escaped() -> None:
    assert prose("<script> & δr") == "&lt;script&gt; &amp; <math><mi>δ</mi><mi>r</mi></math>"
    assert "<script" not in prose("_(<script>) = ^<b>1</b>")


def test_long_formulas_in_sentences_may_break() -> None:
    assert prose("a = b").count("<math>") == 1
    long = prose(" + ".join(["δr_(i−1,j)"] * 8))
    assert long.count("<math>") > 2
    assert long.count("<mi>δ</mi>") == 8


def test_depths_follow_the_longest_chain() -> None:
    assert depths({1: [], 2: [1], 3: [1, 2], 4: [1], 5: [3, 4]}) == {1: 0, 2: 1, 3: 2, 4: 1, 5: 3}


@pytest.mark.long
def test_the_same_page_every_time() -> None:
    program = (
        "from tests.derivations.export.test_page import PART, fakes, made\n"
        "print(made(fakes.PREMISE, fakes.CONCLUSION, parts=[PART]))"
    )
    first, second = (
        subprocess.run(
            [sys.executable, "-c", program],
            env={"PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT), "PYTHONUTF8": "1"},
            capture_output=True,
            check=True,
            timeout=60,
        ).stdout
        for seed in ("1", "2")
    )
    assert first == second


@pytest.mark.parametrize(("width", "narrow"), [("244.8", True), ("504", False)])
def test_drawings_for_one_column_are_not_blown_up(width: str, narrow: bool) -> None:
    svg = f'<svg height="9pt" viewBox="0 0 9 9" width="{width}pt"/>'.encode()
    figure = Figure(svg, "alt", "caption", command="force-diffusion figures 3")
    found = made(fakes.PREMISE, parts=[Part("p", "A part", (), figures=(figure,))])
    assert ('<img class="narrow"' in found) == narrow
    assert "<code>force-diffusion figures 3</code>" in found
    assert found.count("Made by") == made(fakes.PREMISE).count("Made by")  # no empty command
