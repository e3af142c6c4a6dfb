"""Derivations over floats: the reference, positions that close all loops, one state in two trees."""
