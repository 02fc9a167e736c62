"""Layer sliding on a rough base: the friction that each match of Drucker-Prager and Mohr-Coulomb mobilise, beside the closed forms."""
import numpy as np

import lab as tools

CASE = "infinite_slope"
STEADY = 0.3  # s, from when on is measured
MIDDLE = (4, 8)  # m, along the layer, whose free ends are at 0 and 12
SHEARING = 0.25  # m, height of the soil that is measured: two rows of cells, where it shears fastest


def cone(match, phi, psi):
    """q_phi and q_psi of a cone: shear strength over mean pressure, and volume over twice the shear of its flow [-]."""
    sines = np.sin([phi, psi])
    if match == "outer":
        return 2 * np.sqrt(3) * sines / (3 - sines)
    if match == "inner":
        return 2 * np.sqrt(3) * sines / (3 + sines)
    q_psi = np.sqrt(3) * sines[1] / np.sqrt(3 + sines[1] ** 2)  # flow without strain out of plane fixes where on the circle the stress sits
    return sines[0] / (np.sqrt(1 - q_psi**2 / 3) + q_psi * sines[0] / 3), q_psi


def closed_form(soil, phi):
    """Angle [deg] whose tangent is shear stress over normal stress on the plane of simple shear, friction angle phi [rad].

    A cone flows along s / (2 tau) + q_psi / 3, without strain along the plane and out of it: s_xx = s_zz = -2 q_psi tau / 3, s_yy = 4 q_psi tau / 3,
    so that s_xy = tau sqrt(1 - 4 q_psi^2 / 3), with tau = q_phi p. Mohr-Coulomb: the plane of shear is one without extension (Davis 1968).
    """
    psi = np.radians(soil["dilation_angle"])
    if soil["law"] == "mohr_coulomb":
        return float(np.degrees(np.arctan(np.sin(phi) * np.cos(psi) / (1 - np.sin(phi) * np.sin(psi)))))
    q_phi, q_psi = cone(soil["match"], phi, psi)
    return float(np.degrees(np.arctan(q_phi * np.sqrt(1 - 4 * q_psi**2 / 3) / (1 - 4 * q_phi * q_psi / 3))))


def settings(soil, angle, data):
    """What a run changes in the scene: the soil, and gravity turned by `angle` [deg]."""
    turned, size = np.radians(angle), data["gravity [m/s^2]"]
    strength = {key: soil[key] for key in ("law", "match", "dilation_angle") if key in soil}
    return {"loads[0].acceleration": [float(size * np.sin(turned)), float(-size * np.cos(turned))], "materials[0]": {**data["constants"], **strength}}


def of_the_soil(run):
    """Times [s] and the angle [deg] of shear over normal stress, summed over the volume of the shearing soil in the middle of the layer."""
    every, rows = 0.05, []  # s, as in the scene
    for number, frame in enumerate(run.frames):
        if number > 1:
            x, y = frame["position"][:, 0], frame["position"][:, 1]
            weight = frame["volume"] * ((x > MIDDLE[0]) & (x < MIDDLE[1]) & (y < SHEARING))
            rows.append((every * number, np.degrees(np.arctan2(weight @ frame["stress"][:, 3], -weight @ frame["stress"][:, 1]))))
    return np.array(rows).T


def of_the_base(run):
    """Times [s] and the angle [deg] of the reactions of the middle of the base."""
    history = run.history
    late = history["time"] > 0.1
    return history["time"][late], np.degrees(np.arctan2(-history["reaction_middle_x"][late], history["reaction_middle_y"][late]))


def steady(times, angles):
    """Mean over what is steady [deg]."""
    return float(np.mean(angles[times > STEADY - 1e-9]))


def draw(figure, runs, data):
    """Measured angles over the closed form, and the difference over time."""
    axes, phi = figure.subplots(1, 2), np.radians(data["constants"]["friction_angle"])
    for colour, (name, (soil, run)) in enumerate(runs.items()):
        expected = closed_form(soil, phi)
        times, angles = of_the_soil(run)
        axes[0].plot(expected, steady(times, angles), "o", color=f"C{colour}", fillstyle="none", ms=8, label=name)
        axes[1].plot(times, angles - expected, "o-", color=f"C{colour}", ms=3)
        times, angles = of_the_base(run)
        axes[0].plot(expected, steady(times, angles), "x", color=f"C{colour}")
        axes[1].plot(times, angles - expected, "--", color=f"C{colour}", lw=0.8)
    line = np.array([25.5, 36])
    axes[0].plot(line, line, "k", lw=0.8)
    axes[0].fill_between(line, line - data["tolerance [deg]"], line + data["tolerance [deg]"], color="k", alpha=0.1, lw=0)
    axes[0].set(xlabel="closed form [deg]", ylabel="measured [deg]: o soil, x base")
    axes[0].legend()
    axes[1].axhspan(-data["tolerance [deg]"], data["tolerance [deg]"], color="k", alpha=0.1, lw=0)
    axes[1].set(xlabel="time [s]", ylabel="measured - closed form [deg]: -o- soil, - - base", ylim=(-2.5, 2.5))


def evaluate(lab):
    """Every soil on a slope steeper by the same angle than what it holds; at full level variants of one of them."""
    data, results = tools.reference(CASE), []
    phi, excess = np.radians(data["constants"]["friction_angle"]), data["excess [deg]"]
    plan = {soil["name"]: (soil, excess, True, {}) for soil in data["soils"]}
    if lab.level == "full":
        soil = plan["plane_strain"][0]
        plan |= {"plane_strain, half the step": (soil, excess, False, {"time.cfl": 0.25}),
                 "plane_strain, flip": (soil, excess, False, {"transfer.scheme": "flip"}),
                 "plane_strain, steeper by 1.5 degrees": (soil, 1.5, False, {}),
                 "plane_strain, cells of 0.0625 m": (soil, excess, False, {"mesh.size": 0.0625})}
    runs = {}
    for name, (soil, steeper, _, extra) in plan.items():
        label = tools.label(name)
        runs[name] = lab.run(f"{CASE}/scene.yaml", label, {**settings(soil, closed_form(soil, phi) + steeper, data), **extra})
    for name, (soil, _, judged, _) in plan.items():
        run, expected = runs[name], closed_form(soil, phi)
        asked = ("near", data["tolerance [deg]"]) if judged else ("reported", None)
        results.append(tools.Result(CASE, f"friction of the soil, {name}", "deg", steady(*of_the_soil(run)), *asked, expected, data["source"], run))
        results.append(tools.Result(CASE, f"reactions of the base, {name}", "deg", steady(*of_the_base(run)), "reported", None, expected, "", run))
    shown = {soil["name"]: (soil, runs[soil["name"]]) for soil in data["soils"]}
    lab.figure(CASE, "verification_infinite_slope", lambda figure: draw(figure, shown, data), size=(8.4, 3.6),
               caption="Friction mobilised by soils of 30 degrees: ratio of stresses in the shearing soil and of reactions of the base (grey: 0.5 degrees).")
    return results
