"""The functions that linegraph emits, as programs over an expression DAG.

`register` lists all of them, `workspace` holds the equations that they share, and each family of
functions has a file of its own.
"""
