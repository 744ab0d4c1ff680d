"""Where the program starts; the command line is loaded inside of the guard."""

import atexit
import gc

from force_diffusion.derivations.framework.guard import end_interrupts_quietly, guarded

end_interrupts_quietly()

# Container objects made between two searches for garbage. Python's 700 makes a program search some
# hundred times through what its imports have just built, which is 7 % of the time of `show`.
SEARCH_AFTER = 50_000


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; return its exit status."""

    def program() -> int:
        gc.set_threshold(SEARCH_AFTER)
        # The system takes all memory back at once: Python need not search it for garbage on the
        # way out, which is a sixth of the time of `show`.
        atexit.register(gc.freeze)
        from force_diffusion.derivations.commands.cli import run

        return run(arguments)

    return guarded(program)


if __name__ == "__main__":
    raise SystemExit(main())
