"""The register of components of scalar networks: one file each, one line in `Words`."""

from typing import Any

from linegraph.components.accumulator import Accumulator
from linegraph.components.angular_velocity_source import AngularVelocitySource
from linegraph.components.any_store import AnyStore
from linegraph.components.base import Component
from linegraph.components.belt import Belt
from linegraph.components.builder import Networks
from linegraph.components.capacitor import Capacitor
from linegraph.components.conductance import Conductance
from linegraph.components.conduction import Conduction
from linegraph.components.convection import Convection
from linegraph.components.coupled_inductors import CoupledInductors
from linegraph.components.current_source import CurrentSource
from linegraph.components.cylinder import Cylinder
from linegraph.components.dc_motor import DcMotor
from linegraph.components.diode import Diode
from linegraph.components.element import AnyElement
from linegraph.components.flow_source import FlowSource
from linegraph.components.flux_source import FluxSource
from linegraph.components.force_source import ForceSource
from linegraph.components.gear import Gear
from linegraph.components.gyrator import Gyrator
from linegraph.components.heat_capacity import HeatCapacity
from linegraph.components.heat_source import HeatSource
from linegraph.components.inductor import Inductor
from linegraph.components.inertance import Inertance
from linegraph.components.inertia import Inertia
from linegraph.components.interface import RotationalInterface, TranslationalInterface
from linegraph.components.lever import Lever
from linegraph.components.losses import Losses
from linegraph.components.mass import Mass
from linegraph.components.mmf_source import MmfSource
from linegraph.components.moving_coil import MovingCoil
from linegraph.components.opamp import OpAmp
from linegraph.components.orifice import Orifice
from linegraph.components.piezo import Piezo
from linegraph.components.pipe import Pipe
from linegraph.components.pressure_source import PressureSource
from linegraph.components.pump import HydraulicMotor, Pump
from linegraph.components.rack import Rack
from linegraph.components.radiation import Radiation
from linegraph.components.reluctance import Reluctance
from linegraph.components.resistor import Resistor
from linegraph.components.rotational_damper import RotationalDamper
from linegraph.components.rotational_friction import RotationalFriction
from linegraph.components.rotational_spring import RotationalSpring
from linegraph.components.screw import Screw
from linegraph.components.solenoid import ReluctanceMachine, Solenoid
from linegraph.components.synchronous_machine import SynchronousMachine
from linegraph.components.tank import Tank
from linegraph.components.temperature_source import TemperatureSource
from linegraph.components.torque_source import TorqueSource
from linegraph.components.transformer import Transformer
from linegraph.components.translational_damper import TranslationalDamper
from linegraph.components.translational_friction import TranslationalFriction
from linegraph.components.translational_spring import TranslationalSpring
from linegraph.components.valve import Valve
from linegraph.components.variable_capacitor import VariableCapacitor
from linegraph.components.velocity_source import VelocitySource
from linegraph.components.voltage_source import VoltageSource
from linegraph.components.winding import Winding
from linegraph.components.words import connects


class Words(Networks):
    """What the builder calls them: ``model.resistor("R1", between=("a", "b"), resistance=100.0)``."""

    resistor = connects(Resistor)
    conductance = connects(Conductance)
    capacitor = connects(Capacitor)
    inductor = connects(Inductor)
    coupled_inductors = connects(CoupledInductors)
    diode = connects(Diode)
    opamp = connects(OpAmp)
    transformer = connects(Transformer)
    gyrator = connects(Gyrator)
    voltage_source = connects(VoltageSource)
    current_source = connects(CurrentSource)
    mass = connects(Mass)
    translational_spring = connects(TranslationalSpring)
    translational_damper = connects(TranslationalDamper)
    translational_friction = connects(TranslationalFriction)
    lever = connects(Lever)
    force_source = connects(ForceSource)
    velocity_source = connects(VelocitySource)
    inertia = connects(Inertia)
    rotational_spring = connects(RotationalSpring)
    rotational_damper = connects(RotationalDamper)
    rotational_friction = connects(RotationalFriction)
    gear = connects(Gear)
    belt = connects(Belt)
    rack = connects(Rack)
    screw = connects(Screw)
    torque_source = connects(TorqueSource)
    angular_velocity_source = connects(AngularVelocitySource)
    tank = connects(Tank)
    accumulator = connects(Accumulator)
    inertance = connects(Inertance)
    pipe = connects(Pipe)
    orifice = connects(Orifice)
    valve = connects(Valve)
    pressure_source = connects(PressureSource)
    flow_source = connects(FlowSource)
    heat_capacity = connects(HeatCapacity)
    conduction = connects(Conduction)
    convection = connects(Convection)
    radiation = connects(Radiation)
    losses = connects(Losses)
    temperature_source = connects(TemperatureSource)
    heat_source = connects(HeatSource)
    reluctance = connects(Reluctance)
    winding = connects(Winding)
    mmf_source = connects(MmfSource)
    flux_source = connects(FluxSource)
    element = connects(AnyElement)
    store = connects(AnyStore)
    dc_motor = connects(DcMotor)
    moving_coil = connects(MovingCoil)
    solenoid = connects(Solenoid)
    reluctance_machine = connects(ReluctanceMachine)
    variable_capacitor = connects(VariableCapacitor)
    piezo = connects(Piezo)
    synchronous_machine = connects(SynchronousMachine)
    cylinder = connects(Cylinder)
    pump = connects(Pump)
    hydraulic_motor = connects(HydraulicMotor)
    translational_interface = connects(TranslationalInterface)
    rotational_interface = connects(RotationalInterface)


def _registered() -> dict[str, type[Component]]:
    words: list[tuple[str, Any]] = list(vars(Words).items())
    return {word: method.kind for word, method in words if hasattr(method, "kind")}


COMPONENTS: dict[str, type[Component]] = _registered()
"""The types by their names."""

__all__ = ["COMPONENTS", "Component", "Words"]
