"""Where the program starts; the command line is loaded inside of the guard."""

import gc
import os

from force_diffusion.derivations.commands.guard import guarded

# pydantic would look through all that is installed for plugins
os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; return its exit status."""

    def program() -> int:
        gc.set_threshold(200_000)  # libraries and SymPy make many objects that stay, and few cycles
        from force_diffusion.derivations.commands.cli import run

        return run(arguments)

    return guarded(program)


if __name__ == "__main__":
    raise SystemExit(main())
