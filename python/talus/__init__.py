"""Runs the program Talus and reads its results: runs, particles, meshes, histories, maps, checkpoints, tests of materials.

    import talus
    run = talus.run("scene.yaml", set={"time.end": 2}, out="runs/slope", progress=True)
    run = talus.open("runs/slope")                            # the same results, later
    run.history["kinetic"], run.history.units["kinetic"]      # (rows,), "J"
    run.history.plot("kinetic", "plastic")
    last = run.particles[-1]
    last.time, last["position"], last.units["position"]       # s, (particles, 3), "m"
    last.of("clay")["stress"]                                 # of one body: (its particles, 6)
    last.to_pandas(), run.particles.to_xarray("velocity")
    run.plot("displacement", time=2.5)
    run.checkpoints[-1]["particles/velocity"]                 # in double precision, with its digest checked
    talus.calibrate("calibration.yaml", jobs=4).values        # parameters from observations
    talus.sweep("study.yaml", jobs=4).to_pandas()             # several values of keys, and a table of the results
    talus.factor_of_safety("slope.yaml").factor               # by strength reduction
    talus.converge("slope.yaml").number("toe")["order"]       # with cells of several sizes
    talus.diff("runs/a", "runs/b", relative=1e-6).same        # field by field
    talus.drive({"law": "von_mises", ...}, test="uniaxial_strain_rate")

The package is one folder that can be copied.  It needs numpy, h5py to read checkpoints, and lz4 to read particles and meshes (Debian:
python3-numpy, python3-h5py, python3-lz4); pandas, xarray, matplotlib, PyVista, and for calibrations scipy, PyYAML and contourpy, are used
where they are installed, and MissingPackage names them where they are not.  Units are SI; a pure number has the unit "-".  Symmetric
tensors have six components, xx, yy, zz, xy, yz, xz (`tensors` makes matrices of them), others nine, by rows.  Vectors of particle and mesh
files have three components in two dimensions too.  Only `run`, `resume`, `drive`, `calibrate`, `sweep`, `converge` and `factor_of_safety`
write files.

Errors in a file are FileErrors with its name: `Damaged`, or `UnknownFormat` for a file of another version.  A missing file is a
FileNotFoundError; a missing field, column or body is a `Missing` error, which lists the existing ones.  An error of the program is a
`ProgramError`: SceneError, RunFailed or EnvironmentFailure, with the messages and their places.
"""
import sys as _sys
from importlib.util import find_spec as _find_spec

if _sys.argv[:1] == ["-m"] and _find_spec("numpy") is None:  # a command: its exit code 1 has another meaning
    print("error: numpy is not installed: install the Debian package python3-numpy, or pip install numpy", file=_sys.stderr)
    raise SystemExit(3)

from .calibration import Calibration, Estimate, calibrate
from .checkpoints import Body, CHECKPOINT_FORMATS, Checkpoint
from .comparison import Comparison, Difference, compare, tensors
from .components import von_mises
from .convergence import Convergence, converge
from .convert import to_pandas
from .differences import Differences, diff
from .errors import (Damaged, EnvironmentFailure, FileError, Message, Missing, MissingPackage, ProgramError, RunFailed, SceneError,
                     UnknownFormat)
from .fields import Mesh, Particles, Series
from .laboratory import TESTS, MaterialTest, drive
from .program import find_program, manual, schema
from .rasters import Maps, Raster
from .running import Progress, check, facts, resume, run
from .runs import Run, Sweep
from .runs import open_run as open
from .run_queue import StoppedRuns
from .scenes import to_yaml
from .strength_reduction import FactorOfSafety, factor_of_safety
from .sweeps import sweep
from .tables import PURE, Table

__version__ = "0.1.0"  # that of the program (CMakeLists.txt)

__all__ = ["Body", "CHECKPOINT_FORMATS", "Calibration", "Checkpoint", "Comparison", "Convergence", "Damaged", "Difference", "Differences",
           "EnvironmentFailure", "Estimate", "FactorOfSafety", "FileError", "Maps", "MaterialTest", "Mesh", "Message", "Missing",
           "MissingPackage", "PURE", "Particles", "ProgramError", "Progress", "Raster", "Run", "RunFailed", "SceneError", "Series",
           "StoppedRuns", "Sweep", "TESTS", "Table", "UnknownFormat", "calibrate", "check", "compare", "converge", "diff", "drive",
           "factor_of_safety", "facts", "find_program", "manual", "open", "resume", "run", "schema", "sweep", "tensors", "to_pandas",
           "to_yaml", "von_mises"]
