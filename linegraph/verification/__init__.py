"""The same numbers by another route: golden vectors and `check`."""
