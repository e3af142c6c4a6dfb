"""Worked scalar networks from textbooks and course notes, with the state equations printed there.

Each is a graph of elements in the model language and the matrices of ``x' = A x + B u + E u'`` and
``y = C x + D u + F u'`` as text. The graphs are drawn so that elemental, continuity and compatibility
equations are those of the source; where the source departs from its own graph, `remark` says how.

Element lists and matrices are facts, quoted from

* D. Rowell and D. N. Wormley, System Dynamics: An Introduction, Prentice Hall 1997, chapter 5;
* C. Devine, J. L. Garbini and R. A. R. Picone, StateMint (CameronDevine/StateMint): the test suite, which
  restates many of these examples, and the tutorial;
* D. Rowell, MIT 2.151 handouts "Linear Graph Modeling: State Equation Formulation" and "Two-Port Energy
  Transducing Elements", and other textbooks, by the element lists in the examples of LGtheory
  (GRASP-ONTechU/Linear_Graph).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

Rows = tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Published:
    """A network and what is printed of it.

    Attributes:
        name: of the model, and of the case.
        source: where it is printed.
        model: a model file.
        states: the names they have here, in the order of the rows below, which need not be the emitted one.
        signs: +1, or -1 where the printed state is the negative of ours: ``printed = signs * ours``.
        inputs: in the order of the columns of B, D, E and F.
        A: rows of expressions in the parameters, for the printed states. Of a nonlinear system this is the
            Jacobian of `rates`, and names states too; empty if none is printed.
        B: the columns of the inputs; rows are empty where there is no input.
        E: the columns of the inputs' derivatives; empty if there is none.
        outputs: in the order of the rows of C, D and F.
        C: outputs by states.
        D: outputs by inputs.
        F: outputs by the inputs' derivatives; empty if there is none.
        rates: of a nonlinear system the derivative of each state.
        printed: whether the source prints these very equations; else they were derived by hand from its
            element list, or corrected.
        remark: slips and choices.
    """

    name: str
    source: str
    model: str
    states: tuple[str, ...]
    signs: tuple[int, ...]
    inputs: tuple[str, ...]
    A: Rows
    B: Rows
    E: Rows = ()
    outputs: tuple[str, ...] = ()
    C: Rows = ()
    D: Rows = ()
    F: Rows = ()
    rates: tuple[str, ...] = ()
    printed: bool = True
    remark: str = ""


def rows(*lines: str) -> Rows:
    """A matrix of texts, its entries separated by commas.

    Example:
        >>> rows("-1/(R*C), 0", "1/L, -R/L")
        (('-1/(R*C)', '0'), ('1/L', '-R/L'))
    """
    return tuple(tuple(entry.strip() for entry in line.split(",")) for line in lines)


def rebuilt(network: Published, name: str, old: str, new: str, remark: str) -> Published:
    """The same network with some of its components written otherwise."""
    parts = network.model.split(old)
    if len(parts) != 2:
        raise ValueError(
            f"{name}: what it replaces stands {len(parts) - 1} times in {network.name}"
        )
    model = new.join(parts).replace(f'name = "{network.name}"', f'name = "{name}"')
    return replace(network, name=name, model=model, remark=remark)


# ---- J. L. Garbini's suite

QUARTER_CAR = Published(
    name="quarter_car",
    source="StateMint test system 1, Garbini's test suite",
    model="""
name = "quarter_car"

[parameters]
MB = 2.3
MW = 0.7
KS = 1.9
KT = 5.1
BS = 0.45
BT = 0.31

[inputs]
vS = { unit = "m/s", about = "vertical velocity of the road" }

[velocity_source.road]
between = ["road", "ground"]
velocity = "vS"

[mass.MB]
between = ["car", "ground"]
mass = "MB"

[mass.MW]
between = ["wheel", "ground"]
mass = "MW"

[translational_spring.KS]
between = ["wheel", "car"]
stiffness = "KS"

[translational_spring.KT]
between = ["road", "wheel"]
stiffness = "KT"

[translational_damper.BS]
between = ["wheel", "car"]
damping = "BS"

[translational_damper.BT]
between = ["road", "wheel"]
damping = "BT"

[outputs]
vMB = "across(MB)"
vMW = "across(MW)"
fKS = "through(KS)"
fKT = "through(KT)"
fBS = "through(BS)"
fBT = "through(BT)"
""",
    states=("v_MB", "v_MW", "F_KS", "F_KT"),
    signs=(1, 1, 1, 1),
    inputs=("vS",),
    A=rows(
        "-BS/MB, BS/MB, 1/MB, 0",
        "BS/MW, (-BS - BT)/MW, -1/MW, 1/MW",
        "-KS, KS, 0, 0",
        "0, -KT, 0, 0",
    ),
    B=rows("0", "BT/MW", "0", "KT"),
    outputs=("vMB", "vMW", "fKS", "fKT", "fBS", "fBT"),
    C=rows(
        "1, 0, 0, 0",
        "0, 1, 0, 0",
        "0, 0, 1, 0",
        "0, 0, 0, 1",
        "-BS, BS, 0, 0",
        "0, -BT, 0, 0",
    ),
    D=rows("0", "0", "0", "0", "0", "BT"),
)

MOTOR_AND_PULLEY = Published(
    name="motor_and_pulley",
    source="StateMint test system 2, Garbini's test suite",
    model="""
name = "motor_and_pulley"

[parameters]
JM = 0.9
JL = 2.6
R = 1.7
B = 0.35
Km = 0.8
n = 3.2

[inputs]
vI = { unit = "V" }

[voltage_source.supply]
between = ["plus", "ground"]
voltage = "vI"

[resistor.R]
between = ["plus", "brush"]
resistance = "R"

[dc_motor.motor]
between = ["brush", "ground"]
shaft = ["ground", "shaft"]
constant = "Km"
resistance = 0

[inertia.JM]
between = ["shaft", "ground"]
inertia = "JM"

[rotational_damper.B]
between = ["shaft", "ground"]
damping = "B"

[gear.pulley]
between = ["shaft", "ground"]
second = ["load", "ground"]
ratio = "n"

[inertia.JL]
between = ["load", "ground"]
inertia = "JL"

