"""The presets of `accuracy`: error and price of draft, standard and fine on three problems."""
import bar_mode
import lab as tools

CASE = "accuracy"
LEVELS = {"quick": ["draft", "standard"], "full": ["draft", "standard", "fine"]}


def lowest(history):
    """Deepest place of the tip of the cantilever [m]."""
    return float(history["tip_uy"].min())


def evaluate(lab):
    """Errors, without a verdict: they are what the documentation promises of each word, and the regression watches them."""
    bar, beam, bars = tools.reference("vibrating_bar"), tools.reference("cantilever"), tools.reference("column_collapse")
    column = tools.module("column_collapse")
    bars = {**bars, "surface": tools.reference("column_collapse", "surface.csv"), "failure": tools.reference("column_collapse", "failure.csv")}
    problems = {
        "bar, displacement over amplitude": ("scene", lambda run: bar_mode.displacement_error(run.history, bar, 0.1), bar["source"]),
        "cantilever, first minimum": ("cantilever", lambda run: abs(lowest(run.history) / beam["first minimum [m]"] - 1), beam["source"]),
        "column of bars, rms of the surface over its height": ("column", lambda run: column.measures(run, bars)["rms"] / 0.1, bars["surface source"])}
    started = {(what, word): lab.run(f"{CASE}/{scene}.yaml", f"{scene}_{word}", {"accuracy": word})
               for what, (scene, _, _) in problems.items() for word in LEVELS[lab.level]}
    return [tools.Result(CASE, f"error of the {what}, {word}", "-", problems[what][1](run), "reported", None, 0.0, problems[what][2], run)
            for (what, word), run in started.items()]
