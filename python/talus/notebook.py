"""How results look in a notebook."""
from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any

from .errors import FileError
from .tables import PURE, Table

if TYPE_CHECKING:
    from .runs import Run

_ROWS = 6     # rows of a table at each end
_LISTED = 12  # entries of a list
_TABLE = "<table style='text-align:left'>"


def _row(name: str, value: str) -> str:
    return f"<tr><th style='text-align:left'>{escape(name)}</th><td style='text-align:left'>{value}</td></tr>"


def _listed(names: list[str]) -> str:
    more = f" and {len(names) - _LISTED} more" if len(names) > _LISTED else ""
    return escape(", ".join(names[:_LISTED]) + more)


def _number(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, float) else escape(str(value))


def run_to_html(run: Run) -> str:
    """A run as a table of HTML: status, bodies, size, cost, results, warnings.  Never raises: a notebook would show the error instead."""
    rows = [_row("folder", escape(str(run.folder)))]
    try:
        summary = run.summary
    except (OSError, FileError) as error:
        return f"{_TABLE}{rows[0]}{_row('summary', escape(str(error)))}</table>"
    rows.append(_row("status", f"<b>{escape(run.status)}</b>"))
    if message := summary.get("message"):
        rows.append(_row("message", escape(str(message))))
    bodies = [f"{body['name']} ({body.get('material', '')}, {body.get('particles', 0)} particles)" for body in summary.get("bodies", [])]
    rows.append(_row("bodies", _listed(bodies)))
    mesh = summary.get("mesh", {})
    rows.append(_row("mesh", escape(f"{summary.get('dimension', '?')}-D, {mesh.get('cells', '?')} cells, {mesh.get('nodes', '?')} nodes")))
    rows.append(_row("simulated", f"{_number(summary.get('simulated_time [s]', 0.0))} s in {_number(summary.get('steps', 0))} steps"))
    cost = summary.get("cost", {})
    if "wall [s]" in cost:
        rows.append(_row("took", f"{_number(float(cost['wall [s]']))} s with {_number(cost.get('threads', '?'))} threads"))
    try:
        results = escape(", ".join(f"{what} ({count})" for what, count in run.contents().items() if count))
    except (OSError, FileError) as error:
        results = escape(str(error))
    rows.append(_row("results", results))
    for warning in run.warnings:
        rows.append(_row("warning", escape(warning)))
    title = escape(str(summary.get("title", run.folder.name)))
    return f"<b>{title}</b>{_TABLE}{''.join(rows)}</table>"


def table_to_html(table: Table) -> str:
    """The first and last rows of a table, with units."""
    names = list(table)
    head = "".join(f"<th>{escape(name)}{'' if table.units[name] == PURE else f'<br>[{escape(table.units[name])}]'}</th>" for name in names)
    shown = list(range(table.rows)) if table.rows <= 2 * _ROWS else [*range(_ROWS), -1, *range(table.rows - _ROWS, table.rows)]
    body = "".join("<tr>" + "".join(f"<td>{'...' if row < 0 else _number(table[name][row].item())}</td>" for name in names) + "</tr>"
                   for row in shown)
    return f"<div style='overflow-x:auto'><table><tr>{head}</tr>{body}</table></div>{table.rows} rows, {len(names)} columns"
