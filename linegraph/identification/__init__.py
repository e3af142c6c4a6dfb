"""Which parameters a motion can identify: standard parameters, base parameters and the regressor."""
