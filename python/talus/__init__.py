"""Reads the results of Talus: runs, particles, meshes, histories, checkpoints, parameter studies.

    import talus
    run = talus.Run("runs/slope")
    run.history["kinetic"], run.history.units["kinetic"]      # (rows,), "J"
    last = run.particles[-1]
    last.time, last["position"], last.units["position"]       # s, (particles, 3), "m"
    last.of("clay")["stress"]                                 # of one body: (its particles, 6)
    run.checkpoints[-1]["particles/velocity"]                 # in double precision, with its digest checked

The package is one folder that can be copied.  It needs numpy, h5py to read checkpoints, and lz4 to read particles and meshes
(Debian: python3-numpy, python3-h5py, python3-lz4).  Units are SI; a pure number has the unit "-".  Symmetric tensors have six components,
xx, yy, zz, xy, yz, xz (`tensors` makes matrices of them), others nine, by rows.  Vectors of particle and mesh files have three components
in two dimensions too.  The package never writes files.

Errors in a file are FileErrors with its name: `Damaged`, or `UnknownFormat` for a file of another version.  A missing file is a
FileNotFoundError; a missing field, column or body is a `Missing` error, which lists the existing ones.
"""
from .checkpoints import Body, CHECKPOINT_FORMATS, Checkpoint
from .comparison import Comparison, Difference, compare, tensors
from .errors import Damaged, FileError, Missing, UnknownFormat
from .fields import Mesh, Particles, Series
from .runs import Run, Sweep
from .tables import PURE, Table

__all__ = ["Body", "CHECKPOINT_FORMATS", "Checkpoint", "Comparison", "Damaged", "Difference", "FileError", "Mesh", "Missing", "PURE", "Particles", "Run", "Series", "Sweep", "Table", "UnknownFormat",
           "compare", "tensors"]
