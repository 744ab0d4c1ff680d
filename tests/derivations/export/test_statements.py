"""The LaTeX of every printed equation, compared with files that a person has looked at."""

from pathlib import Path

import pytest
from force_diffusion.derivations.export.document import fragment_name, statement_latex
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.loading import load

GOLDEN = Path(__file__).parents[2] / "golden"


@pytest.mark.parametrize("number", list(modules()))
def test_statement(number: int, update_golden: bool) -> None:
    derivation = load(number)
    path = GOLDEN / fragment_name(derivation)
    found = statement_latex(derivation)
    if update_golden:
        path.write_text(found, encoding="utf-8")
    assert path.read_text(encoding="utf-8") == found, "run pytest --update-golden and review"
