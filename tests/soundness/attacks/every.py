"""All attacks, tried."""

from collections.abc import Iterator

from . import (  # noqa: F401 - each adds its own to ATTACKS
    averaging,
    comparing,
    inducing,
    lines,
    moving,
    over_layers,
    rewriting,
    solving,
    splitting,
    statements,
    supposing,
    tracing,
)
from .attack import ATTACKS, REFUSALS, Attack


def succeeded() -> Iterator[Attack]:
    """The attacks that the kernel does not refuse: it is at fault."""
    for one in ATTACKS:
        try:
            one.attempt()
        except REFUSALS:
            continue
        except Exception:  # a guard that stumbles guards nothing
            yield one
        else:
            yield one
