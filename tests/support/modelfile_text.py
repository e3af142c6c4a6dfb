"""Model files for tests: one with a bit of everything, and a small one to break."""

from __future__ import annotations

ZOO = """\
name = "zoo"
description = '''Every kind of table,
every kind of value'''

[parameters]
g = 9.81
L = { value = 0.2, unit = "m", about = "length" }
m = {value = 0.5, unit = "kg"}
l = "L/2"
J = "m*l**2/3"
w = 2.0
tilt = 0.3

[inputs]
push = { unit = "N", about = "a push" }
"wind" = {}

[gravity]
acceleration = [0, 0, "-g"]

[frame.hook]
at = [0, 0, 1]
[frame.ramp]
axis = [0, 1, 0]
angle = "tilt"

[body.cart]
mass = "2*m"
inertia = [0.1, "J", 0.1]
frame.eye = { at = ["L", 0, 0], rpy = [0, "pi/2", 0] }
frame."other eye" = { at = [0, "-L", 0] }

[body.arm]
mass = "m"
mass_center = [0, 0, "-l"]
inertia = { xx = "J", yy = "J", zz = 0 }
frame.tip.at = [0, 0, "-L"]

[body.hand]
mass = 0.1
first_moment = [0.01, 0, 0]
inertia = [
    [0.01, 0, 0],   # rows
    [0, 0.01, 0],
    [0, 0, "m*L**2/10"],
]

[body.finger]
mass = 0.05
inertia = [1e-3, 1e-3, 1e-3]
[body.thumb]
mass = 0.05
inertia = [1e-3, 1e-3, 1e-3]
[body.ball]
mass = 1
inertia = [0.1, 0.1, 0.1]
[body.nut]
mass = 1
inertia = [0.1, 0.1, 0.1]

[prismatic.slide]
between = ["ground.ramp", "cart"]
axis = ["cos(pi/6)", "1/2", 0]
effort = false

[revolute.swing]
between = ["cart.eye", "arm"]
axis = [0, 1, 0]

[universal.wrist]
between = ["arm.tip", "hand"]
axes = [[1, 0, 0], [0, 1, 0]]
effort = false

[revolute.knuckle]
between = ["hand", "finger"]
axis = [0, 0, 1]

[revolute.knuckle2]
between = ["hand", "thumb"]
axis = [0, 0, 1]
follows = { joint = "knuckle", ratio = -1, offset = 0.1 }

[spherical.socket]
between = ["cart", "ball"]
angles = "xyz"

[compound.screw]
between = ["cart", "nut"]
parts = [
    { type = "revolute", axis = [1, 0, 0] },
    { type = "helical", axis = [0, 0, 1], lead = "L/10" },
]

[body.turret]
[revolute.turn]
between = ["ground", "turret"]
axis = [0, 0, 1]
motion = "0.1*sin(w*t)"

[body.lift]
mass = 1
[prismatic.up]
between = ["turret", "lift"]
axis = [0, 0, 1]
motion = "input"

[spring.strut]
between = ["ground.hook", "cart.other eye"]
force = "20*x + 3*x**3 + 0.1*v"
length = 0.4
[spring.return]
joint = "slide"
stiffness = "g/L"
[damper.bearing]
joint = "swing"
damping = 1e-4
[friction.rail]
joint = "slide"
viscous = 0.1
coulomb = 0.2
width = 1e-2
[stop.end]
joint = "knuckle"
lower = -1
upper = "pi/2"
stiffness = 100.0
[law.pull]
between = ["ball", "nut"]
force = "push*sin(w*t)/(1 + x**2) + der(swing)"

[load.gust]
at = "arm.tip"
force = ["wind", 0, "-slide"]
torque = [0, "0.1*sqrt(2 + der(slide)**2)", 0]
axes = "body"

[rotor.motor]
joint = "swing"
inertia = 1e-5
ratio = 50
"""

SMALL = """\
name = "small"
[parameters]
m = 1.5
L = { value = 0.2, unit = "m" }
l = "L/2"
[inputs]
push = { unit = "N" }
[body.arm]
mass = "m"
inertia = [0.1, 0.1, 0.1]
frame.tip = { at = [0, 0, "L"] }
[revolute.hinge]
between = ["ground", "arm"]
axis = [0, 1, 0]
"""
"""A sound model: cases append to it, from line 15 on, or replace a line."""

LOOP = """\
name = "loop"
[parameters]
a = { value = 0.1, unit = "m" }
[inputs]
push = { unit = "N" }
[frame.pivot]
at = [0.35, 0, 0]
[body.crank]
mass = 0.2
inertia = [1e-4, 1e-4, 1e-4]
frame.tip.at = ["a", 0, 0]
[body.coupler]
mass = 0.8
inertia = [1e-2, 1e-2, 1e-2]
frame.tip.at = [0.4, 0, 0]
[body.rocker]
mass = 0.6
inertia = [5e-3, 5e-3, 5e-3]
frame.tip.at = [0.3, 0, 0]
[revolute.motor]
between = ["ground", "crank"]
axis = [0, 0, 1]
start = 0.8
[revolute.elbow]
between = ["crank.tip", "coupler"]
axis = [0, 0, 1]
start = 0
[revolute.swing]
between = ["ground.pivot", "rocker"]
axis = [0, 0, 1]
start = 1.2
[revolute.knee]
between = ["coupler.tip", "rocker.tip"]
axis = [0, 0, 1]
[spring.coil]
joint = "swing"
stiffness = 2
"""
"""A four-bar linkage, sound as well: knee is cut."""
