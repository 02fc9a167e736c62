#!/usr/bin/python3
"""What the number of threads costs or gains: runs scenes with one thread, with two, and with the number that the program takes by itself, in turn.

Usage: benchmarks/threads.py [--program build/talus] [--repeats 7] [--threads 1,2] [--idle SECONDS] [--out runs/threads] [--spin]

Prints for each scene the median time of the steps (without mesh, set-up and files), and that of the program's own choice over the best of the others.
Beside them: the cores that other work had meanwhile, of Linux's own count (/proc/stat).  With --idle, a turn begins only where nothing else
has run for half a second, and is thrown away where other work had more than a tenth of a core in any of its runs; SECONDS is how long to go on trying.
With --spin, waiting threads spin as OpenMP's library lets them (GOMP_SPINCOUNT 300000), as well as sleep.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]

SCENES = {  # name: (file, words)
    "slope_failure_2d, quick": ("scenes/slope_failure_2d/scene.yaml", ["--quick"]),
    "landslide, 2 s of it": ("scenes/landslide/scene.yaml", ["--set", "time.end=2"]),
    "slope_failure_3d, quick": ("scenes/slope_failure_3d/scene.yaml", ["--quick"]),
}
ALLOWED = 0.1  # cores of other work
WAITED = 0.5  # s


def busy_seconds():
    """Processor time of all processes on this machine, including the time taken by its host (steal)."""
    numbers = pathlib.Path("/proc/stat").read_text(encoding="ascii").split("\n", 1)[0].split()[1:9]
    user, nice, system, _idle, _io, irq, softirq, steal = map(int, numbers)
    return (user + nice + system + irq + softirq + steal) / os.sysconf("SC_CLK_TCK")


def own_seconds():
    used = os.times()
    return used.user + used.system + used.children_user + used.children_system


class Watch:
    """The number of cores used by other processes since its construction."""

    def __init__(self):
        self._at, self._busy, self._own = time.monotonic(), busy_seconds(), own_seconds()

    def others(self):
        return max(0.0, (busy_seconds() - self._busy) - (own_seconds() - self._own)) / (time.monotonic() - self._at)


def is_idle():
    watch = Watch()
    time.sleep(WAITED)
    return watch.others() <= ALLOWED


def run(given, scene, threads, spin):
    """(seconds of the steps, threads, particles, steps, cores of others)."""
    file, words = SCENES[scene]
    environment = {name: value for name, value in os.environ.items() if name not in ("OMP_NUM_THREADS", "OMP_WAIT_POLICY", "GOMP_SPINCOUNT")}
    if spin:
        environment["GOMP_SPINCOUNT"] = "300000"
    line = [given.program, "run", ROOT / file, "--out", given.out / "run", "--quiet", *words]
    if threads:
        line += ["--threads", str(threads)]
    watch = Watch()
    done = subprocess.run([str(word) for word in line], env=environment, capture_output=True, text=True, check=False)
    others = watch.others()
    if done.returncode:
        sys.exit(f"{line} ended with {done.returncode}:\n{done.stderr}")
    summary = json.loads((given.out / "run" / "summary.json").read_text(encoding="utf-8"))
    cost, phases = summary["cost"], summary["cost"]["wall_by_phase"]
    before = sum(phases[name] for name in ("mesh", "seeding", "kernel", "build", "first_files"))
    seconds = cost["wall [s]"] - before - phases["output"] - phases["checkpoints"]
    return seconds, cost["threads"], sum(body["particles"] for body in summary["bodies"]), summary["steps"], others


def turn(given, scene):
    """One run of each kind; nothing if other work interfered."""
    made = {}
    for spin in [False, True] if given.spin else [False]:
        for threads in [*given.threads, None]:
            made[threads, spin] = run(given, scene, threads, spin)
            if given.idle and made[threads, spin][-1] > ALLOWED:
                return None
    return made


def measure(given):
    """All turns of all scenes, in alternation."""
    turns, until = {scene: [] for scene in SCENES}, time.monotonic() + (given.idle or 0)
    while missing := [scene for scene, made in turns.items() if len(made) < given.repeats]:
        for scene in missing:
            while given.idle and not is_idle():
                if time.monotonic() > until:
                    return turns
            made = turn(given, scene)
            if made:
                turns[scene].append(made)
                print(f"{scene}: {', '.join(f'{one[0]:.3f}' for one in made.values())} s, others {max(one[-1] for one in made.values()):.2f}", file=sys.stderr)
    return turns


def row(scene, turns):
    """A row of the table."""
    first = turns[0]
    medians = {key: statistics.median(made[key][0] for made in turns) for key in first}
    own = medians[None, False]
    best = min(value for (threads, spin), value in medians.items() if threads and not spin)
    others = statistics.mean(one[-1] for made in turns for one in made.values())
    _, threads, particles, steps, _ = first[None, False]
    times = " | ".join(f"{value:.3f} s" for value in medians.values())
    return f"| {scene} | {particles} | {steps} | {times} | {threads} | {own / best:.2f} | {len(turns)} | {others:.2f} |"


def main():
    words = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words.add_argument("--program", type=pathlib.Path, default=ROOT / "build" / "talus")
    words.add_argument("--repeats", type=int, default=7)
    words.add_argument("--threads", type=lambda text: [int(number) for number in text.split(",")], default=[1, 2])
    words.add_argument("--idle", type=float)
    words.add_argument("--out", type=pathlib.Path, default=ROOT / "runs" / "threads")
    words.add_argument("--spin", action="store_true")
    given = words.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    kinds = [f"{('one thread' if threads == 1 else f'{threads} threads') if threads else 'by itself'}{', spin' if spin else ''}"
             for spin in ([False, True] if given.spin else [False]) for threads in [*given.threads, None]]
    print(f"| scene | particles | steps | {' | '.join(kinds)} | takes | over the best | turns | cores of others |")
    print("|---" * (len(kinds) + 7) + "|")
    for scene, turns in measure(given).items():
        print(row(scene, turns) if turns else f"| {scene} | the machine was never idle |")


if __name__ == "__main__":
    main()