[outputs]
oJM = "across(JM)"
oJL = "across(JL)"
iR = "through(R)"
vR = "across(R)"
""",
    states=("w_JM",),
    signs=(1,),
    inputs=("vI",),
    A=rows("-(n**2*Km**2 + n**2*R*B)/(R*n**2*JM + JL*R)"),
    B=rows("-n**2*Km/(R*n**2*JM + R*JL)"),
    outputs=("oJM", "oJL", "iR", "vR"),
    C=rows("1", "1/n", "Km/R", "Km"),
    D=rows("0", "0", "1/R", "1"),
    remark="The inertia of the load depends on that of the motor. The printed motor has v1 = -Km w: here "
    "its shaft is the edge from ground to the shaft.",
)

INERTIAL_ACTUATOR = Published(
    name="inertial_actuator",
    source="StateMint test system 3, Garbini's test suite",
    model="""
name = "inertial_actuator"

[parameters]
M = 1.4
K = 3.7
B = 0.55
R = 2.1
Km = 0.85

[inputs]
ec = { unit = "V", about = "voltage at the coil" }
vs = { unit = "m/s", about = "velocity of the structure" }

[voltage_source.amplifier]
between = ["plus", "ground"]
voltage = "ec"

[velocity_source.structure]
between = ["structure", "ground"]
velocity = "vs"

[resistor.R]
between = ["plus", "coil"]
resistance = "R"

[voltage_source.coil]
between = ["coil", "ground"]
voltage = "-Km*across(magnet)"

[force_source.magnet]
between = ["mass", "structure"]
force = "Km*through(coil)"

[mass.M]
between = ["mass", "ground"]
mass = "M"

[translational_spring.K]
between = ["mass", "structure"]
stiffness = "K"

[translational_damper.B]
between = ["mass", "structure"]
damping = "B"

[outputs]
fM = "through(M)"
""",
    states=("v_M", "F_K"),
    signs=(1, 1),
    inputs=("ec", "vs"),
    A=rows("-(Km**2 + B*R)/(M*R), -1/M", "K, 0"),
    B=rows("-Km/(M*R), (Km**2 + B*R)/(M*R)", "0, -K"),
    outputs=("fM",),
    C=rows("-(Km**2 + B*R)/R, -1"),
    D=rows("-Km/R, (Km**2 + B*R)/R"),
    remark="The voice coil, e1 = -Km V2 and f2 = Km i1, is a pair of controlled sources.",
)

INERTIAL_ACTUATOR_COIL = rebuilt(
    INERTIAL_ACTUATOR,
    "inertial_actuator_coil",
    """
[voltage_source.coil]
between = ["coil", "ground"]
voltage = "-Km*across(magnet)"

[force_source.magnet]
between = ["mass", "structure"]
force = "Km*through(coil)"
""",
    """
[moving_coil.coil]
between = ["coil", "ground"]
shaft = ["structure", "mass"]
constant = "Km"
""",
    "The voice coil is a transducer.",
)

ME_471 = Published(
    name="motor_and_spring",
    source="StateMint test system 4, Garbini's test suite, ME 471",
    model="""
name = "motor_and_spring"

[parameters]
J = 1.6
K = 4.3
R = 0.75
Km = 1.15

[inputs]
vs = { unit = "V" }

[voltage_source.supply]
between = ["plus", "ground"]
voltage = "vs"

[resistor.R]
between = ["plus", "brush"]
resistance = "R"

[dc_motor.motor]
between = ["brush", "ground"]
shaft = ["shaft", "ground"]
constant = "Km"
resistance = 0

[inertia.J]
between = ["shaft", "ground"]
inertia = "J"

[rotational_spring.K]
between = ["shaft", "ground"]
stiffness = "K"

[outputs]
tK = "through(K)"
oJ = "across(J)"
""",
    states=("w_J", "tau_K"),
    signs=(1, 1),
    inputs=("vs",),
    A=rows("-Km**2/(J*R), -1/J", "K, 0"),
    B=rows("Km/(J*R)", "0"),
    outputs=("tK", "oJ"),
    C=rows("0, 1", "1, 0"),
    D=rows("0", "0"),
)

# ---- Rowell and Wormley, chapter 5

EXAMPLE_5_1 = Published(
    name="rowell_wormley_5_1",
    source="Rowell and Wormley 1997, Example 5.1; MIT 2.151 State Equation Formulation, eq. (16); StateMint "
    "test system 5",
    model="""
name = "rowell_wormley_5_1"

[parameters]
R = 1.3
L = 0.7
C = 2.2

[inputs]
Vs = { unit = "V" }

[voltage_source.source]
between = ["a", "ground"]
voltage = "Vs"

[resistor.R]
between = ["a", "b"]
resistance = "R"

[capacitor.C]
between = ["b", "ground"]
capacitance = "C"

[inductor.L]
between = ["b", "ground"]
inductance = "L"

[outputs]
iR = "through(R)"
vR = "across(R)"
vL = "across(L)"
iC = "through(C)"
""",
    states=("v_C", "i_L"),
    signs=(1, 1),
    inputs=("Vs",),
    A=rows("-1/(R*C), -1/C", "1/L, 0"),
    B=rows("1/(R*C)", "0"),
    outputs=("iR", "vR", "vL", "iC"),
    C=rows("-1/R, 0", "-1, 0", "1, 0", "-1/R, -1"),
    D=rows("1/R", "1", "0", "1/R"),
)

EXAMPLE_5_2 = Published(
    name="rowell_wormley_5_2",
    source="Rowell and Wormley 1997, Example 5.2; StateMint test system 6",
    model="""
name = "rowell_wormley_5_2"

[parameters]
m = 1.7
K = 0.6

[inputs]
Fs = { unit = "N" }

[force_source.source]
between = ["ground", "a"]
force = "Fs"

[mass.m]
between = ["a", "ground"]
mass = "m"

[translational_spring.k]
between = ["a", "ground"]
stiffness = "K"

[outputs]
vm = "across(m)"
""",
    states=("v_m", "F_k"),
    signs=(1, 1),
    inputs=("Fs",),
    A=rows("0, -1/m", "K, 0"),
    B=rows("1/m", "0"),
    outputs=("vm",),
    C=rows("1, 0"),
    D=rows("0"),
)

EXAMPLE_5_3 = Published(
    name="rowell_wormley_5_3",
    source="Rowell and Wormley 1997, Example 5.3; StateMint test system 7",
    model="""
