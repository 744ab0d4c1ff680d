"""The documentation site: ``sphinx-build -W docs site``. It loads nothing from elsewhere."""

import os
import re
import sys
from importlib.metadata import version as installed
from pathlib import Path
from typing import Any

import math_core
from docutils import nodes
from force_diffusion.derivations.export import article
from force_diffusion.derivations.export.prose import prose_markdown
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.framework.rows import Row
from force_diffusion.symbolic.printing.latex import latex

project = "force-diffusion"
release = installed(project)
author = "the force-diffusion developers"
copyright = f"2026, {author}"

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinxcontrib.programoutput",
]
exclude_patterns = ["_build"]

html_theme = "furo"
html_title = f"force-diffusion {release}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_copy_source = False
html_show_sourcelink = False

myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
myst_heading_anchors = 3
nb_execution_mode = "force"
nb_execution_in_temp = True
nb_execution_raise_on_error = True
nb_execution_timeout = 120
nb_merge_streams = True
nb_render_markdown_format = "myst"

autodoc_member_order = "bysource"
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True

# The commands of the pages are those of the Python that builds them; their help has one width.
os.environ["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
os.environ["COLUMNS"] = "88"
programoutput_use_ansi = False

_SMALLER = re.compile(r"\\mbox\{\\\w+\$\\displaystyle (.*)\$\}", re.DOTALL)  # smaller type
_LATEX = math_core.LatexToMathML()
# Finer spacing than MathML has: between the columns of an array, and after a line of it.
_SPACING = re.compile(r"@\{[^}]*\}|(?<=\\\\)\[\d+pt\]")


def _formula(writer: Any, node: nodes.Element, display: bool) -> None:
    """Write a formula as MathML, which browsers lay out without a script."""
    latex = _SPACING.sub("", node.astext())
    latex = _SMALLER.sub(r"\1", latex)
    mathml = _LATEX.convert_with_local_state(latex, displaystyle=display)
    writer.body.append(f'<div class="formula">{mathml}</div>' if display else mathml)
    raise nodes.SkipNode


def _bars(_app: Any, _what: str, _name: str, _of: Any, _options: Any, lines: list[str]) -> None:
    """Take |change| in a docstring for what it says, and not for a substitution."""
    lines[:] = [re.sub(r"\|(\w+)\|", r"\\|\1\\|", line) for line in lines]


def _calls() -> str:
    """Every equation beyond the paper: its call, and the formula that the call gives."""
    parts = []
    for label in (one for one in modules() if isinstance(one, str)):
        row = load(label)
        parts.append(f"## {label}: {row.title}")
        if not isinstance(row, Row):
            parts += [f'```python\nfd.equation("{label}")\n```', f"$$\n{row.latex()}\n$$"]
            continue
        (_, form), *others = row.exact_forms.items()
        parts += [f"```python\n{row.call}\n```", f"$$\n{form.latex()}\n$$"]
        parts += [
            f"${latex(symbol)}$: {prose_markdown(meaning)}."
            for symbol, meaning in row.quantities
            if form.quantity.has(symbol)
        ]
        parts.append(prose_markdown(row.meaning))
        if others:
            names = ", ".join(f"`{name}`" for name, _ in others)
            parts.append(f'Further forms, of `fd.equation("{label}").exact(…)`: {names}.')
    return "\n\n".join(parts)


def _generated(_app: Any, name: str, source: list[str]) -> None:
    """Put in what pages have from the derivations."""
    if name == "background/beyond":
        source[0] = article.page(article.source())
    if name == "reference/calls":
        source[0] = f"{source[0]}\n{_calls()}\n"


def setup(app: Any) -> None:
    """Make MathML of all formulas, and the pages that come from the derivations."""
    app.connect("source-read", _generated)
    app.connect("autodoc-process-docstring", _bars)
    app.add_html_math_renderer(
        "mathml",
        (lambda writer, node: _formula(writer, node, display=False), None),
        (lambda writer, node: _formula(writer, node, display=True), None),
    )


html_math_renderer = "mathml"
