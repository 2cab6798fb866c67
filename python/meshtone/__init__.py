"""Vibration of gears, healthy or with damaged teeth.

>>> from meshtone import Scenario, ToothBreakage, simulate
>>> scenario = Scenario(module_mm=3, pinion_teeth=17, gear_teeth=38, face_width_mm=15, pinion_speed_hz=40, brake_torque_nm=10,
...                     din_grade=7, fault=ToothBreakage(chip_height_mm=5, chip_width_mm=12, tip_loss_mm=3))
>>> simulation = simulate(scenario)
>>> figure = simulation.plot()                      # doctest: +SKIP
>>> round(simulation.process().indicators["difference_kurtosis"]) > 3
True

The parts: :class:`Scenario`, :func:`Gearbox` and the faults say what is simulated; :func:`simulate` and :func:`simulate_many` do it; :mod:`meshtone.signal`
takes signals, simulated or measured, to condition indicators; :mod:`meshtone.hybrid` tunes simulations to a rig;
:mod:`meshtone.datasets` makes and loads labelled data sets, on which :mod:`meshtone.benchmark` poses tasks; :func:`diagnose` says what may be wrong with a gear; :func:`estimate_path` finds what lies between gears and sensor, :func:`adapt` makes a data set for a machine of it; :func:`explore` opens a page on which a scenario is changed and seen; :mod:`meshtone.plotting` draws; :mod:`meshtone.examples` has scenarios to start from.
"""

from . import _damage, datasets, examples, hybrid, signal
from ._adapt import Adaptation, adapt
from ._core import __version__
from ._damage import *
from ._diagnose import Diagnosis, diagnose
from ._explore import Explorer, explore
from ._path import PathEstimate, estimate_path
from ._warnings import MeshtoneWarning
from .datasets import Dataset, generate_dataset, load_dataset, verify_dataset
from .gearbox import Gearbox, gearbox_template
from .hybrid import enhance, tune
from .memory import set_memory_limit
from .recording import Recording, read_recording
from .scenario import Scenario, template
from .sensors import Sensor
from .signal import Record, ShaftPhase, process_channel, process_series
from .simulation import CHANNELS, ContactFigures, Signals, Simulation, StaticMesh, simulate, simulate_many, trace

__all__ = [
    "CHANNELS",
    "Adaptation",
    "ContactFigures",
    "Dataset",
    "Diagnosis",
    "Explorer",
    "Gearbox",
    "MeshtoneWarning",
    "PathEstimate",
    "Record",
    "Recording",
    "Scenario",
    "Sensor",
    "ShaftPhase",
    "Signals",
    "Simulation",
    "StaticMesh",
    "__version__",
    "adapt",
    "datasets",
    "diagnose",
    "enhance",
    "estimate_path",
    "examples",
    "explore",
    "gearbox_template",
    "generate_dataset",
    "hybrid",
    "load_dataset",
    "process_channel",
    "process_series",
    "read_recording",
    "set_memory_limit",
    "signal",
    "simulate",
    "simulate_many",
    "template",
    "trace",
    "tune",
    "verify_dataset",
]
__all__ += _damage.__all__