name = "rowell_wormley_5_3"

[parameters]
m = 0.9
K = 2.4
B = 0.35

[inputs]
Fs = { unit = "N" }

[force_source.source]
between = ["ground", "a"]
force = "Fs"

[mass.m]
between = ["a", "ground"]
mass = "m"

[translational_spring.k]
between = ["a", "ground"]
stiffness = "K"

[translational_damper.B]
between = ["a", "ground"]
damping = "B"

[outputs]
vm = "across(m)"
Fk = "through(k)"
""",
    states=("v_m", "F_k"),
    signs=(1, 1),
    inputs=("Fs",),
    A=rows("-B/m, -1/m", "K, 0"),
    B=rows("1/m", "0"),
    outputs=("vm", "Fk"),
    C=rows("1, 0", "0, 1"),
    D=rows("0", "0"),
)

EXAMPLE_5_4 = Published(
    name="rowell_wormley_5_4",
    source="Rowell and Wormley 1997, Example 5.4; StateMint test system 8",
    model="""
name = "rowell_wormley_5_4"

[parameters]
J = 1.8
B1 = 0.4
B2 = 1.3

[inputs]
ws = { unit = "rad/s" }

[angular_velocity_source.source]
between = ["drive", "ground"]
velocity = "ws"

[inertia.j]
between = ["flywheel", "ground"]
inertia = "J"

[rotational_damper.B1]
between = ["flywheel", "ground"]
damping = "B1"

[rotational_damper.B2]
between = ["drive", "flywheel"]
damping = "B2"

[outputs]
wj = "across(j)"
""",
    states=("w_j",),
    signs=(1,),
    inputs=("ws",),
    A=rows("-(B1 + B2)/J"),
    B=rows("B2/J"),
    outputs=("wj",),
    C=rows("1"),
    D=rows("0"),
    remark="StateMint notes that the indices 1 and 2 are interchanged in equation (iii) of the book.",
)

EXAMPLE_5_5 = Published(
    name="rowell_wormley_5_5",
    source="Rowell and Wormley 1997, Example 5.5; StateMint test system 9",
    model="""
name = "rowell_wormley_5_5"

[parameters]
R = 2.7
L = 0.8
C = 1.4

[inputs]
Vs = { unit = "V" }

[voltage_source.source]
between = ["a", "ground"]
voltage = "Vs"

[resistor.R]
between = ["a", "b"]
resistance = "R"

[inductor.L]
between = ["b", "c"]
inductance = "L"

[capacitor.C]
between = ["c", "ground"]
capacitance = "C"

[outputs]
vL = "across(L)"
iC = "through(C)"
vC = "across(C)"
""",
    states=("v_C", "i_L"),
    signs=(1, 1),
    inputs=("Vs",),
    A=rows("0, 1/C", "-1/L, -R/L"),
    B=rows("0", "1/L"),
    outputs=("vL", "iC", "vC"),
    C=rows("-1, -R", "0, 1", "1, 0"),
    D=rows("1", "0", "0"),
)

EXAMPLE_5_6 = Published(
    name="rowell_wormley_5_6",
    source="Rowell and Wormley 1997, Example 5.6; StateMint test system 10",
    model="""
name = "rowell_wormley_5_6"

[parameters]
Rp = 0.9
Ip = 1.6
R1 = 3.1
C = 0.45

[inputs]
Ps = { unit = "Pa" }

[pressure_source.pump]
between = ["a", "ground"]
pressure = "Ps"

[pipe.Rp]
between = ["a", "b"]
resistance = "Rp"

[inertance.Ip]
between = ["b", "tank"]
inertance = "Ip"

[accumulator.C]
between = ["tank", "ground"]
capacity = "C"

[pipe.R1]
between = ["tank", "ground"]
resistance = "R1"

[outputs]
PC = "across(C)"
QIp = "through(Ip)"
""",
    states=("p_C", "Q_Ip"),
    signs=(1, 1),
    inputs=("Ps",),
    A=rows("-1/(R1*C), 1/C", "-1/Ip, -Rp/Ip"),
    B=rows("0", "1/Ip"),
    outputs=("PC", "QIp"),
    C=rows("1, 0", "0, 1"),
    D=rows("0", "0"),
)

EXAMPLE_5_7 = Published(
    name="rowell_wormley_5_7",
    source="Rowell and Wormley 1997, Example 5.7; StateMint test system 11",
    model="""
name = "rowell_wormley_5_7"

[parameters]
C = 5.3
R1 = 0.85
R2 = 1.9

[inputs]
Qs = { unit = "W" }

[heat_source.source]
between = ["ground", "a"]
heat = "Qs"

[conduction.R1]
between = ["a", "b"]
conductance = "1/R1"

[conduction.R2]
between = ["a", "ground"]
conductance = "1/R2"

[heat_capacity.c]
between = ["b", "ground"]
capacity = "C"

[outputs]
Tc = "across(c)"
""",
    states=("T_c",),
    signs=(1,),
    inputs=("Qs",),
    A=rows("-1/(C*(R1 + R2))"),
    B=rows("R2/(C*(R1 + R2))"),
    outputs=("Tc",),
    C=rows("1"),
    D=rows("0"),
)

EXAMPLE_5_8 = Published(
    name="rowell_wormley_5_8",
    source="Rowell and Wormley 1997, Example 5.8 (p. 146); MIT 2.151 State Equation Formulation, Fig. 16; "
    "element list in LGtheory",
    model="""
name = "rowell_wormley_5_8"

[parameters]
C1 = 1.2
C2 = 0.5
R1 = 2.9
R2 = 0.65

[inputs]
Vs = { unit = "V" }

[voltage_source.source]
between = ["a", "ground"]
voltage = "Vs"

[capacitor.C2]
between = ["b", "ground"]
capacitance = "C2"

[capacitor.C1]
between = ["a", "b"]
capacitance = "C1"

[resistor.R1]
between = ["a", "b"]
resistance = "R1"

[resistor.R2]
between = ["b", "ground"]
resistance = "R2"

