"""The levels of a convergence study: a scene, and the same with larger or smaller cells."""
from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..errors import Message, check_ranges, located
from ..program import Variant, check_variants, facts_of
from ..run_states import PlannedRun

MOST_LEVELS = 8
# Sizes of the cells of two levels that differ by less than this factor tell nothing.  Those of Celik et al. 2008 differ by 1.3 at least.
_HARDLY_SMALLER = 1.1
# Ratios of sizes that are this far from the wanted one, as a share of it, get a warning; so do ratios of the axes of a grid.
_ABOUT = 0.1


@dataclass(frozen=True)
class Options:
    """What is asked of a study; see `converge`."""

    ratio: float = math.sqrt(2)
    levels: int = 3
    finer: int = 0
    collect: tuple[str, ...] = ()
    within: float | None = None
    quick: bool = False


@dataclass
class Level(PlannedRun):
    """The scene with all sizes of its cells multiplied by a factor.

    of_mesh  the changes that do so, as for --set
    size     mean size of the cells, (volume / number)^(1 / dimension) [m]
    """

    factor: float = 1.0
    of_mesh: list[str] = field(default_factory=list)
    cells: int = 0
    particles: int = 0
    size: float = 0.0


@dataclass
class Plan:
    """A scene with its levels, from coarse to fine.

    commit    of the program
    warnings  of meshes that are not similar to each other
    """

    scene: Path
    folder: Path
    options: Options
    program: Path
    levels: list[Level]
    commit: str = ""
    warnings: list[str] = field(default_factory=list)


def check_options(options: Options, jobs: int | None, threads: int | None) -> None:
    """Raises SceneError with all options that are out of their range."""
    wrong = []
    if options.within is not None and not 0 < options.within < math.inf:
        wrong.append(f"within {options.within:g} must be above 0")
    if options.within is not None and not options.collect:
        wrong.append("within needs collect: the numbers that are to be within this share")
    if options.finer >= options.levels:
        wrong.append(f"--finer {options.finer} must be below --levels {options.levels}: the scene as it is is one of the levels")
    check_ranges({"ratio": (options.ratio, 1.2, 4), "levels": (options.levels, 3, MOST_LEVELS),
                  "finer": (options.finer, 0, MOST_LEVELS - 1), "jobs": (jobs, 1, 1024),
                  "threads": (threads, 1, 1024)}, wrong)


def scaled_mesh(mesh: Mapping[str, Any], factor: float) -> list[str]:
    """The changes that multiply all sizes of generated cells by a factor, for the keys of `mesh` as they are in the scene.  Sizes are
    rounded to six digits; numbers of intervals to whole ones."""
    terrain = mesh.get("terrain") or {}
    blocks = [("mesh", mesh), *_numbered("mesh.refine", mesh.get("refine"))]
    of_terrain = [*_numbered("mesh.terrain.layers", terrain.get("layers")), ("mesh.terrain.air", terrain.get("air") or {}),
                  *_numbered("mesh.terrain.refine", terrain.get("refine"))]
    cells = [f"mesh.grid.cells={scaled_cells(mesh['grid']['cells'], factor)}"] if mesh.get("grid") else []
    return [*_scaled_sizes(blocks, factor), *cells, *_scaled_sizes(of_terrain, factor)]


def scaled_cells(cells: Sequence[int], factor: float) -> list[int]:
    """The numbers of intervals of a grid for cells that are larger by a factor."""
    return [max(1, math.floor(count / factor + 0.5)) for count in cells]


