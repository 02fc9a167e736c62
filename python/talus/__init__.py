"""Reads what Talus writes: runs, particles, meshes, histories, checkpoints, parameter studies.

    import talus
    run = talus.Run("runs/slope")
    run.history["kinetic"], run.history.units["kinetic"]      # (rows,), "J"
    last = run.particles[-1]
    last.time, last["position"], last.units["position"]       # s, (particles, 3), "m"
    last.of("clay")["stress"]                                 # of one body: (particles of it, 6)
    run.checkpoints[-1]["particles/velocity"]                 # in the precision of the run, its digest checked

One folder, to be copied where it is wanted.  It needs numpy, h5py where checkpoints are read and lz4 where particles and meshes are
(Debian: python3-numpy, python3-h5py, python3-lz4).  Units are SI; a pure number has the unit "-".  Symmetric tensors have six components,
xx, yy, zz, xy, yz, xz (`tensors` makes matrices of them), others nine, by rows.  Vectors of particle and mesh files have three components
in two dimensions too.  Nothing here writes.

What is wrong with a file is a FileError that names it: `Damaged`, or `UnknownFormat` where another version wrote it.  A file that is not
there is a FileNotFoundError, a field, column or body that is not there a `Missing`, which says what there is.
"""
from .checkpoints import Body, CHECKPOINT_FORMATS, Checkpoint
from .comparison import Comparison, Difference, compare, tensors
from .errors import Damaged, FileError, Missing, UnknownFormat
from .fields import Mesh, Particles, Series
from .runs import Run, Sweep
from .tables import PURE, Table

__all__ = ["Body", "CHECKPOINT_FORMATS", "Checkpoint", "Comparison", "Damaged", "Difference", "FileError", "Mesh", "Missing", "PURE", "Particles", "Run", "Series", "Sweep", "Table", "UnknownFormat",
           "compare", "tensors"]
