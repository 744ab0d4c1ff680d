"""What every test may use."""

import gc
import signal
from collections import defaultdict
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

Call = Callable[..., tuple[int, str, str]]
"""Calls a command: its status, what it prints, and what it says of errors."""

# The garbage collector runs less often: it took a twentieth of the time.
gc.set_threshold(10_000, 20, 20)

# Each run draws anew; a failure is replayed from .hypothesis, or with what is printed beside it.
# .ci/run says which seed it has drawn: with it, and the same profile, all examples are the same.
EXAMPLES = {"quick": 20, "ci": 50, "thorough": 10_000}
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

# A shell that starts the tests in the background has them ignore interrupts, and nohup the end of
# a terminal; so would every program that they start, and some tests interrupt one.
for name, usual in (("SIGINT", signal.default_int_handler), ("SIGHUP", signal.SIG_DFL)):
    number = getattr(signal, name, None)  # Windows has no SIGHUP
    if number is not None and signal.getsignal(number) is signal.SIG_IGN:
        signal.signal(number, usual)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--update-golden",
        action="store_true",
        help="write the golden files anew instead of comparing with them",
    )


def _leaves_out(config: pytest.Config) -> bool:
    """Whether long tests are left out: neither files are named nor is the profile that of CI.

    Of a test that is marked ``long(sample=8)`` eight cases are run nevertheless. Of one that has
    many cases the profile of CI runs a third, those that the seed says; of one that is marked
    ``long(share=2)`` a half. Cases with the same ``place`` are run together, whatever the test.
    """
    by_default = config.args_source is pytest.Config.ArgsSource.TESTPATHS
    return by_default and config.getoption("--hypothesis-profile") in {None, "quick"}


def pytest_report_header(config: pytest.Config) -> str | None:
    if _leaves_out(config):
        return "long tests: some; more with --hypothesis-profile=ci, all where files are named"
    if config.getoption("--hypothesis-profile") == "ci":
        return "long tests: of some a share of their cases, drawn by the seed"
    return None


MANY = 8
"""Cases of a slow test, of which CI runs a third."""
FORGETTING = "tests/soundness/test_bad_kernels"
"""Tests that clear all caches, and so come last in their process."""
DERIVING = tuple(
    f"tests/{place}"
    for place in (
        "derivations/", "soundness/", "symbolic/",
        "cli/test_derive", "cli/test_readme", "cli/test_show",
    )
)  # fmt: skip
"""Tests that prove equations and work out closed forms: in one process, which does so once."""


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    from xdist.scheduler import LoadScopeScheduling

    class Scheduling(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            deriving = nodeid.startswith(DERIVING) and not nodeid.startswith(FORGETTING)
            return "deriving" if deriving else nodeid

    return Scheduling(config, log)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    items.sort(key=lambda item: item.nodeid.startswith(FORGETTING))
    of_ci = config.getoption("--hypothesis-profile") == "ci"
    if not _leaves_out(config) and not of_ci:
        return
    drawn = str(config.getoption("--hypothesis-seed"))
    seed = int(drawn) if drawn.isdecimal() else 0
    cases: dict[str, list[pytest.Item]] = defaultdict(list)
    for item in items:
        if item.get_closest_marker("long"):
            cases[item.nodeid.partition("[")[0]].append(item)
    left_out: set[pytest.Item] = set()
    for every in cases.values():
        marks = [mark.kwargs for item in every if (mark := item.get_closest_marker("long"))]
        if of_ci:
            share = marks[0].get("share", 1 if len(every) < MANY else 3)
            places = [mark.get("place", place) for place, mark in enumerate(marks)]
            wanted = {n for n, place in enumerate(places) if place % share == seed % share}
        else:
            sample = min(marks[0].get("sample", 0), len(every))
            # evenly spaced, in the order of the cases
            wanted = {place * len(every) // sample for place in range(sample)}
        left_out |= {item for n, item in enumerate(every) if n not in wanted}
    config.hook.pytest_deselected(items=list(left_out))
    items[:] = [item for item in items if item not in left_out]


@pytest.fixture
def call(capsys: pytest.CaptureFixture[str]) -> Call:
    """Call a command as a user does, in this process."""
    from force_diffusion.__main__ import main

    def called(*words: object) -> tuple[int, str, str]:
        status = main([str(word) for word in words])
        streams = capsys.readouterr()
        return status, streams.out, streams.err

    return called


@pytest.fixture
def printed(call: Call) -> Callable[..., str]:
    """Call a command that has to succeed without a word of warning: what it prints."""

    def succeeded(*words: object) -> str:
        status, stdout, stderr = call(*words)
        assert (status, stderr) == (0, "")
        return stdout

    return succeeded


@pytest.fixture
def refused(call: Call) -> Callable[..., str]:
    """Call a command that has to end with a status other than 0 and no answer: what it says."""

    def failed(*words: object, status: int = 2) -> str:
        ended, stdout, stderr = call(*words)
        assert (ended, stdout) == (status, ""), stderr
        return stderr

    return failed


@pytest.fixture
def timed_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """In a study of costs each way is timed once."""
    monkeypatch.setattr("force_diffusion.numeric.run.cost.SHORT", 0)


@pytest.fixture
def update_golden(request: pytest.FixtureRequest) -> bool:
    return bool(request.config.getoption("--update-golden"))
