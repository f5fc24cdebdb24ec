"""`python -m muster.cli`: the command, where it is not on the path."""

from muster.cli.main import main

main()
