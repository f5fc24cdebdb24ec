"""See `campaign`."""

import argparse
import sys

from tests.muster_robots.kills.campaign import killed


def main(arguments):
    """Kill, and say how often what happened."""
    parser = argparse.ArgumentParser(description="Kill Muster while it commands robots, and let it go on.")
    parser.add_argument("kills", type=int, nargs="?", default=1000)
    parser.add_argument("--first", type=int, default=0, metavar="SEED")
    asked = parser.parse_args(arguments)
    counted = killed(asked.kills, asked.first, tell=lambda so_far: sys.stderr.write(f"{_words(so_far)}\n"))
    sys.stdout.write(f"{_words(counted)}\n")


def _words(counted):
    return ", ".join(f"{count} {what}" for what, count in counted.items())


if __name__ == "__main__":
    main(sys.argv[1:])
