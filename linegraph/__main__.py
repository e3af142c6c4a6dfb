"""`python -m linegraph`: the same as the command `linegraph`."""

from linegraph.cli import main

main(prog_name="linegraph")
