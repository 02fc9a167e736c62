"""The cases of a sweep, checked by the program before anything runs: errors of all of them, at the values that cause them."""
from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ..errors import Message
from ..program import Variant, check_variants
from ..run_states import DONE, PlannedRun, state_of
from .study import Study

_NAME_OF_ENTRY = re.compile(r' "[^"]*"')


@dataclass
class Plan:
    """A study with its folder and its cases.

    fronts  columns of run-out in the histories of the cases
    commit  of the program
    """

    study: Study
    folder: Path
    quick: bool
    program: Path
    cases: list[PlannedRun] = field(default_factory=list)
    fronts: list[str] = field(default_factory=list)
    commit: str = ""


def plan_sweep(study: Study, folder: Path, *, quick: bool, program: Path) -> Plan:
    """The cases of a study, each with the digest of its scene.  Raises SceneError with all errors of these scenes."""
    plan = Plan(study, folder, quick, program)
    plan.cases = [PlannedRun(study.scene, study.changes(i), folder / f"case_{i + 1:04}", quick=quick) for i in range(len(study.cases))]
    for case, found in zip(plan.cases, _ask(plan, plan.cases, None)):
        case.scene_digest = found.scene_digest
        plan.fronts += [name for name in found.fronts if name not in plan.fronts]
    return plan


def check_cases(plan: Plan, chosen: Sequence[int], *, models: bool = True) -> None:
    """Makes the meshes of these cases and sets their digests, and builds the models of those that are to begin.  Raises SceneError with all
    errors.

    models  whether any model is built
    """
    cases = [plan.cases[i] for i in chosen]
    for case, found in zip(cases, _ask(plan, cases, models)):
        case.mesh_digest = found.mesh_digest


def _ask(plan: Plan, cases: Sequence[PlannedRun], models: bool | None) -> list[Variant]:
    """What the program finds in cases: in their scenes, and unless `models` is None in their meshes too.  The model of a case that is done
    or goes on was checked when it began."""
    if not cases:
        return []
    variants = []
    for case in cases:
        state = state_of(case) if models else None
        is_checked = state is not None and (state.state == DONE or state.goes_on_from is not None)
        variants.append((case.changes, state.mesh_digest if state is not None and is_checked else ""))
    depth = {None: "scenes", False: "meshes", True: "models"}[models]
    plan.commit, found = check_variants(plan.study.scene, variants, depth, quick=plan.quick, program=plan.program)
    _raise_errors(plan, cases, found)
    return found


def _raise_errors(plan: Plan, cases: Sequence[PlannedRun], variants: Sequence[Variant]) -> None:
    """Raises SceneError if there are errors, each once: at the value in the study that causes it, or in the scene with the first affected
    case unless all are affected."""
    found: dict[Message, list[PlannedRun]] = {}
    of_value: set[Message] = set()
    for case, variant in zip(cases, variants):
        for message in variant.errors:
            changes = [k for k, change in enumerate(case.changes) if message.file == f"--set {change}"]
            if changes:
                message = _at_value(plan, case, changes[0], message)
                of_value.add(message)
            found.setdefault(message, []).append(case)
    problems = plan.study.problems
    for message, affected in found.items():
        if message not in of_value and len(affected) < len(cases):
            first = affected[0]
            causes = list(_changes_within(message.key, first))
            message = _at_value(plan, first, causes[0], message) if len(causes) == 1 else \
                message._replace(text=f"{message.text} (case {plan.cases.index(first) + 1}: {first})")
        if message not in problems.messages:
            problems.messages.append(message)
    problems.raise_any()


def _at_value(plan: Plan, case: PlannedRun, key: int, message: Message) -> Message:
    """The message at a value in the study."""
    entry = plan.study.cases[plan.cases.index(case)][key].entry
    lines = plan.study.problems.text.splitlines()
    return message._replace(file=str(plan.study.file), line=entry.line, column=entry.column, source=lines[entry.line - 1])


def _changes_within(key: str, case: PlannedRun) -> Iterable[int]:
    """The changes of the key of an error, or of a part of it."""
    path = _NAME_OF_ENTRY.sub("", key)  # bodies[0] "block".shape
    for k, change in enumerate(case.changes):
        changed = change.partition("=")[0]
        if path and (_is_within(changed, path) or _is_within(path, changed)):
            yield k


def _is_within(path: str, outer: str) -> bool:
    return path == outer or path.startswith((outer + ".", outer + "["))
