import json
import os
from dataclasses import dataclass
from pathlib import Path

import meshio
import numpy as np
import pytest
from meshes import cube, square

from anistar.base.errors import FormatError
from anistar.base.report import as_builtin, to_json, write_json
from anistar.cli.expression import function_of_position
from anistar.runs.series import write_series

pytest.importorskip("matplotlib")

from anistar import pictures
from anistar.pictures.plane import ellipses


@dataclass(frozen=True)
class Pair:
    first: float
    second: np.ndarray


class TestReports:
    def test_numpy_values_become_builtins(self):
        value = {"a": np.float32(0.5), "b": np.arange(2), "c": (np.int64(3), np.bool_(True))}
        assert as_builtin(value) == {"a": 0.5, "b": [0, 1], "c": [3, True]}
        assert json.loads(to_json(value)) == as_builtin(value)

    def test_what_json_does_not_have_becomes_null(self):
        assert as_builtin([np.nan, np.inf, -np.inf, 1.0]) == [None, None, None, 1.0]

    def test_dataclasses_become_their_fields(self):
        assert as_builtin(Pair(1.0, np.zeros(2))) == {"first": 1.0, "second": [0.0, 0.0]}

    def test_paths_become_text(self):
        assert as_builtin(Path("a") / "b") == os.path.join("a", "b")  # noqa: PTH118

    def test_anything_else_is_refused(self):
        with pytest.raises(TypeError, match="a report cannot hold a complex"):
            as_builtin({"z": 1j})

    def test_a_report_that_cannot_be_written_leaves_the_old_one(self, tmp_path):
        path = tmp_path / "report.json"
        path.write_text("old")
        with pytest.raises(TypeError, match="cannot hold"):
            write_json(path, {"z": 1j})
        assert path.read_text() == "old"
        assert list(tmp_path.iterdir()) == [path]

    def test_a_folder_that_does_not_exist_is_named(self, tmp_path):
        with pytest.raises(FormatError, match=r"cannot write .*gone/report\.json: No such file"):
            write_json(tmp_path / "gone" / "report.json", {})


class TestSeries:
    def test_a_series_lists_its_members_in_order(self, tmp_path):
        meshes = [square(n) for n in (1, 2, 3)]
        items = [(mesh, {"x": mesh.points[:, 0]}) for mesh in meshes]
        written = write_series(tmp_path / "s.pvd", items)
        assert [path.name for path in written] == ["s_000.vtu", "s_001.vtu", "s_002.vtu", "s.pvd"]
        text = (tmp_path / "s.pvd").read_text()
        assert text.index("s_000.vtu") < text.index("s_001.vtu") < text.index("s_002.vtu")
        assert len(meshio.read(tmp_path / "s_002.vtu").points) == 16

    def test_members_of_a_longer_series_are_removed(self, tmp_path):
        items = [(square(1), {})] * 3
        write_series(tmp_path / "s.pvd", items)
        (tmp_path / "s_other.vtu").write_text("mine")
        write_series(tmp_path / "s.pvd", items[:1])
        assert {path.name for path in tmp_path.iterdir()} == {"s_000.vtu", "s.pvd", "s_other.vtu"}

    def test_another_suffix_is_refused(self, tmp_path):
        with pytest.raises(ValueError, match=r"to a \.pvd file, not 's\.vtu'"):
            write_series(tmp_path / "s.vtu", [])


class TestPictures:
    def test_ellipses_are_half_a_unit_from_their_centres_in_the_metric(self):
        mesh = square(2)
        M = np.tile(np.array([[9.0, 2.0], [2.0, 4.0]]), (mesh.n_points, 1, 1))
        offsets = ellipses(mesh.points, M) - mesh.points[:, None]
        lengths = np.sqrt(np.einsum("nti,nij,ntj->nt", offsets, M, offsets))
        assert lengths == pytest.approx(0.5)

    def test_a_spatial_mesh_has_no_picture(self, tmp_path):
        with pytest.raises(ValueError, match="pictures are of 2D meshes, not 3D"):
            pictures.mesh_picture(tmp_path / "cube.png", cube(1))


class TestExpressions:
    @pytest.mark.parametrize(
        ("text", "expected"),
        [
            ("x + 2 * y", 2.5),
            ("tanh(20 * (x - 0.5)) ** 2", 0.0),
            ("-sqrt(abs(x - y)) / 2", -0.25 * np.sqrt(2)),
            ("maximum(x, y) * cos(pi)", -1.0),
            ("3", 3.0),
        ],
    )
    def test_arithmetic_is_evaluated_at_points(self, text, expected):
        points = np.array([[[0.5, 1.0]], [[0.5, 1.0]]])
        found = function_of_position(text)(points)
        assert found.shape == (2, 1)
        assert found == pytest.approx(expected)

    @pytest.mark.parametrize(
        ("text", "message"),
        [
            ("__import__('os')", r"is not allowed in an expression"),
            ("x.real", r"'x\.real' is not allowed"),
            ("u + 1", r"'u' is not allowed"),
            ("sin(x, out=y)", r"is not allowed"),
            ("[x]", r"'\[x\]' is not allowed"),
            ("x +", r"cannot understand 'x \+'"),
        ],
    )
    def test_anything_else_is_refused_by_name(self, text, message):
        with pytest.raises(ValueError, match=message):
            function_of_position(text)

    def test_a_pole_is_a_value_and_not_a_warning(self):
        values = function_of_position("1 / x")(np.array([[0.0, 0.0], [2.0, 0.0]]))
        assert values.tolist() == [np.inf, 0.5]
