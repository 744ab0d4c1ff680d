from .derivations.framework.equation import Equation as Equation
from .derivations.framework.equation import equation as equation
