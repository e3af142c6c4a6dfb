"""The functions that linegraph promises to emit.

The register (`register`), what all functions share (`workspace`), and one file for each family of functions.
"""
