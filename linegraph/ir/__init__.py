"""What code is emitted from.

The expression DAG (`dag`), the elementary functions (`functions`), programs made of arguments, single
assignments, results and checks (`program`), golden vectors as data (`golden_vectors`), passes from program to
program (`sums`, `parameter_constants`, `prologue`) and an interpreter. Nothing here knows mechanics, and
`codegen` stands on this package alone.
"""
