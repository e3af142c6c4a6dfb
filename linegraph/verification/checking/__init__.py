"""`linegraph check`: whether the equations derived for a model hold.

At random admissible states the equations of motion that would be emitted are compared with Newton's and
Euler's equations of every body (`golden`), which are computed independently. The same derivation over
floats and the paper's matrices are compared with these, too. With loops, so are the number of degrees of
freedom, accelerations and multipliers. Along the motion the rate of energy must equal the power of all
applied forces, the sum of through times across must vanish in each subspace, and every component of a
network must store or turn into heat the power that it takes in.

Each number is compared on the scale of the terms that it is the sum of, as in golden vectors.
"""

from linegraph.verification.checking.findings import TOLERANCE, Comparison, Findings
from linegraph.verification.checking.report import report
from linegraph.verification.checking.routes import _State
from linegraph.verification.checking.run import STATES, check

__all__ = ["STATES", "TOLERANCE", "Comparison", "Findings", "_State", "check", "report"]
