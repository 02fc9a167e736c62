"""A bar of one square, two triangles and two particles: velocities against the exact solution of the equations of the method."""
import numpy as np

import lab as tools

CASE = "single_particle_bar"
SEEN = {"outer": [1 / 3, 1 / 3], "inner": [0, 1 / 3]}  # weights of the free nodes (1, 0) and (1, 1) at the particles


def nodal_velocities(time, data):
    """Velocities of the two free nodes [m/s], shape (2, n): U'' = -k M U, from rest with the speed v0, see README.md."""
    stiffness = data["modulus [Pa]"] / data["density [kg/m^3]"] * np.array([[4.5, -1.5], [-0.75, 2.25]])
    squares, modes = np.linalg.eig(stiffness)
    shares = np.linalg.solve(modes, np.full(2, data["speed [m/s]"]))
    return modes @ (shares[:, None] * np.cos(np.sqrt(squares)[:, None] * time))


def exact(name, time, data):
    """Velocity of a particle [m/s]; at the start, before anything holds it, it is v0."""
    velocity = np.array(SEEN[name]) @ nodal_velocities(time, data)
    return np.where(time > 0, velocity, data["speed [m/s]"])


def draw(figure, run, data):
    """Velocities over time."""
    for axis, name in zip(figure.subplots(1, 2, sharey=True), SEEN):
        time = run.history["time"]
        axis.plot(time, exact(name, time, data) / data["speed [m/s]"], "k-", linewidth=0.8, label="exact")
        axis.plot(time[::5], run.history[f"{name}_vx"][::5] / data["speed [m/s]"], "C1.", markersize=3, label="talus")
        axis.set(title=f"{name} particle", xlabel="time [s]")
    figure.axes[0].set_ylabel("velocity / v0")
    figure.axes[0].legend()


def evaluate(lab):
    """Errors of both particles over ten periods."""
    data = tools.reference(CASE)
    run = lab.run(f"{CASE}/scene.yaml", "tpic", {"kernel": "linear", "transfer.scheme": "tpic"})
    time, v0 = run.history["time"], data["speed [m/s]"]
    results = [tools.Result(CASE, f"velocity of the {name} particle over ten periods, largest error over v0", "-",
                            float(np.abs(run.history[f"{name}_vx"] - exact(name, time, data)).max() / v0), "at most", data["largest error"], 0.0,
                            data["source"], run) for name in SEEN]
    lab.figure(CASE, "verification_single", lambda figure: draw(figure, run, data), size=(7.2, 2.8), caption="Bar of two particles: velocities over ten periods.")
    return results