[outputs]
iC1 = "through(C1)"
""",
    states=("v_C2",),
    signs=(1,),
    inputs=("Vs",),
    A=rows("-(R1 + R2)/(R1*R2*(C1 + C2))"),
    B=rows("1/(R1*(C1 + C2))"),
    E=rows("C1/(C1 + C2)"),
    outputs=("iC1",),
    C=rows("C1*(R1 + R2)/(R1*R2*(C1 + C2))"),
    D=rows("-C1/(R1*(C1 + C2))"),
    F=rows("C1*C2/(C1 + C2)"),
    printed=False,
    remark="Both capacitors and the source form a loop: one state, and the derivative of the input.",
)

EXAMPLE_5_9 = Published(
    name="rowell_wormley_5_9",
    source="Rowell and Wormley 1997, Example 5.9; MIT 2.151 State Equation Formulation, Fig. 17; StateMint "
    "test system 12",
    model="""
name = "rowell_wormley_5_9"

[parameters]
m = 2.1
K1 = 0.9
K2 = 1.6
B1 = 0.75
B2 = 0.3

[inputs]
Fs = { unit = "N" }

[force_source.source]
between = ["ground", "a"]
force = "Fs"

[mass.m]
between = ["c", "ground"]
mass = "m"

[translational_spring.K1]
between = ["a", "b"]
stiffness = "K1"

[translational_spring.K2]
between = ["a", "c"]
stiffness = "K2"

[translational_damper.B1]
between = ["b", "c"]
damping = "B1"

[translational_damper.B2]
between = ["c", "ground"]
damping = "B2"

[outputs]
vB1 = "across(B1)"
""",
    states=("v_m", "F_K1"),
    signs=(1, 1),
    inputs=("Fs",),
    A=rows("-B2/m, 0", "0, -K1*K2/(B1*(K1 + K2))"),
    B=rows("1/m", "0"),
    E=rows("0", "K1/(K1 + K2)"),
    outputs=("vB1",),
    C=rows("0, 1/B1"),
    D=rows("0"),
    remark="Both springs and the source form a cutset: K2 depends on K1 and on the input.",
)

EXAMPLE_5_11 = Published(
    name="rowell_wormley_5_11",
    source="Rowell and Wormley 1997, Example 5.11; StateMint test system 13",
    model="""
name = "rowell_wormley_5_11"

[parameters]
m = 1.9
cd = 0.35

[inputs]
Fp = { unit = "N", about = "propulsion" }
F0 = { unit = "N", about = "rolling resistance" }

[force_source.propulsion]
between = ["ground", "car"]
force = "Fp"

[force_source.rolling]
between = ["car", "ground"]
force = "F0"

[mass.m]
between = ["car", "ground"]
mass = "m"

[element.d]
between = ["car", "ground"]
domain = "translation_1d"
law = "y = cd*x**2"

[outputs]
vm = "across(m)"
""",
    states=("v_m",),
    signs=(1,),
    inputs=("Fp", "F0"),
    A=rows("-2*cd*v_m/m"),
    B=rows("1/m, -1/m"),
    outputs=("vm",),
    C=rows("1"),
    D=rows("0, 0"),
    rates=("(Fp - F0 - cd*v_m**2)/m",),
    remark="The printed drag cd v^2 holds for v >= 0.",
)

EXAMPLE_5_12 = Published(
    name="rowell_wormley_5_12",
    source="Rowell and Wormley 1997, Example 5.12; StateMint test system 14",
    model="""
name = "rowell_wormley_5_12"

[parameters]
J = 1.3
B = 0.25
m = 0.7
g = 9.81
l = 0.55
theta = 0.4

[inputs]
Ts = { unit = "N*m" }

[torque_source.source]
between = ["ground", "a"]
torque = "Ts"

[inertia.j]
between = ["a", "ground"]
inertia = "J"

[rotational_damper.B]
between = ["a", "ground"]
damping = "B"

[rotational_spring.K]
between = ["a", "ground"]
stiffness = "m*g*l*cos(theta)"

[outputs]
TK = "through(K)"
""",
    states=("w_j", "tau_K"),
    signs=(1, 1),
    inputs=("Ts",),
    A=rows("-B/J, -1/J", "m*g*l*cos(theta), 0"),
    B=rows("1/J", "0"),
    outputs=("TK",),
    C=rows("0, 1"),
    D=rows("0"),
    remark="A pendulum: the torque of its weight is the state, and the angle in its stiffness is printed as "
    "a constant.",
)

EXAMPLE_5_12_ANGLE = Published(
    name="rowell_wormley_5_12_angle",
    source="Rowell and Wormley 1997, Example 5.12, its angle as a state",
    model="""
name = "rowell_wormley_5_12_angle"

[parameters]
J = 1.3
B = 0.25
m = 0.7
g = 9.81
l = 0.55

[inputs]
Ts = { unit = "N*m" }

[torque_source.source]
between = ["ground", "a"]
torque = "Ts"

[inertia.j]
between = ["a", "ground"]
inertia = "J"

[rotational_damper.B]
between = ["a", "ground"]
damping = "B"

[element.K]
between = ["a", "ground"]
domain = "rotation_1d"
law = "y = m*g*l*sin(s)"
rate = "x"

[outputs]
TK = "through(K)"
""",
    states=("w_j", "s_K"),
    signs=(1, 1),
    inputs=("Ts",),
    A=rows("-B/J, -m*g*l*cos(s_K)/J", "1, 0"),
    B=rows("1/J", "0"),
    outputs=("TK",),
    C=rows("0, m*g*l*cos(s_K)"),
    D=rows("0"),
    rates=("(Ts - B*w_j - m*g*l*sin(s_K))/J", "w_j"),
    printed=False,
    remark="The same pendulum with theta' = w. A, B, C and D are Jacobians.",
)

EXAMPLE_5_13 = Published(
    name="rowell_wormley_5_13",
    source="Rowell and Wormley 1997, Example 5.13; StateMint test system 15",
    model="""
name = "rowell_wormley_5_13"

[parameters]
i = 0.8
KT0 = 1.1
KT1 = 0.35
KT2 = 0.15
K1 = 0.6
K2 = 1.7

[inputs]
Qs = { unit = "m^3/s" }

[flow_source.source]
between = ["ground", "tank"]
flow = "Qs"

[accumulator.C]
between = ["tank", "ground"]
volume = "KT0*x + KT1*x**2/2 + KT2*x**3/3"

[element.R1]
between = ["tank", "ground"]
domain = "hydraulic"
law = "y = K1*sqrt(abs(x))*sign(x)"

