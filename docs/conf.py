"""The documentation site: ``sphinx-build -W docs site``. It loads nothing from elsewhere."""

import inspect
import os
import re
import sys
from functools import cached_property
from hashlib import sha256
from importlib import import_module
from importlib.metadata import version as installed
from pathlib import Path
from typing import Any

import math_core
from docutils import nodes
from force_diffusion.derivations.commands.application import COMMANDS
from force_diffusion.derivations.export import article
from force_diffusion.derivations.export.prose import prose_markdown
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.record import load
from force_diffusion.derivations.framework.rows import Row
from force_diffusion.symbolic.printing.latex import latex

import force_diffusion as fd

_CACHE = Path(__file__).parent / "_build" / "notebooks"


def _sources() -> str:
    """A name made from all files of the package that a notebook may use."""
    root = Path(__file__).parents[1]
    folders = ("derivations", "force_diffusion", "numeric", "scenes", "symbolic")
    files = (file for folder in folders for file in sorted((root / folder).rglob("*")))
    content = (file.read_bytes() for file in files if file.suffix in {".py", ".toml", ".mplstyle"})
    return sha256(b"".join(content)).hexdigest()[:16]


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
# Notebooks are run when they or the package have changed; otherwise output comes from the cache.
nb_execution_mode = "cache"
nb_execution_cache_path = str(_CACHE / _sources())
nb_execution_in_temp = True
nb_execution_raise_on_error = True
nb_execution_timeout = -1  # none: how long they take depends on what else the machine does
nb_merge_streams = True
nb_render_markdown_format = "myst"

autodoc_member_order = "bysource"
autodoc_preserve_defaults = True
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
    for label in (label for label in modules() if isinstance(label, str)):
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


def _equations() -> str:
    """Every equation of the paper: formula, premises, assumptions, remarks and exact forms."""
    parts = []
    for eq in (fd.equation(number) for number in range(1, 17)):
        parts.append(f"## Eq. {eq.number}: {eq.title}")
        parts += [f"$$\n{display}\n$$" for display in eq.displays()]
        if eq.premises:
            plural = "s" * (len(eq.premises) > 1)
            numbers = ", ".join(str(premise.number) for premise in eq.premises)
            parts.append(f"*Rests on* Eq{plural}. {numbers}.")
        parts.append(f"*Assumes:* {'; '.join(map(prose_markdown, eq.assumptions))}.")
        parts += [f"*Remark:* {prose_markdown(remark)}" for remark in eq.remarks]
        for name in eq.forms:
            parts.append(f"*Exact* (`{name}`):")
            parts += [f"$$\n{display}\n$$" for display in eq.exact(name).displays()]
    return "\n\n".join(parts)


def _options() -> str:
    """The help of every command."""
    blocks = (
        f"### `{command}`\n\n```{{program-output}} force-diffusion {command} --help\n```"
        for command in COMMANDS
    )
    return "\n\n".join(blocks)


_OTHER_CLASSES = {
    "Accuracy": "force_diffusion.numeric.accuracy",
    "Beads": "force_diffusion.numeric.run.contacts",
    "Certificate": "force_diffusion.derivations.coq.record",
    "Certification": "force_diffusion.derivations.coq.record",
    "Contacts": "force_diffusion.numeric.run.contacts",
    "CostStudy": "force_diffusion.numeric.run.cost",
    "Derived": "force_diffusion.derivations.api.derived",
    "PaperFigure": "force_diffusion.numeric.figures.catalogue",
    "Physicality": "force_diffusion.numeric.mechanics.physicality",
    "Piece": "force_diffusion.symbolic.piecewise",
    "Plan": "force_diffusion.numeric.planning.plan",
    "Proof": "force_diffusion.derivations.api.proof",
    "Ruling": "force_diffusion.symbolic.kernel.decisions",
    "StoreContent": "force_diffusion.numeric.ensemble.store",
    "Way": "force_diffusion.numeric.run.cost",
}
"""Where the classes are that the page on Python names and ``fd`` does not have."""


def _directives(table: re.Match[str]) -> str:
    """A table of names, as directives that show their docstrings."""
    lines = []
    for cell in re.findall(r"^\| `([^`]+)` \|", table[0], re.MULTILINE):
        name, _, arguments = cell.partition("(")
        if name.startswith(f"{fd.__name__}."):
            lines += [f".. automodule:: {name}", "   :members:" if "numeric" in name else ""]
            continue
        owner, _, member = name.partition(".")
        module = _OTHER_CLASSES.get(owner, fd.__name__)
        described = getattr(import_module(module), owner)
        if member:
            if member in getattr(described, "__dataclass_fields__", ()):
                continue  # its class says what it is
            kind = inspect.getattr_static(described, member)
            directive = "automethod" if inspect.isfunction(kind) else "autoattribute"
            if isinstance(kind, property | cached_property):
                directive = "autoproperty"
            lines += [f"   .. {directive}:: {member}", ""]
        elif not inspect.isclass(described):
            lines += [f".. autofunction:: {module}.{name}", ""]
        elif issubclass(described, Exception):
            lines += [f".. autoexception:: {module}.{name}()", ""]
        else:
            lines += [f".. autoclass:: {module}.{name}({arguments.removesuffix(')')})", ""]
    return "\n".join(["```{eval-rst}", *lines, "```", ""])


def _generated(_app: Any, name: str, source: list[str]) -> None:
    """Put in what pages have from the derivations, and the docstrings."""
    if name == "background/beyond":
        source[0] = article.page(article.source())
    if name == "reference/calls":
        source[0] = f"{source[0]}\n{_calls()}\n"
    if name == "reference/commands":
        source[0] = f"{source[0]}\n{_options()}\n"
    if name == "reference/equations":
        source[0] = f"{source[0]}\n{_equations()}\n"
    if name == "reference/python":
        source[0] = re.sub(r"(?m)^\| name \|.*\n(?:\|.*\n)+", _directives, source[0])


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
