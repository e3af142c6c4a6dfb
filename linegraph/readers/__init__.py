"""Readers of models from files."""
