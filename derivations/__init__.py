"""One file per equation of the paper, and the command line."""

import sys

if sys.argv[:1] == ["-m"]:  # Python is about to run a module of this package as a program
    from .commands.interrupts import end_quietly

    end_quietly()
