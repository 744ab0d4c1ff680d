from .derivations.api.certificates import certify as certify
from .derivations.api.equation import Equation as Equation
from .derivations.api.equation import equation as equation
