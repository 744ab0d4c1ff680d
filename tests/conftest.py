"""What every test may use."""

import signal

import pytest
from hypothesis import settings

# quick by default; `pytest --hypothesis-profile=thorough` for ten thousand examples each
settings.register_profile("quick", max_examples=20, deadline=None, derandomize=True)
settings.register_profile("thorough", max_examples=10_000, deadline=None)
settings.load_profile("quick")

# A shell that starts the tests in the background has them ignore interrupts, and so would every
# program that they start; some tests interrupt one.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--update-golden",
        action="store_true",
        help="write the golden files anew instead of comparing with them",
    )
    parser.addoption(
        "--report",
        metavar="FILE",
        help="let the browser look at this page, made by 'force-diffusion report'",
    )


@pytest.fixture
def update_golden(request: pytest.FixtureRequest) -> bool:
    return bool(request.config.getoption("--update-golden"))
