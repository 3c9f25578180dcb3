"""A mesh that has no room in memory is refused before anything is made."""

import math
import re

import numpy as np
import pytest
from meshes import cube, square
from remesh3d import domains
from shapes import angles, fan, on_circle, uniform

from anistar.base import memory
from anistar.base.errors import MeshingError
from anistar.meshes.validation import validate
from anistar.remeshing import demand
from anistar.remeshing.remesh import RemeshOptions, remesh


@pytest.fixture
def machine(tmp_path, monkeypatch):
    """Write what a machine tells about itself below a folder; returns a function for that."""
    monkeypatch.setattr(memory, "PROC", tmp_path / "proc")
    monkeypatch.setattr(memory, "GROUPS", tmp_path / "groups")
    monkeypatch.setattr(memory, "HAS_LIMITS", False)

    def write(files):
        for name, text in files.items():
            path = tmp_path / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)

    write({"proc/meminfo": "MemTotal: 9000000 kB\nMemAvailable:    4000000 kB\n"})
    return write


def test_this_machine_has_some_memory_left():
    assert 1e6 < memory.available_memory() < 1e15


def test_the_machine_tells_what_is_available(machine):
    assert memory.available_memory() == 4000000 * 1024


def test_a_machine_that_tells_nothing_has_no_bound(machine, monkeypatch):
    machine({"proc/meminfo": ""})
    monkeypatch.delattr(memory.os, "sysconf")
    assert memory.available_memory() == math.inf


def test_without_proc_the_whole_memory_is_taken(machine):
    machine({"proc/meminfo": ""})
    assert 1e8 < memory.available_memory() < math.inf


def test_a_container_bounds_what_is_available_and_its_cached_files_do_not_count(machine):
    machine({"proc/self/cgroup": "0::/job\n", "groups/job/memory.max": "2000000000\n"})
    machine({"groups/job/memory.current": "700000000\n"})
    assert memory.available_memory() == 1_300_000_000
    machine({"groups/job/memory.stat": "anon 5\ninactive_file 200000000\n"})
    assert memory.available_memory() == 1_500_000_000


def test_an_outer_group_bounds_an_inner_one_without_a_limit(machine):
    machine({"proc/self/cgroup": "0::/user/job\n", "groups/user/job/memory.max": "max\n"})
    assert memory.available_memory() == 4000000 * 1024
    machine({"groups/user/memory.max": "1000000000\n", "groups/user/memory.current": "1\n"})
    assert memory.available_memory() == 999_999_999


def test_groups_of_the_first_version_are_read_too(machine):
    machine({"proc/self/cgroup": "12:memory:/docker/1\n11:cpu:/other\n"})
    machine({"groups/memory/memory.limit_in_bytes": "500000000"})
    machine({"groups/memory/memory.usage_in_bytes": "100000000"})
    machine({"groups/memory/memory.stat": "total_inactive_file 50000000\n"})
    assert memory.available_memory() == 450_000_000


def test_a_limit_of_address_space_bounds_what_is_available(machine, monkeypatch):
    resource = pytest.importorskip("resource")
    monkeypatch.setattr(memory, "HAS_LIMITS", True)
    monkeypatch.setattr(resource, "getrlimit", lambda kind: (10**9, -1))
    machine({"proc/self/statm": "1000 900 800\n"})
    assert memory.available_memory() == 10**9 - 1000 * resource.getpagesize()


@pytest.mark.parametrize(("mesh", "h"), [(square(2), 1e-4), (cube(2), 1e-2)])
def test_a_metric_whose_mesh_has_no_room_is_refused_with_estimate_limit_and_option(
    mesh, h, monkeypatch
):
    monkeypatch.setattr(demand, "available_memory", lambda: 1e9)
    M = uniform(mesh, h) if mesh.dim == 2 else domains.uniform(mesh, h)
    message = (
        r"the metric asks for about 1\.[29]e\+0[86] vertices, which take [0-9.]+ GB of memory, "
        r"more than what is free here, 1 GB; set h_min .* max_vertices, .* by max_memory \(bytes\)"
    )
    with pytest.raises(MeshingError, match=message):
        remesh(mesh, M)


def test_max_memory_takes_the_place_of_what_is_free(monkeypatch):
    mesh = square(4)
    with pytest.raises(
        MeshingError, match=r"which take 5.08 MB of memory, more than max_memory, 100 kB;"
    ):
        remesh(mesh, uniform(mesh, 0.01), RemeshOptions(max_memory=1e5))
    monkeypatch.setattr(demand, "available_memory", lambda: 1.0)
    for most in (1e9, math.inf):
        done = remesh(mesh, uniform(mesh, 0.1), RemeshOptions(max_memory=most))
        assert validate(done.mesh, mesh) == []


@pytest.mark.parametrize("budget", [{"max_vertices": 100}, {"max_seconds": 1e-6}])
def test_a_budget_that_keeps_the_mesh_small_enough_is_no_reason_to_refuse(budget, monkeypatch):
    monkeypatch.setattr(demand, "available_memory", lambda: 1e6)
    mesh = square(4)
    done = remesh(mesh, uniform(mesh, 1e-5), RemeshOptions(**budget))
    assert validate(done.mesh, mesh) == []
    assert not done.report.converged


def test_long_facets_of_a_thin_domain_count_where_the_complexity_is_small():
    mesh = fan(on_circle(angles(24)) * [1.0, 1e-6])
    M = np.tile(np.diag([1e10, 1e-3]), (mesh.n_points, 1, 1))
    with pytest.raises(MeshingError, match=r"the metric asks for about 4.*e\+05 vertices"):
        remesh(mesh, M, RemeshOptions(max_memory=1e7))


def test_a_large_determinant_in_one_corner_is_no_large_mesh():
    mesh = square(4)
    M = uniform(mesh, 0.2)
    M[12] = np.eye(2) * 1e6
    done = remesh(mesh, M, RemeshOptions(max_memory=1e8))
    assert validate(done.mesh, mesh) == []


@pytest.mark.parametrize("value", [0, -1.0, math.nan])
def test_a_max_memory_that_is_no_number_of_bytes_is_refused(value):
    with pytest.raises(ValueError, match=re.escape(f"max_memory must be positive, got {value}")):
        RemeshOptions(max_memory=value)


def test_one_fine_corner_does_not_count_for_the_whole_of_its_facets():
    # along the sides the sizes go from 1 to 1e-7 as their logarithms do: 1e7 / log(1e7) edges
    mesh = square(1)
    M = np.tile(np.eye(2), (4, 1, 1))
    M[0] = np.diag([1.0, 1e14])
    message = r"the metric asks for about 6\.2e\+05 vertices"
    with pytest.raises(MeshingError, match=message):
        remesh(mesh, M, RemeshOptions(max_memory=1e8, max_refinement=None))


def test_a_max_memory_in_letters_is_no_number():
    with pytest.raises(TypeError, match="max_memory must be a number of bytes, got '1e9'"):
        RemeshOptions(max_memory="1e9")
