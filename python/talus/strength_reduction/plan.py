"""The runs of a search for a factor of safety: one that finds the state at rest, and trials that start from it with divided strength."""
from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..errors import Message, Missing, SceneError, located
from ..program import facts_of
from ..run_states import PlannedRun
from ..scenes import flow
from ..tables import number_text
from .search import AtRest, Criterion, Range, usual_duration

RUN, STATIC = "run", "static"
SEEKING = ("geostatic", "static")  # types of stages that end in equilibrium
_ROWS, _FILES = 100, 10            # of the history and of the particles of a run
# An increment of a static trial: forces in balance to this share of the loads, in at most so many iterations.  Cutting it in halves would
# not help, as its loads do not change.
_RESIDUAL, _ITERATIONS, _INCREMENTS = 1e-4, 20, 6
_DAMPING = 0.3
_KEPT = ("name", "material", "f_bar", "reference")  # keys of a body that takes its particles from another run


@dataclass(frozen=True)
class Options:
    """What is asked of a search; see `factor_of_safety`."""

    range: Range = Range()
    trials: str | None = None
    duration: float | None = None
    damping: float | None = None
    increments: int | None = None
    growth: float = 0.1
    kinetic: float | None = None
    steadiness: float | None = None
    share: float = 0.99
    bodies: tuple[str, ...] = ()
    quick: bool = False


@dataclass(frozen=True)
class Plan:
    """The checked information on the scene that a search needs.

    at_rest   the run of all stages up to the last one that seeks equilibrium
    bodies    whose strength is divided: {name: what it is divided by in the state at rest}
    columns   of the history with the displacement of the bodies
    field     field of the particles that shows the mechanism
    before    the bodies before the division
    kind      RUN or STATIC
    duration  of a trial [s]; of a static one the number of its increments
    mesh_digest  of the present mesh; empty for quick runs, whose mesh is another
    """

    scene: Path
    folder: Path
    title: str
    at_rest: PlannedRun
    bodies: dict[str, float]
    weakened: dict[str, float] = field(repr=False)
    of_state: tuple[str, ...] = field(repr=False)
    columns: tuple[str, ...]
    moved: list[dict[str, Any]] = field(repr=False)
    picture: Any = field(repr=False)
    field: str
    before: AtRest
    kind: str
    criterion: Criterion
    duration: float
    stage: dict[str, Any]
    program: Path
    mesh_digest: str

    def trial(self, factor: float, times_as_long: int) -> PlannedRun:
        """The run for a factor, with its duration multiplied.  Raises SceneError."""
        changes = (*self.of_state, *self._changes(factor, self.duration * times_as_long))
        return PlannedRun(self.scene, changes, self.folder / f"trial_{number_text(factor)}", digest_of(self.scene, changes, self.program),
                          self.mesh_digest, quick=self.at_rest.quick)

    def _changes(self, factor: float, duration: float) -> list[str]:
        weaken = [{"body": name, "factor": factor * divided} for name, divided in self.bodies.items()]
        weaken += [{"body": name, "factor": divided} for name, divided in self.weakened.items()]
        stage = {"duration": duration, **self.stage, "weaken": weaken}
        fields = ["velocity", "displacement"] + ([self.field] if self.field != "displacement" else [])
        solves = self.kind == STATIC  # each of its steps is an increment, with a row of its own
        outputs = {"particles": {"every": duration if solves else duration / _FILES, "fields": fields},
                   "history": {"every": duration / (1e3 * _ROWS if solves else _ROWS), "moved": self.moved}, "picture": self.picture}
        return [f"stages={flow([stage])}", f"outputs={flow(outputs)}"]

    @property
    def criterion_in_words(self) -> str:
        """What a trial is, and when it fails."""
        if self.kind == STATIC:
            return (f"{number_text(self.duration)} equilibria each; fails: growth above {self.criterion.growth:g} and steadiness "
                    f"above {self.criterion.steadiness:g}, or no equilibrium")
        return (f"trials of {number_text(self.duration)} s, damping: {self.stage['damping']:g}; fails: growth above "
                f"{self.criterion.growth:g} and kinetic energy above {self.criterion.liveliness:g} of its peak")


def digest_of(scene: Path, changes: Sequence[str], program: Path) -> str:
    """The digest of a scene with changes that this package has made.  The scene has been checked before: an error of these changes is not
    one of the user, so the message names the scene and not a --set that was not typed."""
    try:
        return facts_of(scene, changes, keys_only=True, program=program)["scene"]["digest"]
    except SceneError as error:
        refused = "a run that talus fos makes of this scene is refused: "
        problems = [Message("error", str(scene), 0, 0, message.key, refused + message.text, "") for message in error.errors]
        raise located(problems) from error


