"""Badly shaped meshes of boxes for tests, as files of gmsh (version 2.2): nodes and cells as arrays."""
import hashlib
import itertools

import numpy as np


def box(axes):
    """Triangles or tetrahedra over the product of coordinates: every rectangle in 2, every cuboid in 6."""
    shape, dimension = [len(axis) for axis in axes], len(axes)
    nodes = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, dimension)
    cells = []
    for corner in itertools.product(*(range(n - 1) for n in shape)):
        for order in itertools.permutations(range(dimension)):
            path = [np.array(corner)]
            for axis in order:
                path.append(path[-1] + np.eye(dimension, dtype=int)[axis])
            cells.append([int(np.ravel_multi_index(tuple(step), shape)) for step in path])
    return nodes, np.array(cells)


def middle(facet):
    """The incentre of a facet (of an edge: its middle), and its distance from the edges."""
    if len(facet) == 2:
        return facet.mean(axis=0), np.linalg.norm(facet[1] - facet[0]) / 2
    sides = np.array([np.linalg.norm(facet[(i + 1) % 3] - facet[(i + 2) % 3]) for i in range(3)])
    area = np.linalg.norm(np.cross(facet[1] - facet[0], facet[2] - facet[0])) / 2
    return sides @ facet / sides.sum(), 2 * area / sides.sum()


def slivered(nodes, cells, angle, every):
    """Every so many cells get a node so near to their largest facet that the cell between the two has the angle [deg]; the others stay."""
    nodes, made = list(nodes), []
    for number, cell in enumerate(cells.tolist()):
        if number % every:
            made.append(cell)
            continue
        x = np.array([nodes[n] for n in cell])
        facets = [np.delete(x, apex, axis=0) for apex in range(len(cell))]
        apex = int(np.argmax([np.linalg.det(edges @ edges.T) for edges in (facet[1:] - facet[0] for facet in facets)]))
        edges, up = (facets[apex][1:] - facets[apex][0]).T, x[apex] - facets[apex][0]
        up = up - edges @ np.linalg.lstsq(edges, up, rcond=None)[0]  # normal to the facet
        centre, distance = middle(facets[apex])
        nodes.append(centre + up / np.linalg.norm(up) * distance * np.tan(np.radians(angle)))
        made += [[*(n for i, n in enumerate(cell) if i != corner), len(nodes) - 1] for corner in range(len(cell))]
    return np.array(nodes), np.array(made)


def alternating(low, high, pairs, ratio):
    """Coordinates with alternating wide and narrow intervals of the given ratio."""
    widths = np.tile([ratio, 1.0], pairs)
    return low + (high - low) * np.concatenate([[0], np.cumsum(widths) / widths.sum()])


def text(nodes, cells):
    """The text of the mesh file."""
    kind = 2 if cells.shape[1] == 3 else 4
    points = np.c_[nodes, np.zeros((len(nodes), 3 - nodes.shape[1]))]
    listed = [f"{n + 1} {x!r} {y!r} {z!r}" for n, (x, y, z) in enumerate(points.tolist())]
    joined = [f"{c + 1} {kind} 2 1 1 {' '.join(str(n + 1) for n in cell)}" for c, cell in enumerate(cells.tolist())]
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(nodes)), *listed, "$EndNodes", "$Elements", str(len(cells)), *joined,
             "$EndElements"]
    return "\n".join(lines) + "\n"


def written(lab, case, name, nodes, cells):
    """Writes a mesh beside the runs of the case, with a digest of its contents in its name; returns the settings for it."""
    content = text(nodes, cells)
    path = lab.runs.resolve() / f"{case}_meshes" / f"{name}_{hashlib.sha256(content.encode()).hexdigest()[:8]}.msh"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(content, encoding="utf-8")
    return {"mesh": {"file": str(path)}}
