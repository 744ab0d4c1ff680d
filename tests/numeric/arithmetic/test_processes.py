"""Work in a process beside this one: the same values, wherever it is done."""

import os
import time
from multiprocessing import active_children

import pytest
from force_diffusion.numeric.arithmetic import processes


def square_and_process(number: int) -> tuple[int, int]:
    return number**2, os.getpid()


def refuse(number: int) -> None:
    raise ValueError(f"not {number}")


def die_elsewhere(here: int) -> str:
    if os.getpid() != here:
        os._exit(1)
    return "here"


@pytest.fixture
def _two_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(processes, "cores", lambda: 2)


@pytest.mark.long
@pytest.mark.usefixtures("_two_cores")
def test_what_has_begun_is_done_beside_and_the_rest_here() -> None:
    with processes.beside() as start:
        first = start(square_and_process, 0)
        time.sleep(2)  # until it has been handed over
        start(time.sleep, 600)
        values = [first, *(start(square_and_process, n) for n in range(1, 9))]
        found = [value() for value in (first, *reversed(values[2:]))]
    assert [square for square, _ in found] == [0, 64, 49, 36, 25, 16, 9, 4]
    assert found[0][1] != os.getpid()
    assert {process for _, process in found[1:]} == {os.getpid()}


@pytest.mark.long
@pytest.mark.usefixtures("_two_cores")
def test_who_waits_works_meanwhile() -> None:
    with processes.beside() as start:
        slow = start(time.sleep, 4)
        time.sleep(2)  # until it has been handed over
        rest = [start(square_and_process, 1), start(refuse, 3), start(square_and_process, 2)]
        assert slow() is None
        with pytest.raises(ValueError, match="not 3"):  # when it is asked for, and not before
            rest[1]()
        assert [rest[0](), rest[2]()] == [(1, os.getpid()), (4, os.getpid())]


@pytest.mark.long
@pytest.mark.usefixtures("_two_cores")
def test_errors_come_back_and_a_death_is_made_good() -> None:
    with processes.beside() as start:
        refused, dead = start(refuse, 3), start(die_elsewhere, os.getpid())
        time.sleep(2)  # until they have been handed over
        with pytest.raises(ValueError, match="not 3"):
            refused()
        assert dead() == "here"
        assert start(square_and_process, 2)() == (4, os.getpid())  # none is left beside


@pytest.mark.usefixtures("_two_cores")
def test_nothing_is_left_when_the_block_is_left() -> None:
    before = set(active_children())
    with processes.beside() as start:
        start(time.sleep, 600)
        assert set(active_children()) > before
    assert set(active_children()) == before


def test_one_core_does_it_here(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(processes, "cores", lambda: 1)
    with processes.beside() as start:
        assert start(square_and_process, 3)() == (9, os.getpid())
