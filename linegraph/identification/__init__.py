"""Which parameters motion can tell apart: standard and base parameters, and the regressor."""