# takes the pressure of the tank, but nothing out of it
[pressure_source.copy]
between = ["a", "ground"]
pressure = "across(C)"

[inertance.I]
between = ["a", "b"]
inertance = "i"

[element.R2]
between = ["b", "ground"]
domain = "hydraulic"
law = "x = y*abs(y)/K2**2"

[outputs]
QI = "through(I)"
PC = "across(C)"
""",
    states=("Q_I", "p_C"),
    signs=(1, 1),
    inputs=("Qs",),
    A=(),
    B=(),
    outputs=("QI", "PC"),
    C=rows("1, 0", "0, 1"),
    D=rows("0", "0"),
    rates=(
        "(p_C - Q_I*abs(Q_I)/K2**2)/i",
        "(Qs - K1*sqrt(abs(p_C))*sign(p_C))/(KT0 + KT1*p_C + KT2*p_C**2)",
    ),
    remark="As printed, QC = Qs - QR1: the continuity equation of the tank lacks the flow Q_I of the line, "
    "whose compatibility equation PI = PC - PR2 starts at the tank. A source that copies the pressure of the "
    "tank stands for that here.",
)

EXAMPLE_5_13_CORRECTED = Published(
    name="rowell_wormley_5_13_corrected",
    source="Rowell and Wormley 1997, Example 5.13, with the flow of the line taken from the tank",
    model="""
name = "rowell_wormley_5_13_corrected"

[parameters]
i = 0.8
KT0 = 1.1
KT1 = 0.35
KT2 = 0.15
K1 = 0.6
K2 = 1.7

[inputs]
Qs = { unit = "m^3/s" }

[flow_source.source]
between = ["ground", "tank"]
flow = "Qs"

[accumulator.C]
between = ["tank", "ground"]
volume = "KT0*x + KT1*x**2/2 + KT2*x**3/3"

[element.R1]
between = ["tank", "ground"]
domain = "hydraulic"
law = "y = K1*sqrt(abs(x))*sign(x)"

[inertance.I]
between = ["tank", "b"]
inertance = "i"

[element.R2]
between = ["b", "ground"]
domain = "hydraulic"
law = "x = y*abs(y)/K2**2"

[outputs]
QI = "through(I)"
PC = "across(C)"
""",
    states=("Q_I", "p_C"),
    signs=(1, 1),
    inputs=("Qs",),
    A=(),
    B=(),
    outputs=("QI", "PC"),
    C=rows("1, 0", "0, 1"),
    D=rows("0", "0"),
    rates=(
        "(p_C - Q_I*abs(Q_I)/K2**2)/i",
        "(Qs - Q_I - K1*sqrt(abs(p_C))*sign(p_C))/(KT0 + KT1*p_C + KT2*p_C**2)",
    ),
    printed=False,
    remark="The printed equations with QC = Qs - QR1 - QI.",
)

# ---- the tutorial of StateMint

MOTOR_AND_PUMP = Published(
    name="motor_and_pump",
    source="StateMint tutorial and example notebook",
    model="""
name = "motor_and_pump"

[parameters]
R = 1.2
L = 0.4
Kv = 0.9
kt = 2.3
D = 0.7
Rf = 1.8

[inputs]
Vs = { unit = "V" }

[voltage_source.source]
between = ["plus", "ground"]
voltage = "Vs"

[resistor.R]
between = ["plus", "a"]
resistance = "R"

[rotational_spring.k]
between = ["rotor", "pump"]
stiffness = "kt"

[inductor.L]
between = ["a", "brush"]
inductance = "L"

[dc_motor.motor]
between = ["brush", "ground"]
shaft = ["rotor", "ground"]
constant = "1/Kv"
resistance = 0

[angular_velocity_source.pump_shaft]
between = ["pump", "ground"]
velocity = "through(R_f)/D"

[pressure_source.pump_outlet]
between = ["outlet", "ground"]
pressure = "through(pump_shaft)/D"

[pipe.R_f]
between = ["outlet", "ground"]
resistance = "Rf"

[outputs]
QR = "through(R_f)"
""",
    states=("tau_k",),
    signs=(1,),
    inputs=("Vs",),
    A=rows("-kt*(D**2*Kv**2*R*Rf + 1)/(D**2*Rf*(Kv**2*L*kt + 1))"),
    B=rows("kt*Kv/(Kv**2*L*kt + 1)"),
    outputs=("QR",),
    C=rows("1/(D*Rf)"),
    D=rows("0"),
    printed=False,
    remark="The printed A has D**2*Kv**2*R*Rf - 1; B, C and D are as printed. Its continuity equation "
    "Q4 = QR has a slip of sign: both edges leave the same vertex, so that Q4 = -QR; as printed the pump "
    "delivers power on both sides. The inductor depends on the spring, through the motor. The pump, "
    "w3 = -Q4/D and P4 = t3/D, is a pair of controlled sources.",
)

MOTOR_AND_PUMP_TRANSDUCER = rebuilt(
    MOTOR_AND_PUMP,
    "motor_and_pump_transducer",
    """
[angular_velocity_source.pump_shaft]
between = ["pump", "ground"]
velocity = "through(R_f)/D"

[pressure_source.pump_outlet]
between = ["outlet", "ground"]
pressure = "through(pump_shaft)/D"
""",
    """
[pump.pump]
between = ["ground", "outlet"]
shaft = ["pump", "ground"]
displacement = "D"
""",
    "The pump is a transducer.",
)

# ---- MIT 2.151 handouts and other textbooks, by their element lists

HANDOUT_FIGURE_8_PARALLEL = Published(
    name="handout_figure_8_parallel",
    source="MIT 2.151 State Equation Formulation, Fig. 8, with parallel springs; element list in LGtheory",
    model="""
name = "handout_figure_8_parallel"

[parameters]
B = 0.4
m = 1.5
K1 = 2.2
K2 = 0.9

[inputs]
Fs = { unit = "N" }

[force_source.source]
between = ["ground", "a"]
force = "Fs"

[translational_damper.B]
between = ["a", "ground"]
damping = "B"

[mass.m]
between = ["a", "ground"]
mass = "m"

[translational_spring.K1]
between = ["a", "ground"]
stiffness = "K1"

