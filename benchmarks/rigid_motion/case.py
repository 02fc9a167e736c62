"""Rigid motion: a free block flies through a hundred cells without stress; how much angular momentum and energy a spinning disk loses."""
import numpy as np

import lab as tools

CASE = "rigid_motion"
FLIGHTS = [*((kernel, scheme) for kernel in ("umls", "linear") for scheme in ("flip", "apic", "tpic")), ("projected", "aflip")]
SPINS = {"flip": "umls", "apic": "umls", "tpic": "umls", "aflip": "projected"}  # transfer: kernel
TURNS = {"quick": 20, "full": 1000}


def flight(lab, kernel, scheme):
    """Starts a flight."""
    return lab.run(f"{CASE}/scene.yaml", f"flight_{kernel}_{scheme}", {"kernel": kernel, "transfer.scheme": scheme})


def spin(lab, scheme):
    """Starts a spin of some turns; rows at twenty places of a turn."""
    turns = TURNS[lab.level]
    return lab.run(f"{CASE}/scene_spin.yaml", f"spin_{scheme}_{turns}", {"kernel": SPINS[scheme], "transfer.scheme": scheme, "time.end": turns})


def judge_flight(kernel, scheme, run, data):
    """Largest stress at the end over the modulus, largest change of momentum over its start."""
    asked, history = data["flight"], run.history
    stress = float(np.abs(run.last_frame()["stress"]).max()) / 10
    drift = np.hypot(history["momentum_x"] - history["momentum_x"][0], history["momentum_y"]) / history["momentum_x"][0]
    name = f"flight, {kernel}, {scheme}"
    return [tools.Result(CASE, f"largest stress over the modulus, {name}", "-", stress, "at most", asked["largest stress over modulus"], 0.0, asked["source"], run),
            tools.Result(CASE, f"drift of momentum, {name}", "-", float(drift.max()), "at most", asked["largest drift of momentum"], 0.0, asked["source"], run)]


def angular(history):
    """Angular momentum over its start: the column about z."""
    column = history["angular_momentum_z" if "angular_momentum_z" in history else "angular_momentum"]
    return column / column[0]


def judge_spin(scheme, turns, run, data):
    """What is left of angular momentum and kinetic energy at the end; the former is judged where the transfer is not known to lose it."""
    asked, name = data["spin"], f"spin of {turns} turns, {scheme}"
    kinetic = run.history["kinetic"]
    judged = turns == TURNS["quick"] and scheme not in asked["not judged"]
    against = ("near", asked["largest change of angular momentum"], 1.0, asked["source"]) if judged else ("reported", None, 1.0, asked["source"])
    return [tools.Result(CASE, f"angular momentum over its start, {name}", "-", float(angular(run.history)[-1]), *against, run),
            tools.Result(CASE, f"kinetic energy over its start, {name}", "-", float(kinetic[-1] / kinetic[0]), "reported", None, 1.0, asked["source"], run)]


def draw(figure, spins):
    """Angular momentum over turns."""
    axis = figure.subplots()
    for scheme, run in spins.items():
        axis.plot(run.history["time"], angular(run.history), label=f"{SPINS[scheme]}, {scheme}")
    axis.set(xlabel="turns", ylabel="angular momentum over its start")
    axis.legend()


def evaluate(lab):
    """Flights with three kernels, spins with two, each with the transfers that it may have."""
    data = tools.reference(CASE)
    flights = {(kernel, scheme): flight(lab, kernel, scheme) for kernel, scheme in FLIGHTS}
    spins = {scheme: spin(lab, scheme) for scheme in SPINS}
    results = [result for (kernel, scheme), run in flights.items() for result in judge_flight(kernel, scheme, run, data)]
    results += [result for scheme, run in spins.items() for result in judge_spin(scheme, TURNS[lab.level], run, data)]
    lab.figure(CASE, "verification_spin", lambda figure: draw(figure, spins), caption="Angular momentum of a free spinning disk, four transfers.")
    return results
