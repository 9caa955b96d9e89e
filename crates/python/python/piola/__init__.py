"""Solid and fluid mechanics with smoothed particle hydrodynamics.

A case is what a case file says; a simulation is a run of it.

>>> import piola
>>> case = piola.Case({
...     "version": 1, "title": "a falling column", "dimension": 2,
...     "body": [{
...         "name": "column",
...         "shape": {"kind": "box", "min": [0, 0], "max": [1, 2]},
...         "spacing": 0.25,
...         "material": {"kind": "gamma_law", "density": 1000, "gamma": 7, "wave_speed": 10},
...         "initial": {"velocity": ["0", "-1"]},
...     }],
...     "scheme": {"kind": "upwind", "kernel": "cubic_spline", "smoothing_length": 0.7, "tau_velocity": 0.5},
...     "time": {"end": 0.01, "cfl": 0.3},
...     "output": {"every": 0.01, "table_every": 0.005},
... })
>>> case.faults()
[]
>>> simulation = case.start()
>>> simulation.bodies["column"]["velocity"].shape
(45, 2)
>>> simulation.run().outcome
'completed'
>>> simulation.tables["energy"]["kinetic"].shape
(3,)
"""

from ._display import Picture
from ._piola import (
    Bodies,
    Body,
    Case,
    CaseError,
    Cloud,
    Every,
    Fault,
    Field,
    Moment,
    Plan,
    Run,
    RunError,
    Sensitivity,
    Simulation,
    Table,
    Tables,
    __version__,
    field_of,
)

__all__ = [
    "Bodies",
    "Body",
    "Case",
    "CaseError",
    "Cloud",
    "Every",
    "Fault",
    "Field",
    "Moment",
    "Picture",
    "Plan",
    "Run",
    "RunError",
    "Sensitivity",
    "Simulation",
    "Table",
    "Tables",
    "__version__",
    "field_of",
]
