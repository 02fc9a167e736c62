"""Perfect plasticity of von Mises with radial return: the law von_mises of Talus, in Python."""
import numpy as np

TWICE = np.array([1, 1, 1, 2, 2, 2])   # shear components are in a symmetric tensor twice


class metal:
    """Linear elastic, perfectly plastic: von Mises with radial return."""

    parameters = {"youngs_modulus": "Pa", "poisson_ratio": ("-", 0.3, -0.99, 0.4999), "yield_stress": ("Pa", None, 0)}
    variables = {"plastic_strain": "-", "plastic_work": "J/m^3"}

    def begin(self, parameters, density):
        E, nu = parameters.youngs_modulus, parameters.poisson_ratio
        return E / (3 * (1 - 2 * nu)), E / (2 * (1 + nu))

    def update(self, block):
        bulk, shear = self.begin(block.parameters, block.density)
        strain, stress = block.strain, block.stress
        volume = strain[:, :3].sum(axis=1, keepdims=True)
        mean = stress[:, :3].mean(axis=1, keepdims=True)
        deviator = stress + 2 * shear * strain
        deviator[:, :3] -= mean + 2 / 3 * shear * volume
        q = np.sqrt(1.5 * (deviator**2 @ TWICE))
        if not block.elastic:
            strength = block.parameters.yield_stress
            flow = np.maximum(q - strength, 0) / (3 * shear)
            deviator *= np.minimum(1, strength / np.maximum(q, 1e-300))[:, None]
            block.history["plastic_strain"] += flow
            block.history["plastic_work"] += strength * flow * np.linalg.det(block.F)
        stress[:] = deviator
        stress[:, :3] += mean + bulk * volume

    def weaken(self, parameters, factor):
        parameters.yield_stress /= factor