[translational_spring.K2]
between = ["a", "ground"]
stiffness = "K2"
""",
    states=("v_m", "F_K1", "F_K2"),
    signs=(1, 1, 1),
    inputs=("Fs",),
    A=rows("-B/m, -1/m, -1/m", "K1, 0, 0", "K2, 0, 0"),
    B=rows("1/m", "0", "0"),
    printed=False,
    remark="Each spring keeps its own preload: three states, of which F_K1/K1 - F_K2/K2 is constant. "
    "LGtheory refuses it as having an excess state.",
)

HANDOUT_FIGURE_8_SERIES = Published(
    name="handout_figure_8_series",
    source="MIT 2.151 State Equation Formulation, Fig. 8, with capacitors in series; element list in "
    "LGtheory",
    model="""
name = "handout_figure_8_series"

[parameters]
R1 = 1.3
C1 = 0.7
L1 = 2.1
C2 = 1.9
R2 = 0.6

[inputs]
Vs = { unit = "V" }

[voltage_source.source]
between = ["a", "ground"]
voltage = "Vs"

[resistor.R1]
between = ["a", "b"]
resistance = "R1"

[capacitor.C1]
between = ["b", "c"]
capacitance = "C1"

[inductor.L1]
between = ["c", "d"]
inductance = "L1"

[capacitor.C2]
between = ["d", "ground"]
capacitance = "C2"

[resistor.R2]
between = ["b", "ground"]
resistance = "R2"
""",
    states=("v_C1", "v_C2", "i_L1"),
    signs=(1, 1, 1),
    inputs=("Vs",),
    A=rows("0, 0, 1/C1", "0, 0, 1/C2", "-1/L1, -1/L1, -R1*R2/(L1*(R1 + R2))"),
    B=rows("0", "0", "R2/(L1*(R1 + R2))"),
    printed=False,
    remark="Each capacitor keeps its own charge: three states, of which C1*v_C1 - C2*v_C2 is constant. "
    "LGtheory refuses it as having an excess state.",
)

HANDOUT_FIGURE_14 = Published(
    name="handout_figure_14",
    source="MIT 2.151 State Equation Formulation, Fig. 14 (p. 17); element list in LGtheory",
    model="""
name = "handout_figure_14"

[parameters]
Rp = 0.75
Ip = 2.4
Rf = 1.6
area = 3.3
density = 0.9
gravity = 9.81
Cf = "area/(density*gravity)"

[inputs]
Ps = { unit = "Pa" }

[pressure_source.source]
between = ["a", "ground"]
pressure = "Ps"

[pipe.Rp]
between = ["a", "b"]
resistance = "Rp"

[inertance.Ip]
between = ["b", "c"]
inertance = "Ip"

[pipe.Rf]
between = ["c", "ground"]
resistance = "Rf"

[tank.Cf]
between = ["c", "ground"]
area = "area"
density = "density"
gravity = "gravity"
""",
    states=("p_Cf", "Q_Ip"),
    signs=(1, 1),
    inputs=("Ps",),
    A=rows(
        "-density*gravity/(Rf*area), density*gravity/area",
        "-1/Ip, -Rp/Ip",
    ),
    B=rows("0", "1/Ip"),
    printed=False,
    remark="The network of Example 5.6, here with Cf = area/(density*gravity) of an open tank.",
)

HANDOUT_FIGURE_18 = Published(
    name="handout_figure_18",
    source="MIT 2.151 State Equation Formulation, Fig. 18 (p. 24); element list in LGtheory",
    model="""
name = "handout_figure_18"

[parameters]
C = 0.8
R1 = 1.7
R2 = 2.6
L = 1.1

[inputs]
Is = { unit = "A" }

[current_source.source]
between = ["ground", "a"]
current = "Is"

[capacitor.C]
between = ["a", "ground"]
capacitance = "C"

[resistor.R2]
between = ["b", "ground"]
resistance = "R2"

[resistor.R1]
between = ["a", "b"]
resistance = "R1"

[inductor.L]
between = ["b", "ground"]
inductance = "L"
""",
    states=("v_C", "i_L"),
    signs=(1, 1),
    inputs=("Is",),
    A=rows(
        "-1/(C*(R1 + R2)), -R2/(C*(R1 + R2))",
        "R2/(L*(R1 + R2)), -R1*R2/(L*(R1 + R2))",
    ),
    B=rows("1/C", "0"),
    printed=False,
    remark="The two resistors form an algebraic loop. LGtheory notes a slip in the handout's arithmetic.",
)

HANDOUT_FIGURE_21 = Published(
    name="handout_figure_21",
    source="MIT 2.151 Two-Port Energy Transducing Elements, Fig. 21 (p. 24); element list in LGtheory",
    model="""
name = "handout_figure_21"

[parameters]
R = 1.4
L = 0.3
Ka = 1.25
B = 0.55
J = 2.7

[inputs]
Vs = { unit = "V" }

[voltage_source.source]
between = ["a", "ground"]
voltage = "Vs"

[resistor.R]
between = ["a", "b"]
resistance = "R"

[inductor.L]
between = ["b", "c"]
inductance = "L"

[dc_motor.motor]
between = ["c", "ground"]
shaft = ["shaft", "ground"]
constant = "1/Ka"
resistance = 0

[rotational_damper.B]
between = ["shaft", "ground"]
damping = "B"

[inertia.J]
between = ["shaft", "ground"]
inertia = "J"

[outputs]
Tau_J = "through(J)"
i_motor = "through(L)"
Tau_B = "through(B)"
""",
    states=("w_J", "i_L"),
    signs=(1, 1),
    inputs=("Vs",),
    A=rows("-B/J, 1/(Ka*J)", "-1/(Ka*L), -R/L"),
    B=rows("0", "1/L"),
    outputs=("Tau_J", "i_motor", "Tau_B"),
    C=rows("-B, 1/Ka", "0, 1", "B, 0"),
    D=rows("0", "0", "0"),
    printed=False,
    remark="The element list has 1/Ka for the ratio of voltage to speed.",
)

HANDOUT_FIGURE_22 = Published(
    name="handout_figure_22",
    source="MIT 2.151 Two-Port Energy Transducing Elements, Fig. 22 (p. 26); element list in LGtheory",
    model="""
name = "handout_figure_22"

