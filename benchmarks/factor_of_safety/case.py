"""Factors of safety found by `talus fos`, beside those of the literature: two slopes, and an infinite one that is solved in closed form."""
import numpy as np

import lab as tools

CASE = "factor_of_safety"


def searches(lab, data, full):
    """{name: (search, its slope)} of all slopes of the reference data, those of the full level as well if asked to."""
    started = {}
    for slope in data["slopes"]:
        for variant in slope["variants"]:
            if full or not variant.get("full", False):
                name = f"{slope['name']}, {variant['name']}"
                settings = {**variant.get("settings", {}), "materials[0]": {**slope["constants"], **variant["soil"]}}
                search = lab.fos(f"{CASE}/{slope['scene']}", tools.label(name), settings, **slope["options"], **variant.get("options", {}))
                started[name] = search, {**slope, **variant}
    return started


def tangent(soil, phi):
    """Shear over normal stress on the plane of steady simple shear in plane strain, without dilation: of a cone its slope, of planes sin(phi)."""
    sine = np.sin(phi)
    return {"outer": 2 * np.sqrt(3) * sine / (3 - sine), "inner": 2 * np.sqrt(3) * sine / (3 + sine)}.get(soil.get("match"), sine)


def closed_form(slope):
    """F of an infinite slope without cohesion: at which tangent(atan(tan(phi) / F)) is that of the slope."""
    phi, wanted = np.radians(slope["constants"]["friction_angle"]), np.tan(np.radians(slope["angle [deg]"]))
    low, high = 0.1, 10.0
    while high - low > 1e-12:
        middle = (low + high) / 2
        low, high = (middle, high) if tangent(slope["soil"], np.arctan(np.tan(phi) / middle)) > wanted else (low, middle)
    return (low + high) / 2


def trials_of(search, key):
    """Factors and a measure of the trials that ran to their end."""
    ended = [trial for trial in search.found["trials"] if trial[key] is not None]
    return [trial["factor"] for trial in ended], [trial[key] for trial in ended]


def second_measure(trial):
    """Its name in words and in fos.json: steadiness of static trials, else what is left of the kinetic energy."""
    return ("steadiness", "steadiness") if trial["steadiness"] is not None else ("kinetic energy at the end over its peak", "kinetic_over_peak")


def draw(figure, started):
    """Displacement over factor of all searches, each beside its reference."""
    names = list(dict.fromkeys(slope["scene"] for _, slope in started.values()))
    for axes, scene in zip(np.atleast_1d(figure.subplots(1, len(names))), names):
        here = {name: entry for name, entry in started.items() if entry[1]["scene"] == scene}
        for mark, (name, (search, slope)) in zip("o+x^sdv<>", here.items()):
            axes.plot(*trials_of(search, "moved [m]"), f"{mark}-", fillstyle="none", label=name.split(", ", 1)[1])
        if "factor of safety" in slope:
            axes.axvspan(slope["factor of safety"] - slope["tolerance"], slope["factor of safety"] + slope["tolerance"], color="k", alpha=0.1, lw=0)
        axes.set(xlabel="factor F", ylabel="displacement [m]", yscale="log", title=name.split(", ", 1)[0])
        axes.legend(fontsize=6, loc="upper center", bbox_to_anchor=(0.5, -0.16))


def evaluate(lab):
    """Every search: its factor beside the reference, and both measures in the trials on either side of it."""
    data = tools.reference(CASE)
    started = searches(lab, data, lab.level == "full")
    results = []
    for name, (search, slope) in started.items():
        reference = slope["factor of safety"] if "factor of safety" in slope else closed_form(slope)
        found = search.found
        for key, word in (("highest_that_holds", "holds"), ("lowest_that_fails", "fails")):
            run = search.trial(found[key])
            trial = next(trial for trial in found["trials"] if trial["factor"] == found[key])
            if word == "holds":
                judged = slope.get("judged", True)
                results.append(tools.Result(CASE, f"factor of safety, {name}", "-", found["factor_of_safety"], slope["criterion"] if judged else "reported",
                                            slope["tolerance"] if judged else None, reference, slope["source"], run))
            results += [tools.Result(CASE, f"{text}, F that {word}, {name}", "-", trial[measure] if trial[measure] is not None else float("nan"), "reported",
                                     None, None, "", run)
                        for text, measure in (("growth", "growth"), second_measure(trial))]
    lab.figure(CASE, "verification_factor_of_safety", lambda figure: draw(figure, started), size=(8.4, 3.6),
               caption="Displacement over the factor by which the strength is divided (grey: reference and tolerance).")
    return results
