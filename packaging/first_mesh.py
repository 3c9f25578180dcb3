"""What a new user does first, with nothing but what anistar requires: write, adapt, judge."""

import importlib.metadata
import subprocess
import sys
from pathlib import Path

import numpy as np

import anistar

REQUIRED = {
    "anistar", "markdown-it-py", "mdurl", "meshio", "numpy", "pip", "pygments", "rich", "scipy",
    "setuptools",
}  # fmt: skip


def square(n: int) -> anistar.Mesh:
    """Return the unit square of 2 n**2 triangles."""
    ticks = np.linspace(0.0, 1.0, n + 1)
    points = np.stack(np.meshgrid(ticks, ticks, indexing="ij"), axis=-1).reshape(-1, 2)
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    lower = np.stack([corner, corner + n + 1, corner + n + 2], axis=1)
    upper = np.stack([corner, corner + n + 2, corner + 1], axis=1)
    return anistar.Mesh(points=points, cells=np.concatenate([lower, upper]))


def main() -> None:
    """Adapt to a front, by Python and by command, and look at what is installed."""
    installed = {found.name.lower() for found in importlib.metadata.distributions()}
    if more := installed - REQUIRED:
        raise SystemExit(f"installed beside what anistar requires: {', '.join(sorted(more))}")
    mesh = square(20)
    u = np.tanh(30 * (np.hypot(*mesh.points.T) - 0.7))
    options = anistar.AdaptOptions.from_dict({"target_complexity": 500})
    done = anistar.adapt(mesh, {"u": u}, options)
    if problems := anistar.validate(done.mesh):
        raise SystemExit(problems[0].message)
    anistar.write("in.vtu", mesh, {"u": u})
    command = str(Path(sys.executable).with_name("anistar"))
    words = ["adapt", "in.vtu", "--field", "u", "--target-complexity", "500", "-o", "out.vtu"]
    subprocess.run([command, *words], check=True, stdout=subprocess.DEVNULL)
    again, _ = anistar.read("out.vtu")
    if not np.array_equal(again.points, done.mesh.points):
        raise SystemExit("the command and the function make different meshes")
    print(f"anistar {anistar.__version__}: {done.mesh}")


if __name__ == "__main__":
    main()