def plan_levels(scene: Path, changes: Sequence[str], folder: Path, options: Options, program: Path) -> Plan:
    """Checks the scene, makes the mesh and the model of each level.  Raises SceneError with all errors of the scene and of its levels, and
    with reasons why its cells cannot be made smaller.

    changes  of the scene, such as "time.end=2"
    """
    facts = facts_of(scene, changes, keys_only=True, program=program)
    mesh, where = facts["keys"]["mesh"], {place["key"]: Message("error", text="", source="", **place) for place in facts["where"]}
    _refuse_fixed_cells(mesh, where)
    plan = Plan(scene, folder, options, program, [])
    for k in range(options.levels - 1 - options.finer, -options.finer - 1, -1):
        factor = options.ratio**k
        of_mesh = scaled_mesh(mesh, factor) if k else []
        plan.levels.append(Level(scene, [*changes, *of_mesh], folder / f"cells_x{factor:.4g}", quick=options.quick, factor=factor,
                                 of_mesh=of_mesh))
    in_turn = sorted(plan.levels, key=lambda level: level.factor != 1)  # the scene itself first: its errors are those of the user
    plan.commit, found = check_variants(scene, [(level.changes, "") for level in in_turn], "models", quick=options.quick, program=program)
    _raise_errors(in_turn, found, where["mesh"])
    for level, variant in zip(in_turn, found):
        level.scene_digest, level.mesh_digest = variant.scene_digest, variant.mesh_digest
        level.cells, level.particles, level.size = variant.cells, variant.particles, variant.cell_size
    if mesh.get("grid"):
        _compare_shapes(mesh["grid"]["cells"], where["mesh"], plan)
    _compare_sizes(where["mesh"], plan)
    return plan


def _numbered(path: str, blocks: Sequence[Mapping[str, Any]] | None) -> list[tuple[str, Mapping[str, Any]]]:
    return [(f"{path}[{k}]", block) for k, block in enumerate(blocks or [])]


def _scaled_sizes(blocks: Sequence[tuple[str, Mapping[str, Any]]], factor: float) -> list[str]:
    return [f"{path}.size={block['size'] * factor:.6g}" for path, block in blocks if block.get("size") is not None]


def _refuse_fixed_cells(mesh: Mapping[str, Any], where: Mapping[str, Message]) -> None:
    """Raises SceneError with all reasons why the cells of the scene cannot be scaled with its particles."""
    problems = []
    if mesh.get("file"):
        problems.append(where["mesh"]._replace(
            key="mesh.file", text="the cells of a mesh file stay as they are: give mesh.geometry with mesh.size, mesh.regions, mesh.grid "
                                  "or mesh.terrain; or run the scene on several files with talus sweep"))
    if "initial" in where:
        problems.append(where["initial"]._replace(text="the particles of another run keep their number, so that smaller cells would have "
                                                       "fewer of them: study the scene of that run"))
    if problems:
        raise located(problems)


def _raise_errors(levels: Sequence[Level], found: Sequence[Variant], mesh: Message) -> None:
    """Raises SceneError with the errors of levels: each once, and in the scene where they are in changes that the user did not type."""
    problems: dict[Message, Message] = {}
    for level, variant in zip(levels, found):
        for message in variant.errors:
            if message.file in [f"--set {change}" for change in level.of_mesh]:
                message = mesh._replace(key=message.key, text=message.text)
            told = f"{message.text} (with {', '.join(level.of_mesh)})" if level.of_mesh else message.text
            problems.setdefault(message, message._replace(text=told))
    if problems:
        raise located(list(problems.values()))


def _compare_shapes(cells: Sequence[int], mesh: Message, plan: Plan) -> None:
    """Warns of grids whose cells have another shape at some level."""
    for level in plan.levels:
        scaled = scaled_cells(cells, level.factor)
        factors = [count / now for count, now in zip(cells, scaled)]
        if max(factors) > (1 + _ABOUT) * min(factors):
            plan.warnings.append(f"{mesh.place}: mesh.grid.cells: {scaled} of a level is not similar to {cells} in the scene: orders "
                                 f"cannot be relied on; --ratio 2 --finer {len(plan.levels) - 1} keeps all levels similar")
            return


def _compare_sizes(mesh: Message, plan: Plan) -> None:
    """Raises SceneError if cells hardly change from level to level; warns if they do not change as wanted."""
    ratio = plan.options.ratio
    for coarse, fine in zip(plan.levels, plan.levels[1:]):
        measured = coarse.size / fine.size
        if measured < _HARDLY_SMALLER:
            raise located([mesh._replace(text=f"cells of {coarse.size:.4g} m and of {fine.size:.4g} m hardly differ, although their sizes "
                                              f"were scaled by {ratio:.4g}: do sizes in the geometry, or few intervals of a grid, set "
                                              "them?")])
        if abs(measured / ratio - 1) > _ABOUT:
            plan.warnings.append(f"cells of {coarse.size:.4g} m are {measured:.4g} times as large as those of {fine.size:.4g} m, not "
                                 f"{ratio:.4g} times; orders are computed with the sizes that the cells have")
