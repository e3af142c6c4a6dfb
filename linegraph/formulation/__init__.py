"""The choice of trees, which decides the coordinates.

`formulate` chooses the trees in translation and in rotation, by weights or as the user requests; `planarity`
finds bodies that turn about one direction only; `absolute` has coordinates relative to ground.
"""
