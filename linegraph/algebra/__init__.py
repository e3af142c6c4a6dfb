"""The algebras over which derivations run.

The protocol `Algebra` (`protocol`) and its instances: floats, the expression DAG, SymPy expressions
(`sympy_scalars`), jets with two time derivatives (`jets`) and sampled values (`sampled`). On the DAG:
differentiation, antiderivatives and exact residues. Over any algebra: powers, roots and the factorisation
LᵀDL. Formulas that users write are parsed by `formula` and never executed.
"""
