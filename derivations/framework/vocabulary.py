"""The names that equation files import, from one place.

They make expressions as they are printed, axioms, rules and derivations.
"""

# fmt: off
from force_diffusion.symbolic.algebra.exact import NotProvedError
from force_diffusion.symbolic.as_printed import certificate, minus, power, terms, times
from force_diffusion.symbolic.trees import equation
from force_diffusion.symbolic.kernel import axioms
from force_diffusion.symbolic.kernel.averages import power_law, tensile
from force_diffusion.symbolic.kernel.domain import Domain, Limit, at_fixed_height
from force_diffusion.symbolic.kernel.limits import asymptotic, drop_terms, negligible
from force_diffusion.symbolic.kernel.rules import (
    Rule, along, differentiate, follows, inducted, mirror, order, rewrite, same, solve)
from force_diffusion.symbolic.kernel.statistics import moment
from force_diffusion.symbolic.kernel.theorem import Groups, Theorem, instance, isolated, read
from force_diffusion.symbolic.mechanics import lattice
from force_diffusion.symbolic.notation import Symbol

from . import layers
from .closed_form import ClosedForm
from .proof import Step, Steps, shown
from .glossary import usual
from .record import FIRST_ORDER, Derivation
# fmt: on
