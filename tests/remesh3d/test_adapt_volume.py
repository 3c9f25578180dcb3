"""adapt, adapt_loop and the command line on 3D meshes."""

import json

import numpy as np

from anistar import (
    AdaptOptions,
    LoopOptions,
    MetricOptions,
    adapt,
    adapt_loop,
    read,
    validate,
    write,
)
from anistar.cli.main import main
from anistar.demo.volume import front, run_volume_demo, unit_cube


def test_adapt_makes_the_front_sharper():
    mesh = unit_cube(5)
    options = AdaptOptions(metric=MetricOptions(target_complexity=500))
    errors = []
    for _ in range(3):
        done = adapt(mesh, {"u": front(mesh.points)}, options)
        mesh = done.mesh
        errors.append(float(np.abs(done.fields["u"] - front(mesh.points)).mean()))
        assert validate(mesh, reference=unit_cube(5)) == []
    assert errors[-1] < 0.5 * errors[0]
    assert json.dumps(done.report.as_dict())


def test_a_loop_ends_with_the_complexity_it_was_given():
    loop = adapt_loop(
        lambda mesh, fields: {"u": front(mesh.points)},
        unit_cube(4),
        LoopOptions(complexities=(200, 400)),
    )
    assert loop.stop_reason == "complexities done"
    assert 400 < loop.steps[-1].mesh.n_points < 1200


def test_the_command_line_adapts_a_volume(tmp_path):
    mesh = unit_cube(4)
    write(tmp_path / "in.vtu", mesh, {"u": front(mesh.points)})
    arguments = ["adapt", str(tmp_path / "in.vtu"), "--field", "u", "--target-complexity", "300"]
    assert main([*arguments, "-o", str(tmp_path / "out.vtu")]) == 0
    new, fields = read(tmp_path / "out.vtu")
    assert new.dim == 3
    assert validate(new) == []
    assert set(fields) >= {"u"}


def test_the_demo_in_3d_gains_over_uniform_meshes(tmp_path):
    demo = run_volume_demo(tmp_path, complexities=(200.0, 400.0))
    assert all(row.gain > 1 for row in demo.rows)
    assert all(path.exists() for path in demo.files)
    pictures = {path.name: path.stat().st_size for path in demo.files if path.suffix == ".png"}
    assert pictures.keys() == {"overview.png", "mesh_first.png", "mesh_last.png", "convergence.png"}
    assert min(pictures.values()) > 10_000
    assert json.loads((tmp_path / "report.json").read_text())["rows"]
