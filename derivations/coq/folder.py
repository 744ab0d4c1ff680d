"""Coq at work in a folder: it compiles files, one on each core, and checks them."""

import os
import re
import shutil
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from graphlib import TopologicalSorter
from pathlib import Path
from subprocess import DEVNULL, PIPE, Popen, TimeoutExpired

from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError

from .files import LIBRARY, imports

WRITTEN_FOR = "Coq 8.16.1"
INSTALL = "on Debian and Ubuntu: apt-get install coq; elsewhere: https://coq.inria.fr"
LIMIT = 900.0  # seconds for one file; the slowest takes about ten

ALLOWED = frozenset(
    {
        "ClassicalDedekindReals.sig_not_dec",
        "ClassicalDedekindReals.sig_forall_dec",
        "FunctionalExtensionality.functional_extensionality_dep",
    }
)
"""Axioms that a theorem may rest on: those of Coq's real numbers, and equality of functions."""

Notice = Callable[[str], None]
"""Told what is being done."""


class CoqAbsentError(ForceDiffusionError):
    """There is no Coq on this machine, or none that answers."""

    exit_status = 3


@dataclass(frozen=True)
class Reply:
    """What a program of Coq's printed; ``failed`` is why it did not do what it was asked to."""

    printed: str = ""
    failed: str = ""


class CoqFolder:
    """A folder in which Coq compiles files.

    Attributes:
        checker: such as "Coq 8.16.1".
        answers: Coq's answer on each file.

    Raises:
        CoqAbsentError: when there is no Coq.
    """

    def __init__(self, folder: Path) -> None:
        for program in ("coqc", "coqchk"):
            if not shutil.which(program):
                raise CoqAbsentError(f"{program} is not there. Install Coq: {INSTALL}")
        self.folder = folder
        self.answers: dict[str, Reply] = {}
        self._under_way: set[Popen[str]] = set()
        version = self._run("coqc", "--print-version")
        number = re.match(r"(\d+(?:\.\w+)+)\s", version.printed)
        if version.failed or not number:
            raise CoqAbsentError(
                f"coqc doesn't say its version ({version.failed or version.printed.strip()}). "
                f"Install Coq: {INSTALL}"
            )
        self.checker = f"Coq {number[1]}"

    def _run(self, program: str, *arguments: str) -> Reply:
        environment = {name: at for name, at in os.environ.items() if not name.startswith("COQ")}
        with Popen(
            [program, *arguments],
            cwd=self.folder, env=environment, stdin=DEVNULL, stdout=PIPE, stderr=PIPE,
            text=True, errors="replace",
        ) as process:  # fmt: skip
            self._under_way.add(process)
            try:
                printed, errors = process.communicate(timeout=LIMIT)
            except TimeoutExpired:
                return Reply(failed=f"no answer within {LIMIT:.0f} s")
            finally:
                process.kill()
                self._under_way.discard(process)
        status = process.returncode
        return Reply(printed + errors, (_error(errors) or f"status {status}") if status else "")

    def compile(self, sources: Mapping[str, str], notice: Notice) -> None:
        """Compile these files, those first that others import; ``answers`` has one for each.

        What is under way is ended when this is interrupted.
        """
        for name, source in sources.items():
            (self.folder / name).write_text(source, encoding="utf-8")
        order = TopologicalSorter(
            {name: sources.keys() & imports(source) for name, source in sources.items()}
        )
        order.prepare()
        pool = ThreadPoolExecutor(os.cpu_count())
        asked: dict[Future[Reply], str] = {}
        try:
            while order.is_active():
                for name in order.get_ready():
                    if self.trouble(imports(sources[name])):
                        self.answers[name] = Reply(failed="what it imports does not compile")
                        order.done(name)
                    else:
                        notice(name)
                        asked[pool.submit(self._run, "coqc", "-q", "-R", ".", LIBRARY, name)] = name
                for done in wait(asked, return_when=FIRST_COMPLETED).done:
                    name = asked.pop(done)
                    self.answers[name] = done.result()
                    order.done(name)
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
            while not all(future.done() for future in asked):  # it was interrupted
                for process in [*self._under_way]:
                    process.kill()
                wait(asked, timeout=0.1)

    def trouble(self, names: Iterable[str]) -> str:
        """The file among these that failed first, and why; or nothing."""
        wanted = set(names)
        for name, answer in self.answers.items():
            if name in wanted and answer.failed:
                other = "" if self.checker == WRITTEN_FOR else f" (written for {WRITTEN_FOR})"
                return f"{name}: {answer.failed}{other}"
        return ""

    def check(self, names: Iterable[str]) -> str:
        """Let coqchk check compiled modules and all they rest on; what went wrong, or nothing."""
        modules = (f"{LIBRARY}.{name}" for name in names)
        failed = self._run("coqchk", "-silent", "-R", ".", LIBRARY, *modules).failed
        return f"coqchk: {failed}" if failed else ""


def _error(message: str) -> str:
    """The error in what Coq prints, on one line."""
    _, _, error = message.rpartition("Error:")
    return " ".join((error or message).split())[:200]


def axioms_in(printed: str) -> tuple[str, ...] | None:
    """What ``Print Assumptions`` names, every word at the start of a line but its headings.

    It also names what Coq was told to take for guarded, positive or well-typed without a check.
    None where it has not printed anything: then nothing was asked, or nobody answered.
    """
    lines = [line for line in printed.splitlines() if line and not line[0].isspace()]
    headings = ("Axioms:", "Closed under the global context")
    if not any(line in headings for line in lines):
        return None
    return tuple(sorted({line.split()[0] for line in lines if line not in headings}))
