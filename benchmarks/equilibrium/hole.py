"""A round hole in Mohr-Coulomb soil under the same stress from all sides (Salencon 1969), small strains, plane strain."""
import numpy as np

import lab as tools

case = tools.module("equilibrium")
FLOWS = {"associated": 30, "no dilation": 0}  # angle of dilation [deg]
ENDS = {"unloaded": 0, "expanded": 2.5e5}  # pressure [Pa] in the hole at the end
SIZES = {"quick": (0.25,), "full": (0.25, 0.125, 0.0625)}  # m, beside the hole
WIDE, OUTER = 6.6, 6  # m, side of the mesh and outer radius of the soil


class Salencon:
    """Stress and displacement around the hole; compression is positive here, displacement outward.

    Where the soil yields s_r + H = N (s_t + H), H = c cot phi, and D e_r + e_t = 0 for the plastic strains. N = tan^2(45 + phi / 2) and
    D = tan^2(45 + psi / 2) where the pressure grew, their inverses where it fell. The stress out of the plane is the intermediate one.
    """

    def __init__(self, data, pressure, dilation):
        self.radius, self.far, self.poisson = (data[key] for key in ("radius [m]", "stress at infinity [Pa]", "poisson_ratio"))
        self.pressure = pressure
        angles = np.radians([data["friction_angle [deg]"], dilation])
        self.shear = data["youngs_modulus [Pa]"] / (2 * (1 + self.poisson))
        self.apex = data["cohesion [Pa]"] / np.tan(angles[0])
        self.ratio, self.flow = np.tan(np.pi / 4 + np.sign(pressure - self.far) * angles / 2)**2
        # Radial stress at the plastic radius less that at infinity.
        self.jump = (self.far + self.apex) * (self.ratio - 1) / (self.ratio + 1)
        self.power = (self.ratio - 1) / self.ratio
        self.plastic = self.radius * ((pressure + self.apex) / (self.far + self.jump + self.apex))**(1 / self.power)

    def stress(self, r):
        """Radial and hoop stress [Pa]."""
        near = self.plastic / r
        yielded = (self.far + self.jump + self.apex) * near**self.power
        return (np.where(near > 1, yielded - self.apex, self.far + self.jump * near**2),
                np.where(near > 1, yielded / self.ratio - self.apex, self.far - self.jump * near**2))

    def outward(self, r):
        """Displacement [m]: of the equation -D u' - u / r = D e_r + e_t with the elastic strains, and continuous at the plastic radius."""
        n, d, nu, m, c = self.ratio, self.flow, self.poisson, self.power, self.plastic
        edge = self.far + self.jump + self.apex
        varying = -edge / (2 * self.shear) * (d * (1 - nu - nu / n) + (1 - nu) / n - nu) / (d * (1 - m) + 1)
        constant = (self.far + self.apex) / (2 * self.shear) * (1 - 2 * nu)
        rest = self.jump * c / (2 * self.shear) - (varying + constant) * c
        return np.where(r < c, rest * (c / r)**(1 / d) + varying * r * (c / r)**m + constant * r, self.jump * c**2 / (2 * self.shear * r))


def exact_of(data, end, flow):
    return Salencon(data, ENDS[end], FLOWS[flow])


def settings(data, size, end, flow):
    """Changes to the scene: the outer pressure is that of the infinite ground there."""
    exact = exact_of(data, end, flow)
    changes = {"mesh.size": max(0.5, 2 * size), "mesh.refine[0].size": size, "materials[0].dilation_angle": FLOWS[flow]}
    if end == "expanded":
        changes |= {"loads[0].table": [[0, 1], [1, exact.pressure / exact.far]],
                    "loads[1].table": [[0, 1], [1, round(float(exact.stress(OUTER)[0]) / exact.far, 5)]]}
    return changes


def mesh(place):
    return {"mesh.regions[0].shape.high": [WIDE + place, WIDE + place]} if place else {}


def stress_errors(run, exact):
    """Root mean square over the mass within two plastic radii of the errors of radial and hoop stress, over the stress at infinity."""
    radius, radial, hoop, _, _, mass = case.ring(run)
    near = radius < 2 * exact.plastic
    return [np.sqrt(np.average((-found - of)[near]**2, weights=mass[near])) / exact.far
            for found, of in zip((radial, hoop), exact.stress(radius))]


def yielded(run, exact):
    """Radius [m] up to which the mass of the particles with plastic strain would reach."""
    _, _, _, _, strain, mass = case.ring(run)
    share = mass[strain > 1e-9].sum() / mass.sum()
    return np.sqrt(exact.radius**2 + share * (OUTER**2 - exact.radius**2))


def moved(run, exact, size):
    """Mean over the particles within a cell of the wall of the displacement over the exact one."""
    radius, _, _, outward, _, mass = case.ring(run)
    wall = radius < exact.radius + size
    return np.average((outward / exact.outward(radius))[wall], weights=mass[wall])


def judge(group, size, end, flow):
    data, exact = group.data, exact_of(group.data, end, flow)
    asked = ("at most", data["largest stress error"], 0.0)
    return [*group.result("error of the radial stress near the hole, rms", "-", lambda run: stress_errors(run, exact)[0], *asked),
            *group.result("error of the hoop stress near the hole, rms", "-", lambda run: stress_errors(run, exact)[1], *asked),
            *group.result("plastic radius", "m", lambda run: yielded(run, exact), "near", size / 2, exact.plastic),
            *group.result("displacement of the wall over the exact one", "-", lambda run: moved(run, exact, size), "within",
                          data["displacement within"], 1.0)]


def plan(level):
    """As plan_of() of the case."""
    data = tools.reference("equilibrium")["hole"]
    keys = [(size, "unloaded", flow) for size in SIZES[level] for flow in FLOWS]
    if level == "full":
        keys += [(0.125, "expanded", flow) for flow in FLOWS]
    return {("hole", *key): (judge, settings(data, *key)) for key in keys}
