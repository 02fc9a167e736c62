"""Optional packages, imported where they are first needed."""
from __future__ import annotations

import importlib
from types import ModuleType

from .errors import MissingPackage

# module -> its Debian package, or None where Debian 12 has none, and its name for pip
KNOWN = {
    "contourpy": ("python3-contourpy", "contourpy"),
    "h5py": ("python3-h5py", "h5py"),
    "lz4.block": ("python3-lz4", "lz4"),
    "matplotlib": ("python3-matplotlib", "matplotlib"),
    "matplotlib.figure": ("python3-matplotlib", "matplotlib"),
    "matplotlib.pyplot": ("python3-matplotlib", "matplotlib"),
    "matplotlib.collections": ("python3-matplotlib", "matplotlib"),
    "pandas": ("python3-pandas", "pandas"),
    "pyvista": (None, "pyvista"),
    "scipy.ndimage": ("python3-scipy", "scipy"),
    "scipy.optimize": ("python3-scipy", "scipy"),
    "scipy.stats": ("python3-scipy", "scipy"),
    "scipy.stats.qmc": ("python3-scipy", "scipy"),
    "xarray": ("python3-xarray", "xarray"),
    "yaml": ("python3-yaml", "pyyaml"),
}


def need(module: str, purpose: str) -> ModuleType:
    """Imports a module and returns it.

    module   one of KNOWN
    purpose  what it is needed for, such as "draws pictures"

    Raises MissingPackage, which names the package to install, if the module is not there.
    """
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name is None or not (module == error.name or module.startswith(error.name + ".")):
            raise  # the module is there, but something that it needs is not
        debian, pip = KNOWN[module]
        install = f"pip install {pip}"
        where = f"install the Debian package {debian}, or {install}" if debian else f"{install} (Debian 12 has no package of it)"
        raise MissingPackage(f"{pip}, which {purpose}, is not installed: {where}", name=error.name) from error
