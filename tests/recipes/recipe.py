"""What a recipe is: the change that CONTRIBUTING.md tells for an extension, made in a copy of the tree, and what must work then."""
import dataclasses
import subprocess
from collections.abc import Callable
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]


class Tree:
    """A copy of the tree; files that are as they were keep their times, so that little is compiled again."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.touched: dict[str, list[str]] = {}  # by recipe, in order
        self._recipe = ""
        self._texts: dict[str, str] = {}  # of touched files

    def begin(self, recipe: str) -> None:
        self._recipe = recipe
        self.touched[recipe] = []

    def write(self, path: str, text: str) -> None:
        if path not in self.touched[self._recipe]:
            self.touched[self._recipe].append(path)
        self._texts[path] = text

    def read(self, path: str) -> str:
        return self._texts.get(path) or (SOURCE / path).read_text(encoding="utf-8")

    def insert_behind(self, mark: str, path: str, text: str) -> None:
        """Puts a text behind the first place where `mark` stands."""
        old = self.read(path)
        assert mark in old, f"{path}: the recipe of {self._recipe} looks for {mark!r}"
        self.write(path, old.replace(mark, mark + text, 1))

    def save(self) -> None:
        listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=SOURCE, capture_output=True, text=True, check=True).stdout
        names = set(listed.splitlines()) | set(self._texts)
        for name in sorted(names):
            if name not in self._texts and not (SOURCE / name).is_file():
                continue
            wanted = self._texts[name].encode() if name in self._texts else (SOURCE / name).read_bytes()
            file = self.root / name
            if not file.is_file() or file.read_bytes() != wanted:
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_bytes(wanted)
                file.chmod((SOURCE / name).stat().st_mode if (SOURCE / name).is_file() else 0o644)
        for file in [f for f in self.root.rglob("*") if f.is_file()]:
            if file.relative_to(self.root).as_posix() not in names:
                file.unlink()


@dataclasses.dataclass
class Built:
    """The programs that were made of the tree, and a folder for what they write."""

    build: Path
    folder: Path

    def run(self, *words: object, program: str = "talus", code: int = 0) -> str:
        """Standard output and error of a program that ends with `code`."""
        done = subprocess.run([str(self.build / program), *map(str, words)], cwd=self.folder, capture_output=True, text=True, check=False)
        assert done.returncode == code, f"{program} {' '.join(map(str, words))} ended with {done.returncode}:\n{done.stdout}{done.stderr}"
        return done.stdout + done.stderr

    def write(self, name: str, text: str) -> None:
        (self.folder / name).write_text(text, encoding="utf-8")


@dataclasses.dataclass
class Recipe:
    """`most_files`: sources that may be touched, new ones included; tests and documents come on top."""

    apply: Callable[[Tree], None]
    works: Callable[[Built], None]
    most_files: int
    test_targets: tuple[str, ...] = ()


BLOCK = """title: Block that falls
dimension: 2
mesh: {grid: {low: [0, 0], high: [2, 2], cells: [4, 4]}}
time: {end: 0.02}
materials: [{name: rubber, law: neo_hookean, density: 1000, youngs_modulus: 1.0e5, poisson_ratio: 0.3}]
bodies: [{name: block, material: rubber, shape: {type: box, low: [0.5, 1], high: [1.5, 2]}, particles_per_cell: 4, velocity: ["1", "0.5 * x"]}]
loads: [{type: gravity, acceleration: [0, -9.81]}]
boundaries: [{type: fixed, on: y_min}]
outputs:
"""
