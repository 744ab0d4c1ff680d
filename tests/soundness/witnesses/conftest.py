"""The packings that witnesses are asked about."""

import pytest

from tests.soundness.witnesses.draws import SmallPacking, draw


@pytest.fixture(params=[1, 2])
def packing(request: pytest.FixtureRequest) -> SmallPacking:
    return draw(request.param)