[parameters]
R = 0.9
A = 1.6
B = 0.45
K = 2.8
m = 1.3

[inputs]
Ps = { unit = "Pa" }

[pressure_source.source]
between = ["supply", "ground"]
pressure = "Ps"

[pipe.R]
between = ["supply", "chamber"]
resistance = "R"

[flow_source.chamber]
between = ["chamber", "ground"]
flow = "-A*across(piston)"

[force_source.piston]
between = ["load", "ground"]
force = "A*across(chamber)"

[translational_damper.B]
between = ["load", "ground"]
damping = "B"

[translational_spring.K]
between = ["load", "ground"]
stiffness = "K"

[mass.m]
between = ["load", "ground"]
mass = "m"
""",
    states=("v_m", "F_K"),
    signs=(1, 1),
    inputs=("Ps",),
    A=rows("-(B + R*A**2)/m, -1/m", "K, 0"),
    B=rows("-A/m", "0"),
    printed=False,
    remark="The ram, P = F2/A and Q = -A v with the ratio 1/A of the element list, is a pair of controlled "
    "sources. A positive velocity drives the liquid out of the chamber.",
)

HANDOUT_FIGURE_22_CYLINDER = rebuilt(
    HANDOUT_FIGURE_22,
    "handout_figure_22_cylinder",
    """
[flow_source.chamber]
between = ["chamber", "ground"]
flow = "-A*across(piston)"

[force_source.piston]
between = ["load", "ground"]
force = "A*across(chamber)"
""",
    """
[cylinder.ram]
between = ["chamber", "ground"]
shaft = ["ground", "load"]
area = "A"
""",
    "The ram is a transducer.",
)

PICONE_3_05 = Published(
    name="picone_3_05",
    source="R. A. R. Picone, lecture 3.05 on dynamic systems; element list in LGtheory",
    model="""
name = "picone_3_05"

[parameters]
k1 = 4.1
B1 = 0.6
m1 = 0.8
k2 = 1.7
B2 = 0.35
m2 = 2.2

[inputs]
Vs = { unit = "m/s" }

[velocity_source.source]
between = ["a", "ground"]
velocity = "Vs"

[translational_spring.k1]
between = ["a", "b"]
stiffness = "k1"

[translational_damper.B1]
between = ["a", "b"]
damping = "B1"

[mass.m1]
between = ["b", "ground"]
mass = "m1"

[translational_spring.k2]
between = ["b", "c"]
stiffness = "k2"

[translational_damper.B2]
between = ["b", "c"]
damping = "B2"

[mass.m2]
between = ["c", "ground"]
mass = "m2"
""",
    states=("F_k1", "F_k2", "v_m1", "v_m2"),
    signs=(1, 1, 1, 1),
    inputs=("Vs",),
    A=rows(
        "0, 0, -k1, 0",
        "0, 0, k2, -k2",
        "1/m1, -1/m1, -(B1 + B2)/m1, B2/m1",
        "0, 1/m2, B2/m2, -B2/m2",
    ),
    B=rows("k1", "0", "B1/m1", "0"),
    printed=False,
)

PICONE_3_06 = Published(
    name="picone_3_06",
    source="R. A. R. Picone, lecture 3.06 on dynamic systems; element list in LGtheory",
    model="""
name = "picone_3_06"

[parameters]
B1 = 1.1
K = 2.6
J = 0.7
B2 = 0.45

[inputs]
ws = { unit = "rad/s" }

[angular_velocity_source.source]
between = ["a", "ground"]
velocity = "ws"

[rotational_damper.B1]
between = ["a", "b"]
damping = "B1"

[rotational_spring.K]
between = ["b", "ground"]
stiffness = "K"

[inertia.J]
between = ["b", "ground"]
inertia = "J"

[rotational_damper.B2]
between = ["b", "ground"]
damping = "B2"

[outputs]
Tau_K = "through(K)"
""",
    states=("w_J", "tau_K"),
    signs=(1, 1),
    inputs=("ws",),
    A=rows("-(B1 + B2)/J, -1/J", "K, 0"),
    B=rows("B1/J", "0"),
    outputs=("Tau_K",),
    C=rows("0, 1"),
    D=rows("0"),
    printed=False,
)

PICONE_4_04 = Published(
    name="picone_4_04",
    source="R. A. R. Picone, lecture 4.04 on dynamic systems; element list in LGtheory",
    model="""
name = "picone_4_04"

[parameters]
R = 1.9
L = 0.55
TF = 0.8
B = 0.3
J = 1.2

[inputs]
Vs = { unit = "V" }

[voltage_source.source]
between = ["a", "ground"]
voltage = "Vs"

[resistor.R]
between = ["a", "b"]
resistance = "R"

[inductor.L]
between = ["b", "c"]
inductance = "L"

[dc_motor.motor]
between = ["c", "ground"]
shaft = ["shaft", "ground"]
constant = "TF"
resistance = 0

[rotational_damper.B]
between = ["shaft", "ground"]
damping = "B"

[inertia.J]
between = ["shaft", "ground"]
inertia = "J"

[outputs]
Omega_J = "across(J)"
Tau_J = "through(J)"
V_L = "across(L)"
I_L = "through(L)"
Omega_B = "across(B)"
Tau_B = "through(B)"
V_R = "across(R)"
I_R = "through(R)"
V_s = "across(source)"
""",
    states=("w_J", "i_L"),
    signs=(1, 1),
    inputs=("Vs",),
    A=rows("-B/J, TF/J", "-TF/L, -R/L"),
    B=rows("0", "1/L"),
    outputs=("Omega_J", "Tau_J", "V_L", "I_L", "Omega_B", "Tau_B", "V_R", "I_R", "V_s"),
    C=rows(
        "1, 0",
        "-B, TF",
        "-TF, -R",
        "0, 1",
        "1, 0",
        "B, 0",
        "0, R",
        "0, 1",
        "0, 0",
    ),
    D=rows("0", "0", "1", "0", "0", "0", "0", "0", "1"),
    printed=False,
)

DE_SILVA_3_4 = Published(
    name="de_silva_3_4",
    source="C. W. de Silva, Mechatronics: A Foundation Course, Example 3.4; element list in LGtheory",
    model="""
name = "de_silva_3_4"

