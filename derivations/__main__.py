"""Where the program starts: an interrupt while it loads ends it as quietly as any later one."""

import sys


def main() -> int:
    """Load the command line and run it."""
    try:
        from derivations.cli import main as run
    except KeyboardInterrupt:
        print("force-diffusion: interrupted.", file=sys.stderr)
        return 130
    return run()


if __name__ == "__main__":
    raise SystemExit(main())
