"""Energies, forces and torques of one state."""
from __future__ import annotations

import logging
import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Optional, Union

import numpy as np

from . import _core
from .numbers import real_array
from .parameters import ParameterSet
from .scene import Scene
from .simulation import Energies, Simulation
from .state import Floats, State

_log = logging.getLogger("ropewalk")
SetName = Union[str, "os.PathLike[str]", ParameterSet]


@dataclass(frozen=True, eq=False, kw_only=True)
class StateEnergy(Energies):
    """Energies of a state at rest, in eV, and what acts on its elements, without loads.

    Attributes:
        force: (elements, 3), eV/nm
        torque: (elements, 3), about the centres of the elements, eV
        net_force: (3,), the sum of all forces, eV/nm
        net_torque: (3,), of all forces and torques about the origin, eV
    """

    force: Floats
    torque: Floats
    net_force: Floats
    net_torque: Floats


def _set_name(name: SetName) -> str:
    return name.path if isinstance(name, ParameterSet) else os.fspath(name)


def energy(
    state: Union[State, Scene, Simulation, str, "os.PathLike[str]"],
    parameters: Union[SetName, Sequence[SetName], None] = None,
    *,
    tube_types: Sequence[int] = (),
    law: Optional[str] = None,
    bond: Optional[str] = None,
    legacy_torque: bool = False,
    exclude_along_tube_nm: Optional[float] = None,
    free_length_nm: Optional[float] = None,
    nodes_per_element: Optional[int] = None,
    reference: bool = False,
) -> StateEnergy:
    """Energies in eV, forces in eV/nm and torques in eV of one state at rest, in double precision, as `ropewalk energy`.

    Arguments:
        state: a state file (CSV), the state of a simulation, a frame, or a scene (its start) or simulation
        parameters: a parameter set, or one for each type of tube; None: bonds, contacts, friction, links and broken tubes
            of the scene at its start, or of the simulation as they are now
        tube_types: number of the parameter set of each tube, from 0; empty: all 0 (no unit)
        law: contact law "line", "paper" or "none"; None: line where the set has it
        bond: "harmonic" or "anharmonic"; None: anharmonic where the set has it
        legacy_torque: leaves out the torque that the published code leaves out
        exclude_along_tube_nm: parts of one tube up to this far apart along it do not attract, nm; None: as a scene has it
        free_length_nm: length of the tubes between what holds them, by which twisted tubes collapse, nm; None: all of it
        nodes_per_element: nodes of the line law on an element; None: as a run in time has them, which Newton's method
            has not (no unit)
        reference: by the plain sum over all pairs instead of the fast path
    """
    if parameters is None:
        if not isinstance(state, (Scene, Simulation)):
            raise TypeError("a state alone does not know its parameter set: give `parameters`")
        if isinstance(state, Simulation):
            found = _core.energy_of_simulation(state._core, reference)
        else:
            flat = state.start.flat
            found = _core.energy_in_scene(state._core, real_array(flat.position, "position"),
                                          real_array(flat.orientation, "orientation"), reference)
    else:
        one = isinstance(parameters, (str, os.PathLike, ParameterSet))
        sets: Sequence[SetName] = [parameters] if one else parameters  # type: ignore[list-item,assignment]
        options = _core.StateOptions(
            [_set_name(s) for s in sets], list(tube_types), law or "", bond or "", legacy_torque,
            exclude_along_tube_nm or 0.0, free_length_nm or 0.0, nodes_per_element or 0, reference,
        )
        if isinstance(state, (Scene, Simulation, State)):
            given = state.state if isinstance(state, Simulation) else state.start if isinstance(state, Scene) else state
            flat = given.flat
            found = _core.energy_of_state(
                given.tube_begin.tolist(), real_array(flat.position, "position"),
                real_array(flat.orientation, "orientation"), given.element_length_nm, options
            )
        else:
            found = _core.energy_of_file(os.fspath(state), options)
    if note := found.pop("note", ""):
        _log.warning(note)
    for name in ("net_force", "net_torque"):
        found[name] = np.asarray(found[name])
    return StateEnergy(**found)
