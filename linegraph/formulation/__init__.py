"""What was chosen.

The trees in translation and in rotation, by weights or by wish (`formulate`); bodies that turn about one
direction only (`planarity`); coordinates relative to ground (`absolute`).
"""
