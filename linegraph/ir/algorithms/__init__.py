"""What emitted functions do that iterate or decide: each algorithm written once, for all languages.

An algorithm is a Python function over numbers and arrays of them. `linegraph.ir.reading` reads its text
into statements, which every language prints; Python runs the same text as it is, as the reference and in
tests. What may stand in it is what languages without objects have, too: whole and real numbers, arrays of
fixed size, loops over ranges, decisions, calls. A function that takes ``module`` depends on the model: on
its counts, on where its coordinates are, and on its other emitted functions
(`linegraph.ir.algorithms.language.ModuleAtState`).

Arrays are passed one by one, outputs last, since records of arrays are not what all languages have. A
condition of counts and other facts of the model alone is decided before anything is printed.

Arguments of long calls are unpacked from tuples, a tuple for each line. Conditional expressions stand where
``min`` and ``max`` would hide a NaN; `larger` is the maximum that every language has.
"""
