from .derivations.api.equation import Equation as Equation
from .derivations.api.equation import equation as equation
