"""A scene becomes an outcome, and radii of one's own a solution."""

from .outcome import Outcome
from .running import Scene, read_scene, read_tolerance, run
from .solving import Solution, solve

__all__ = ["Outcome", "Scene", "Solution", "read_scene", "read_tolerance", "run", "solve"]
