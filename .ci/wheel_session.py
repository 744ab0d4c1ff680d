"""A Python session with the installed wheel, in a folder whose modules must not be imported."""

import sys
from importlib.metadata import packages_distributions, requires, version
from importlib.util import find_spec
from pathlib import Path

import force_diffusion as fd

FOLDER = Path.cwd()


def origin(module: str) -> Path:
    """Where a module would be imported from."""
    spec = find_spec(module)
    assert spec is not None
    assert spec.origin is not None
    return Path(spec.origin).resolve()


# Ours is the one name, installed; the others that the repository has are the user's.
names = {name for name, whose in packages_distributions().items() if "force-diffusion" in whose}
assert names == {"force_diffusion"}, names
assert Path(sys.prefix).resolve() in origin("force_diffusion").parents
for name in ("numeric", "symbolic", "derivations", "scenes"):
    assert FOLDER in origin(name).parents, name
assert any("extra ==" in line for line in requires("force-diffusion") or [])
for missing in ("matplotlib", "numba", "distributed"):  # no extra is installed
    assert find_spec(missing) is None, missing
assert "sympy" not in sys.modules  # names are imported when they are used

eq = fd.equation(13)
assert eq.number == 13
assert {"M", "z"} <= set(eq.symbols)
assert "sigma" in eq.latex()
assert eq.exact().at(M=10, j=0, phi=-0.125, sigma=0.01, r=1) > 0
assert eq.prove().verdict == "proved"
assert eq.decide(2 * eq.rhs).verdict == "refuted"
try:
    fd.equation(17)
except ValueError as error:
    said = str(error)
else:
    said = ""
assert "from 1 to 16" in said

assert not {"numeric", "symbolic", "derivations", "scenes"} & set(sys.modules)
print(version("force-diffusion"))
