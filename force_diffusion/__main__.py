"""Where the program starts; the command line is loaded inside of the guard."""

from force_diffusion.derivations.commands.guard import guarded


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; return its exit status."""

    def program() -> int:
        from force_diffusion.derivations.commands.cli import run

        return run(arguments)

    return guarded(program)


if __name__ == "__main__":
    raise SystemExit(main())
