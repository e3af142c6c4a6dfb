"""The register of components of scalar networks and of transducers: one line for each in `Words`.

Components are in the file of their domain, couplings in `couplings`, and transducers have a file each in
`linegraph.components.transducers`. A file is imported when a type in it is first used: many models have no
network at all.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from linegraph.components.scalar.base import Component
from linegraph.components.scalar.builder import Networks
from linegraph.components.scalar.words import connects


class Words(Networks):
    """The builder's methods: ``model.resistor("R1", between=("a", "b"), resistance=100.0)``.

    Each line gives a type's name in model files and for the builder, its file below `linegraph.components`,
    and its class. The schema has the same order.
    """

    resistor = connects("scalar.electrical", "Resistor")
    conductance = connects("scalar.electrical", "Conductance")
    capacitor = connects("scalar.electrical", "Capacitor")
    inductor = connects("scalar.electrical", "Inductor")
    coupled_inductors = connects("scalar.electrical", "CoupledInductors")
    diode = connects("scalar.electrical", "Diode")
    opamp = connects("scalar.electrical", "OpAmp")
    transformer = connects("scalar.couplings", "Transformer")
    gyrator = connects("scalar.couplings", "Gyrator")
    voltage_source = connects("scalar.electrical", "VoltageSource")
    current_source = connects("scalar.electrical", "CurrentSource")
    mass = connects("scalar.translational", "Mass")
    translational_spring = connects("scalar.translational", "TranslationalSpring")
    translational_damper = connects("scalar.translational", "TranslationalDamper")
    translational_friction = connects("scalar.translational", "TranslationalFriction")
    lever = connects("scalar.couplings", "Lever")
    force_source = connects("scalar.translational", "ForceSource")
    velocity_source = connects("scalar.translational", "VelocitySource")
    inertia = connects("scalar.rotational", "Inertia")
    rotational_spring = connects("scalar.rotational", "RotationalSpring")
    rotational_damper = connects("scalar.rotational", "RotationalDamper")
    rotational_friction = connects("scalar.rotational", "RotationalFriction")
    gear = connects("scalar.couplings", "Gear")
    belt = connects("scalar.couplings", "Belt")
    rack = connects("scalar.couplings", "Rack")
    screw = connects("scalar.couplings", "Screw")
    torque_source = connects("scalar.rotational", "TorqueSource")
    angular_velocity_source = connects("scalar.rotational", "AngularVelocitySource")
    tank = connects("scalar.hydraulic", "Tank")
    accumulator = connects("scalar.hydraulic", "Accumulator")
    inertance = connects("scalar.hydraulic", "Inertance")
    pipe = connects("scalar.hydraulic", "Pipe")
    orifice = connects("scalar.hydraulic", "Orifice")
    valve = connects("scalar.hydraulic", "Valve")
    pressure_source = connects("scalar.hydraulic", "PressureSource")
    flow_source = connects("scalar.hydraulic", "FlowSource")
    heat_capacity = connects("scalar.thermal", "HeatCapacity")
    conduction = connects("scalar.thermal", "Conduction")
    convection = connects("scalar.thermal", "Convection")
    radiation = connects("scalar.thermal", "Radiation")
    losses = connects("scalar.thermal", "Losses")
    temperature_source = connects("scalar.thermal", "TemperatureSource")
    heat_source = connects("scalar.thermal", "HeatSource")
    reluctance = connects("scalar.magnetic", "Reluctance")
    winding = connects("scalar.couplings", "Winding")
    mmf_source = connects("scalar.magnetic", "MmfSource")
    flux_source = connects("scalar.magnetic", "FluxSource")
    element = connects("scalar.element", "AnyElement")
    store = connects("scalar.any_store", "AnyStore")
    dc_motor = connects("transducers.dc_motor", "DcMotor")
    moving_coil = connects("transducers.moving_coil", "MovingCoil")
    solenoid = connects("transducers.solenoid", "Solenoid")
    reluctance_machine = connects("transducers.solenoid", "ReluctanceMachine")
    variable_capacitor = connects("transducers.variable_capacitor", "VariableCapacitor")
    piezo = connects("transducers.piezo", "Piezo")
    synchronous_machine = connects("transducers.synchronous_machine", "SynchronousMachine")
    cylinder = connects("transducers.cylinder", "Cylinder")
    pump = connects("transducers.pump", "Pump")
    hydraulic_motor = connects("transducers.pump", "HydraulicMotor")
    translational_interface = connects("transducers.interface", "TranslationalInterface")
    rotational_interface = connects("transducers.interface", "RotationalInterface")


class _Register(Mapping[str, type[Component]]):
    """The types by name; the file of a type is imported when it is looked up."""

    def __getitem__(self, word: str) -> type[Component]:
        method: Any = vars(Words)[word]
        if not isinstance(method, connects):
            raise KeyError(word)
        return method.kind

    def __iter__(self) -> Iterator[str]:
        return (word for word, method in vars(Words).items() if isinstance(method, connects))

    def __len__(self) -> int:
        return sum(1 for _ in self)


COMPONENTS = _Register()
"""The types of all components by name, in the order of `Words`."""

__all__ = ["COMPONENTS", "Component", "Words"]