def plan_search(scene: Path, changes: Sequence[str], folder: Path, options: Options, program: Path) -> Plan:
    """Checks the scene with its mesh and plans the runs.  Raises SceneError with all errors, also with reasons why the strength cannot be
    divided."""
    facts = facts_of(scene, changes, program=program)
    stages = facts["stages"]
    last = max((i for i, stage in enumerate(stages) if stage["type"] in SEEKING), default=None)
    if last is None:
        raise located([Message("error", str(scene), 0, 0, "stages", "there is no stage of type geostatic or static: strength is divided in "
                                                                   "the state at rest that it finds", "")])
    there = {body["name"]: body for body in facts["bodies"] if body["stages"][last] is not None}
    chosen = _chosen(there, last, scene, options)
    before = AtRest(facts["gravity [m/s^2]"], max(body["highest [m]"] for body in chosen) - min(body["lowest [m]"] for body in chosen),
                    min(body["wave_speed [m/s]"] for body in chosen))
    kind, criterion, duration, stage = _trials(options, stages[last]["type"], before)
    at_rest = _until(facts, last) + ["outputs.checkpoint.at_end=true"]
    if kind == RUN and _flow_of(facts["keys"]):
        stage["hold_pore_pressure"] = True
    _refuse_changing_loads(facts, last, scene)
    mesh = "" if options.quick else facts["mesh"]["digest"]
    names = [body["name"] for body in chosen]
    columns = tuple(f"moved_{name}" for name in options.bodies) or ("moved",)
    moved = [{"name": f"moved_{name}", "body": name, "mass_share": options.share} for name in options.bodies]
    state = os.path.relpath(folder / "at_rest", Path(os.path.abspath(scene)).parent)  # so that both can be moved together
    picture = facts["keys"].get("outputs", {}).get("picture") if isinstance(facts["keys"].get("outputs"), Mapping) else None
    keeps_strain = any("plastic_strain" in body["stages"][last]["variables"] for body in chosen)
    divided = {name: body["stages"][last]["strength_divided_by"] for name, body in there.items()}
    plan = Plan(scene, folder, facts["title"],
                PlannedRun(scene, (*changes, *at_rest), folder / "at_rest", digest_of(scene, [*changes, *at_rest], program), mesh,
                           quick=options.quick),
                {name: divided[name] for name in names},
                {name: factor for name, factor in divided.items()
                 if factor != 1 and name not in names and there[name]["stages"][last]["has_strength"]},
                (*changes, *_from_state(facts, last, there), "initial=" + flow({"from": state})), columns,
                moved or [{"name": "moved", "mass_share": options.share}], picture if isinstance(picture, Mapping) else None,
                "plastic_strain" if keeps_strain else "displacement", before, kind, criterion, duration, stage, program, mesh)
    plan.trial(1.0, 1)  # errors of a trial are reported before the equilibrium is computed
    return plan


def _chosen(there: Mapping[str, Any], last: int, scene: Path, options: Options) -> list[Any]:
    """The bodies whose strength is divided, among those that are present in the state at rest."""
    problems = [Message("error", "", 0, 0, "", str(Missing("--bodies: in the state at rest", "body", name, list(there))), "")
                for name in options.bodies if name not in there]
    chosen = []
    for name, body in there.items():
        law, at = body["stages"][last], body["where"]
        if name in options.bodies and not law["has_strength"]:
            problems.append(Message("error", at["file"], at["line"], at["column"], at["key"],
                                    f"--bodies: its material \"{law['material']}\" has no strength to divide", ""))
        elif law["has_strength"] and (name in options.bodies or not options.bodies):
            chosen.append(body)
    if not chosen and not problems:
        problems.append(Message("error", str(scene), 0, 0, "", "no body has a material with strength that could be divided", ""))
    if problems:
        raise located(problems)
    return chosen


def _trials(options: Options, type_of_rest: str, before: AtRest) -> tuple[str, Criterion, float, dict[str, Any]]:
    """What a trial is, by default what found the state at rest: kind, criterion, duration and stage."""
    kind = options.trials or (STATIC if type_of_rest == STATIC else RUN)
    default = Criterion()
    criterion = Criterion(options.growth, options.kinetic if options.kinetic is not None else default.liveliness,
                          options.steadiness if options.steadiness is not None else default.steadiness, max(1 - options.share, 1e-6))
    if kind == STATIC:
        if any(given is not None for given in (options.duration, options.damping, options.kinetic)):
            raise SceneError("--duration, --damping and --kinetic belong to trials that are runs (--trials run); static trials have "
                             "--increments and --steadiness", 2)
        increments = options.increments if options.increments is not None else _INCREMENTS
        return kind, criterion, float(increments), {"type": "static", "increments": increments, "grow": False, "residual": _RESIDUAL,
                                                    "iterations": _ITERATIONS, "cuts": 0, "unbalanced": 1, "keep_jump_stress": False}
    if options.increments is not None or options.steadiness is not None:
        raise SceneError("--increments and --steadiness belong to static trials (--trials static); runs have --duration and --kinetic", 2)
    if not before.gravity > 0 and options.duration is None:
        raise SceneError("--duration is needed where there is no gravity: how long a trial lasts follows from it", 2)
    duration = options.duration if options.duration is not None else usual_duration(before)
    return kind, criterion, duration, {"type": "run", "damping": options.damping if options.damping is not None else _DAMPING}


