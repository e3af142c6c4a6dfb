"""Derivations over floats: the reference, positions that close all loops, change of coordinates."""
