"""What tests with planted faults share."""

from collections.abc import Iterator

import pytest

from tests.soundness.trial import forget


@pytest.fixture
def nothing_is_remembered() -> Iterator[None]:
    """Neither does the test see what was worked out before, nor others what it has planted."""
    forget()
    yield
    forget()
