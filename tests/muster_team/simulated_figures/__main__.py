"""Print the figures of docs/negotiation.md: `python -m tests.muster_team.simulated_figures [RUNS]`."""

import argparse
import sys

from tests.muster_team.simulated_figures.figures import lines


def main() -> None:
    """Print the figures, each as soon as it is known."""
    parser = argparse.ArgumentParser(prog="python -m tests.muster_team.simulated_figures", description=__doc__)
    parser.add_argument("runs", type=int, nargs="?", default=100)
    for line in lines(parser.parse_args().runs):
        sys.stdout.write(f"{line}\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
