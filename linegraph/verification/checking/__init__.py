"""Whether a model's equations hold: `linegraph check`.

At random states, drawn where the model is defined, the equations of motion that would be emitted are compared
with Newton's and Euler's equations of every body, from derivatives of its place (`golden`): another route.
So are the same derivation over floats and the paper's matrices multiplied out. With loops the number of
freedoms, accelerations and multipliers are compared as well. Along the motion the rate of energy is the power
of all that is applied, through times across sums up to zero in each subspace, and every component of a
network stores or turns into heat what it takes in.

Each number is compared on the scale of the terms that it is made of, as golden vectors are.
"""

from linegraph.verification.checking.findings import TOLERANCE, Comparison, Findings
from linegraph.verification.checking.report import report
from linegraph.verification.checking.routes import _State
from linegraph.verification.checking.run import STATES, check

__all__ = ["STATES", "TOLERANCE", "Comparison", "Findings", "_State", "check", "report"]