[parameters]
Mc = 1.1
Kc = 3.4
Bc = 0.25
Bh = 0.6
Mh = 2.5
Kr = 5.2
Br = 0.4
r = 0.7
Jr = 0.9

[inputs]
Fc = { unit = "N" }
Tr = { unit = "N*m" }

[force_source.s1]
between = ["ground", "c"]
force = "Fc"

[mass.Mc]
between = ["c", "ground"]
mass = "Mc"

[translational_spring.Kc]
between = ["c", "h"]
stiffness = "Kc"

[translational_damper.Bc]
between = ["c", "h"]
damping = "Bc"

[translational_damper.Bh]
between = ["h", "ground"]
damping = "Bh"

[mass.Mh]
between = ["h", "ground"]
mass = "Mh"

[translational_spring.Kr]
between = ["rack", "h"]
stiffness = "Kr"

[translational_damper.Br]
between = ["rack", "ground"]
damping = "Br"

[rack.pinion]
between = ["rotor", "ground"]
second = ["rack", "ground"]
radius = "r"

[inertia.Jr]
between = ["rotor", "ground"]
inertia = "Jr"

[torque_source.s2]
between = ["ground", "rotor"]
torque = "Tr"
""",
    states=("w_Jr", "F_Kr", "v_Mh", "F_Kc", "v_Mc"),
    signs=(1, 1, 1, 1, 1),
    inputs=("Fc", "Tr"),
    A=rows(
        "-r**2*Br/Jr, -r/Jr, 0, 0, 0",
        "r*Kr, 0, -Kr, 0, 0",
        "0, 1/Mh, -(Bc + Bh)/Mh, 1/Mh, Bc/Mh",
        "0, 0, -Kc, 0, Kc",
        "0, 0, Bc/Mc, -1/Mc, -Bc/Mc",
    ),
    B=rows("0, 1/Jr", "0, 0", "0, 0", "0, 0", "1/Mc, 0"),
    printed=False,
)

CAR_SUSPENSION = Published(
    name="car_suspension",
    source="Interactive Software for Dynamic System Modeling using Linear Graphs, car suspension; element "
    "list in LGtheory",
    model="""
name = "car_suspension"

[parameters]
m1 = 0.6
k1 = 6.3
k2 = 1.4
b1 = 0.35
m2 = 2.9

[mass.m1]
between = ["a", "ground"]
mass = "m1"

[translational_spring.k1]
between = ["a", "ground"]
stiffness = "k1"

[translational_spring.k2]
between = ["a", "b"]
stiffness = "k2"

[translational_damper.b1]
between = ["a", "b"]
damping = "b1"

[mass.m2]
between = ["b", "ground"]
mass = "m2"
""",
    states=("v_m1", "F_k1", "F_k2", "v_m2"),
    signs=(1, 1, 1, 1),
    inputs=(),
    A=rows(
        "-b1/m1, -1/m1, -1/m1, b1/m1",
        "k1, 0, 0, 0",
        "k2, 0, 0, -k2",
        "b1/m2, 0, 1/m2, -b1/m2",
    ),
    B=((), (), (), ()),
    printed=False,
    remark="It has no input.",
)

COMPLIANT_SHAFT = Published(
    name="compliant_shaft",
    source="DC motor with compliant shaft and inertial load; element list in LGtheory",
    model="""
name = "compliant_shaft"

[parameters]
R = 0.85
L = 0.25
TF = 1.35
J1 = 0.5
B1 = 0.15
K = 3.9
J2 = 1.8
B2 = 0.4

[inputs]
Vs = { unit = "V" }

[voltage_source.source]
between = ["a", "ground"]
voltage = "Vs"

[resistor.R]
between = ["a", "b"]
resistance = "R"

[inductor.L]
between = ["b", "c"]
inductance = "L"

[dc_motor.motor]
between = ["c", "ground"]
shaft = ["rotor", "ground"]
constant = "TF"
resistance = 0

[inertia.J1]
between = ["rotor", "ground"]
inertia = "J1"

[rotational_damper.B1]
between = ["rotor", "ground"]
damping = "B1"

[rotational_spring.K]
between = ["rotor", "load"]
stiffness = "K"

[inertia.J2]
between = ["load", "ground"]
inertia = "J2"

[rotational_damper.B2]
between = ["load", "ground"]
damping = "B2"

[outputs]
i_s = "through(source)"
""",
    states=("w_J1", "w_J2", "tau_K", "i_L"),
    signs=(1, 1, 1, 1),
    inputs=("Vs",),
    A=rows(
        "-B1/J1, 0, -1/J1, TF/J1",
        "0, -B2/J2, 1/J2, 0",
        "K, -K, 0, 0",
        "-TF/L, 0, 0, -R/L",
    ),
    B=rows("0", "0", "0", "1/L"),
    outputs=("i_s",),
    C=rows("0, 0, 0, -1"),
    D=rows("0"),
    printed=False,
    remark="The current of the source, from its plus through it to ground, is the negative of the motor's.",
)

PUBLISHED: tuple[Published, ...] = (
    QUARTER_CAR,
    MOTOR_AND_PULLEY,
    INERTIAL_ACTUATOR,
    INERTIAL_ACTUATOR_COIL,
    ME_471,
    EXAMPLE_5_1,
    EXAMPLE_5_2,
    EXAMPLE_5_3,
    EXAMPLE_5_4,
    EXAMPLE_5_5,
    EXAMPLE_5_6,
    EXAMPLE_5_7,
    EXAMPLE_5_8,
    EXAMPLE_5_9,
    EXAMPLE_5_11,
    EXAMPLE_5_12,
    EXAMPLE_5_12_ANGLE,
    EXAMPLE_5_13,
    EXAMPLE_5_13_CORRECTED,
    MOTOR_AND_PUMP,
    MOTOR_AND_PUMP_TRANSDUCER,
    HANDOUT_FIGURE_8_PARALLEL,
    HANDOUT_FIGURE_8_SERIES,
    HANDOUT_FIGURE_14,
    HANDOUT_FIGURE_18,
    HANDOUT_FIGURE_21,
    HANDOUT_FIGURE_22,
    HANDOUT_FIGURE_22_CYLINDER,
    PICONE_3_05,
    PICONE_3_06,
    PICONE_4_04,
    DE_SILVA_3_4,
    CAR_SUSPENSION,
    COMPLIANT_SHAFT,
)
