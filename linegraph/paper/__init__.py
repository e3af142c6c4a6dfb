"""The matrices of [Boiadzhiev and Lilov 1993], literally, for comparison with the recursive derivation.

`joint_form` has one row and column for each joint; `star_tree`, `star_form` and `star_inverse` have the star
tree of the paper itself, its equations and its inverse scheme.
"""