def _until(facts: Mapping[str, Any], last: int) -> list[str]:
    """The changes that leave out later stages, with the bodies and boundary conditions that belong to them."""
    keys, changes = facts["keys"], []
    names = [stage["name"] for stage in facts["stages"]]
    if last + 1 == len(names):
        return []
    changes.append(f"stages={flow(keys['stages'][:last + 1])}")
    bodies = [one for one, body in zip(keys["bodies"], facts["bodies"]) if any(body["stages"][:last + 1])]
    if len(bodies) < len(keys["bodies"]):
        changes.append(f"bodies={flow(bodies)}")
    walls = []
    for wall in keys.get("boundaries") or []:
        during = [name for name in names[:last + 1] if name in map(str, wall.get("during") or [])]
        if not wall.get("during"):
            walls.append(wall)
        elif during:
            walls.append({**wall, "during": list(dict.fromkeys(during))})
    if walls != (keys.get("boundaries") or []):
        changes.append(f"boundaries={flow(walls)}")
    return changes


def _from_state(facts: Mapping[str, Any], last: int, there: Mapping[str, Any]) -> list[str]:
    """The changes of every trial: bodies, boundary conditions and water table are those of the last stage of the state at rest."""
    keys, changes = facts["keys"], []
    bodies = [{key: value for key, value in one.items() if key in _KEPT} | {"material": there[body["name"]]["stages"][last]["material"]}
              for one, body in zip(keys["bodies"], facts["bodies"]) if body["name"] in there]
    changes.append(f"bodies={flow(bodies)}")
    walls = keys.get("boundaries") or []
    acting = [_still({key: value for key, value in wall.items() if key != "during"}) for wall in walls if _acts(wall, facts, last)]
    if acting != walls:
        changes.append(f"boundaries={flow(acting)}")
    for stage in reversed(keys["stages"][:last + 1]):
        if stage.get("water"):
            changes.append(f"water.table={flow(stage['water']['table'])}")
            break
    return changes


def _acts(wall: Mapping[str, Any], facts: Mapping[str, Any], last: int) -> bool:
    """Whether a boundary condition acts in the state at rest."""
    return not wall.get("during") or facts["stages"][last]["name"] in map(str, wall["during"])


def _still(wall: Mapping[str, Any]) -> dict[str, Any]:
    """A boundary condition without the shaking that begins with the first stage with inertia, which a trial may be."""
    if wall.get("type") == "compliant_base":
        return {key: value for key, value in wall.items() if key not in ("velocity", "table", "record")}
    if wall.get("record"):
        return {key: value for key, value in wall.items() if key != "record"} | {"table": [[0, 0]]}
    return dict(wall)


def _flow_of(keys: Mapping[str, Any]) -> Mapping[str, Any]:
    """The block `water.flow` of a scene; empty without one."""
    water = keys.get("water")
    flow_of_water = water.get("flow") if isinstance(water, Mapping) else None
    return flow_of_water if isinstance(flow_of_water, Mapping) else {}


def _refuse_changing_loads(facts: Mapping[str, Any], last: int, scene: Path) -> None:
    """Raises SceneError where something that acts in the state at rest changes in time: time begins anew in a trial, which would judge the
    ground under other loads than those under which it is at rest."""
    keys = facts["keys"]
    acting = [(f"loads[{i}]", load) for i, load in enumerate(keys.get("loads") or [])]
    acting += [(f"boundaries[{i}]", _still(wall)) for i, wall in enumerate(keys.get("boundaries") or []) if _acts(wall, facts, last)]
    acting += [(f"water.flow.heads[{i}]", head) for i, head in enumerate(_flow_of(keys).get("heads") or [])]
    changing = [path for path, one in acting if len({float(row[1]) for row in one.get("table") or []}) > 1]
    text = "time begins anew in the trials of a factor of safety, with the first value of this table: give the value at rest as a constant"
    if changing:
        raise located([Message("error", str(scene), 0, 0, f"{path}.table", text, "") for path in changing])
