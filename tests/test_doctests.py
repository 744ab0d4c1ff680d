"""Every example in a docstring is run, module by module, as it is installed."""

import doctest
import linecache
import pkgutil
from importlib import import_module

import pytest

# Modules that import these may lack them: extras.
EXTRAS = {"distributed", "matplotlib", "numba"}
MODULES = ["force_diffusion"] + [
    module.name
    for room in ("derivations", "numeric", "symbolic")
    for module in pkgutil.walk_packages(
        import_module(f"force_diffusion.{room}").__path__, f"force_diffusion.{room}."
    )
]
LONG = {
    "force_diffusion.derivations.api.derived",
    "force_diffusion.derivations.api.equation",
    "force_diffusion.numeric.figures.catalogue",
    "force_diffusion.numeric.run.cost",
}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.long if name in LONG else ()) for name in MODULES]
)
def test_examples(name):
    try:
        module = import_module(name)
    except ModuleNotFoundError as missing:
        if missing.name not in EXTRAS:
            raise
        pytest.skip(f"{missing.name} is missing")
    linecache.clearcache()  # doctest asks for each of its files whether it has changed
    results = doctest.testmod(module)
    assert not results.failed
