"""The register of components of scalar networks: one file each, one line in `Words`.

A component's file is imported when it is first used: most models have few of them, and many have none.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from linegraph.components.scalar.base import Component
from linegraph.components.scalar.builder import Networks
from linegraph.components.scalar.words import connects


class Words(Networks):
    """What the builder calls them: ``model.resistor("R1", between=("a", "b"), resistance=100.0)``."""

    resistor = connects("resistor", "Resistor")
    conductance = connects("conductance", "Conductance")
    capacitor = connects("capacitor", "Capacitor")
    inductor = connects("inductor", "Inductor")
    coupled_inductors = connects("coupled_inductors", "CoupledInductors")
    diode = connects("diode", "Diode")
    opamp = connects("opamp", "OpAmp")
    transformer = connects("transformer", "Transformer")
    gyrator = connects("gyrator", "Gyrator")
    voltage_source = connects("voltage_source", "VoltageSource")
    current_source = connects("current_source", "CurrentSource")
    mass = connects("mass", "Mass")
    translational_spring = connects("translational_spring", "TranslationalSpring")
    translational_damper = connects("translational_damper", "TranslationalDamper")
    translational_friction = connects("translational_friction", "TranslationalFriction")
    lever = connects("lever", "Lever")
    force_source = connects("force_source", "ForceSource")
    velocity_source = connects("velocity_source", "VelocitySource")
    inertia = connects("inertia", "Inertia")
    rotational_spring = connects("rotational_spring", "RotationalSpring")
    rotational_damper = connects("rotational_damper", "RotationalDamper")
    rotational_friction = connects("rotational_friction", "RotationalFriction")
    gear = connects("gear", "Gear")
    belt = connects("belt", "Belt")
    rack = connects("rack", "Rack")
    screw = connects("screw", "Screw")
    torque_source = connects("torque_source", "TorqueSource")
    angular_velocity_source = connects("angular_velocity_source", "AngularVelocitySource")
    tank = connects("tank", "Tank")
    accumulator = connects("accumulator", "Accumulator")
    inertance = connects("inertance", "Inertance")
    pipe = connects("pipe", "Pipe")
    orifice = connects("orifice", "Orifice")
    valve = connects("valve", "Valve")
    pressure_source = connects("pressure_source", "PressureSource")
    flow_source = connects("flow_source", "FlowSource")
    heat_capacity = connects("heat_capacity", "HeatCapacity")
    conduction = connects("conduction", "Conduction")
    convection = connects("convection", "Convection")
    radiation = connects("radiation", "Radiation")
    losses = connects("losses", "Losses")
    temperature_source = connects("temperature_source", "TemperatureSource")
    heat_source = connects("heat_source", "HeatSource")
    reluctance = connects("reluctance", "Reluctance")
    winding = connects("winding", "Winding")
    mmf_source = connects("mmf_source", "MmfSource")
    flux_source = connects("flux_source", "FluxSource")
    element = connects("element", "AnyElement")
    store = connects("any_store", "AnyStore")
    dc_motor = connects("dc_motor", "DcMotor")
    moving_coil = connects("moving_coil", "MovingCoil")
    solenoid = connects("solenoid", "Solenoid")
    reluctance_machine = connects("solenoid", "ReluctanceMachine")
    variable_capacitor = connects("variable_capacitor", "VariableCapacitor")
    piezo = connects("piezo", "Piezo")
    synchronous_machine = connects("synchronous_machine", "SynchronousMachine")
    cylinder = connects("cylinder", "Cylinder")
    pump = connects("pump", "Pump")
    hydraulic_motor = connects("pump", "HydraulicMotor")
    translational_interface = connects("interface", "TranslationalInterface")
    rotational_interface = connects("interface", "RotationalInterface")


class _Register(Mapping[str, type[Component]]):
    """The types by their names, which are the builder's words."""

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
"""The types by their names."""

__all__ = ["COMPONENTS", "Component", "Words"]
