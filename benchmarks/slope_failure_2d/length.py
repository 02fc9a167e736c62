"""The slope whose strength falls with a plastic strain averaged over 1 m: where the toe comes to rest over cells, meshes and kernels."""
import numpy as np

import lab as tools

LENGTH = 1.0  # m, softening_length; bands are 6.3 m wide
SIZES = [2.0, 1.5, 1.0, 0.7]  # m, cells
ENDS = [110.3, 110.6]  # m, of the level ground: gmsh makes other triangles
MESHES_AT = [2.0, 1.5]  # m, cells of the meshes that end there
MOST = 3.0  # m, asked: difference of the toes
KINDS = {"projected": ("projected", "aflip"), "umls": ("umls", "tpic"), "umls with aflip": ("umls", "aflip")}  # kernel and transfer


def polygons(end):
    """The regions of the scene, with the level ground up to x = end [m]."""
    return {"mesh.regions[0].shape.points": [[0, 0], [end, 0], [end, 15], [50, 15], [30, 35], [0, 35]],
            "mesh.regions[1].shape.points": [[0, 35], [30, 35], [50, 15], [end, 15], [end, 37], [0, 37]]}


def moved_front(frame):
    """x [m] that 99.5 % of what lay above the level ground does not exceed: without the single particles of the tip."""
    start = frame["position"] - frame["displacement"]
    moved = (start[:, 0] < 50) & (start[:, 1] > 15)
    place = frame["position"][moved, 0]
    order = np.argsort(place)
    share = np.cumsum(frame["mass"][moved][order]) / np.sum(frame["mass"][moved])
    return float(place[order][np.searchsorted(share, 0.995)])


def evaluate(lab, case, softening, toe, spacing):
    """Results of the toe and of the front of 99.5 % of the mass, and the differences of the toes of each kernel and of all runs."""
    variants = {(kind, size, 110.0): {} for kind in KINDS for size in SIZES}
    variants |= {("projected", size, end): polygons(end) for size in MESHES_AT for end in ENDS}
    runs = {key: lab.run(f"{case}/scene.yaml", tools.label(f"length_{key[0]}_{key[1]}_{key[2]}"), {
        **softening, "materials[0].softening_length": LENGTH, "mesh.size": key[1], "kernel": KINDS[key[0]][0], "transfer.scheme": KINDS[key[0]][1], **changes})
        for key, changes in variants.items()}
    results, toes = [], {}
    for (kind, size, end), run in runs.items():
        frame = run.last_frame()
        toes[kind, size, end] = toe(frame, spacing(run))
        name = f"softening over a length, {kind}, cells of {size} m" + (f", ground up to {end} m" if end != 110.0 else "")
        results += [tools.Result(case, f"toe of the debris, {name}", "m", toes[kind, size, end], "reported", None, None, "", run),
                    tools.Result(case, f"front of 99.5 % of the mass, {name}", "m", moved_front(frame), "reported", None, None, "", run)]
    for kinds in [[kind] for kind in KINDS] + [["projected", "umls"], ["projected", "umls with aflip"]]:
        of_kinds = [value for key, value in toes.items() if key[0] in kinds]
        name = {"projected, umls": "both kernels"}.get(", ".join(kinds), " and ".join(kinds))
        results.append(tools.Result(case, f"difference of the toes, softening over a length, {name}", "m", max(of_kinds) - min(of_kinds),
                                    "at most", MOST, 0.0, "independence of cells, meshes and kernels", list(runs.values())[-1]))
    return results
