"""What every test may use."""

import signal

import pytest
from hypothesis import HealthCheck, settings

# Each run draws anew; a failure is replayed from .hypothesis, or with what is printed beside it.
# .ci/run says which seed it has drawn: with it, and the same profile, all examples are the same.
EXAMPLES = {"quick": 20, "ci": 200, "thorough": 10_000}
for profile, examples in EXAMPLES.items():
    settings.register_profile(
        profile,
        max_examples=examples,
        deadline=None,
        derandomize=False,
        print_blob=True,
        suppress_health_check=[HealthCheck.too_slow],  # says more about the machine
    )
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
