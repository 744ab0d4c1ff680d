"""The LaTeX: one document, paste-ready fragments, a manifest that tells what is there."""

import json
import re

from derivations.document import output_files
from derivations.prose import prose_latex
from derivations.runner import run
from symbolic.kernel import Verdict
from tests.derivations import fakes


def written() -> dict[str, str]:
    return output_files([run(fakes.PREMISE), run(fakes.with_claim(Verdict.UNDECIDED))])


def test_exactly_one_file_is_a_document() -> None:
    files = written()
    assert set(files) == {"eq01.tex", "eq02.tex", "equations.tex", "manifest.json"}
    assert [n for n, text in files.items() if r"\documentclass" in text] == ["equations.tex"]


def test_a_fragment_is_the_statement_alone() -> None:
    fragment = written()["eq01.tex"]
    assert fragment.startswith(r"\begin{equation}")
    assert fragment.rstrip().endswith(r"\end{equation}")
    assert r"\delta{\bf x}_{ij} = \delta r_{ij} + \delta r_{i-1,j}" in fragment


def test_the_document_is_ascii_and_balanced_and_the_same_every_time() -> None:
    document = written()["equations.tex"]
    assert document.isascii()
    assert document == written()["equations.tex"]
    opened = re.findall(r"\\begin\{(\w+)\}", document)
    closed = re.findall(r"\\end\{(\w+)\}", document)
    assert sorted(opened) == sorted(closed)
    assert "undecided" in document
    assert r"100 \% made up \& simple" in document


def test_only_packages_of_the_recommended_set() -> None:
    packages = re.findall(r"\\usepackage(?:\[[^]]*\])?\{([^}]*)\}", written()["equations.tex"])
    assert {name for group in packages for name in group.split(",")} <= {
        "amsmath",
        "array",
        "geometry",
    }


def test_the_manifest_lists_every_file_and_verdict() -> None:
    files = written()
    manifest = json.loads(files["manifest.json"])
    assert set(manifest["files"]) == set(files)
    assert [entry["verdict"] for entry in manifest["equations"]] == ["proved", "undecided"]
    assert manifest["equations"][1]["premises"] == [1]


def test_prose_is_escaped_and_set_as_mathematics() -> None:
    assert prose_latex("50 % of {a} & b_1, #2, \\x ~") == (
        r"50 \% of \{a\} \& $b_{1}$, $\#2$, \textbackslash{}x \~{}"
    )
    assert prose_latex("a sum of the (i, j)") == "a sum of the ($i$, $j$)"
    assert prose_latex("n⁺·δn⁺_ij = 0.") == (
        r"$\hat{\bf n}^{+}\cdot \delta \hat{\bf n}^{+}_{ij} = 0$."
    )
    assert prose_latex("2√3 r") == r"$2\sqrt{3} r$"
    assert prose_latex("f_load") == r"$f^{\rm load}$"
    assert prose_latex("unknown ☃").endswith(r"\mbox{[snowman]}$")
