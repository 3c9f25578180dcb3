"""Meshes as other programs write them: meshio in each of its encodings, and Gmsh in version 4."""

import struct

import meshio
import numpy as np

MESHIO = {
    "gmsh22 binary": (".msh", {"file_format": "gmsh22", "binary": True}),
    "vtk42": (".vtk", {"file_format": "vtk42", "binary": True}),
    "vtk42 text": (".vtk", {"file_format": "vtk42", "binary": False}),
    "vtk51": (".vtk", {"file_format": "vtk51", "binary": True}),
    "vtk51 text": (".vtk", {"file_format": "vtk51", "binary": False}),
    "vtu text": (".vtu", {"binary": False}),
    "vtu": (".vtu", {"compression": None}),
    "vtu zlib": (".vtu", {"compression": "zlib"}),
    "vtu lzma": (".vtu", {"compression": "lzma"}),
    "vtu 64": (".vtu", {"header_type": "UInt64"}),
    "xdmf": (".xdmf", {"data_format": "XML"}),
}
"""Suffix and options of each."""

GMSH = {"4.1": False, "4.0": False, "4.1 binary": True, "4.0 binary": True}
_GMSH_TYPE = {1: 15, 2: 1, 3: 2, 4: 4}


def sample(mesh):
    """Arrays at points and cells that a file of `mesh` may carry."""
    u = np.sin(7 * mesh.points[:, 0])
    return {"u": u, "v": mesh.points + 0.5}, {"k": np.arange(mesh.n_cells) / 3}


def meshio_content(mesh):
    """A mesh in meshio's form with facets, tags and the arrays of `sample`."""
    lower, cells = ("line", "triangle") if mesh.dim == 2 else ("triangle", "tetra")
    points = np.pad(mesh.points, ((0, 0), (0, 3 - mesh.dim)))
    on_points, on_cells = sample(mesh)
    tags = [mesh.cell_tags.astype(np.int32), mesh.facet_tags.astype(np.int32)]
    v = np.pad(on_points["v"], ((0, 0), (0, 3 - mesh.dim)))
    return meshio.Mesh(
        points,
        [(cells, mesh.cells), (lower, mesh.facets)],
        point_data={"u": on_points["u"], "v": v},
        cell_data={
            "gmsh:physical": tags,
            "gmsh:geometrical": tags,
            "k": [on_cells["k"], np.zeros(len(mesh.facets))],
        },
    )


def write_with_meshio(path, mesh, kind):
    """Write `mesh` as one of `MESHIO`; the path has its suffix."""
    meshio_content(mesh).write(path, **MESHIO[kind][1])


def gmsh_4(mesh, kind):
    """The bytes of a Gmsh file of one of `GMSH`, each tag on an entity of its own."""
    version, is_binary = kind[:3], GMSH[kind]
    words = _Words(is_binary)
    groups = [
        (dim, int(tag), rows[tags == tag], _GMSH_TYPE[rows.shape[1]])
        for dim, rows, tags in (
            (mesh.dim - 1, mesh.facets, mesh.facet_tags),
            (mesh.dim, mesh.cells, mesh.cell_tags),
        )
        for tag in np.unique(tags)
    ]
    one = struct.pack("<i", 1) + b"\n" if is_binary else b""
    head = f"$MeshFormat\n{version} {int(is_binary)} 8\n".encode() + one + b"$EndMeshFormat\n"
    names = "".join(f'{dim} {tag} "{name}"\n' for (dim, tag), name in sorted(mesh.names.items()))
    head += f"$PhysicalNames\n{len(mesh.names)}\n{names}$EndPhysicalNames\n".encode()
    parts = (_entities(words, groups), _nodes(words, mesh, version))
    return b"".join([head, *parts, _elements(words, groups, version), *_data(words, mesh)])


class _Words:
    """Numbers as text or bytes."""

    def __init__(self, is_binary):
        self.is_binary = is_binary

    def of(self, code, *values):
        if self.is_binary:
            return struct.pack(f"<{len(values)}{code}", *values)
        return (" ".join(f"{value:.17g}" for value in values) + "\n").encode()

    def section(self, name, body):
        return f"${name}\n".encode() + body + f"\n$End{name}\n".encode()


def _entities(words, groups):
    body = words.of("Q", *(sum(group[0] == dim for group in groups) for dim in range(4)))
    for dim, tag, _, _ in groups:
        body += words.of("i", tag + 100) + words.of("d", *[0.0] * 6)
        body += words.of("Q", int(tag != 0)) + (words.of("i", tag) if tag else b"")
        body += words.of("Q", 0) if dim else b""
    return words.section("Entities", body)


def _nodes(words, mesh, version):
    numbers = range(1, mesh.n_points + 1)
    points = np.pad(mesh.points, ((0, 0), (0, 3 - mesh.dim))).tolist()
    if version == "4.1":
        body = words.of("Q", 1, mesh.n_points, 1, mesh.n_points)
        body += words.of("i", mesh.dim, 101, 0) + words.of("Q", mesh.n_points)
        body += words.of("Q", *numbers) + b"".join(words.of("d", *point) for point in points)
    else:
        body = words.of("Q", 1, mesh.n_points)
        body += words.of("i", 101, mesh.dim, 0) + words.of("Q", mesh.n_points)
        for number, point in zip(numbers, points, strict=True):
            body += words.of("i", number) + words.of("d", *point)
    return words.section("Nodes", body)


def _elements(words, groups, version):
    total = sum(len(rows) for _, _, rows, _ in groups)
    bounds = (1, total) if version == "4.1" else ()
    body, number = words.of("Q", len(groups), total, *bounds), 1
    for dim, tag, rows, kind in groups:
        place = (dim, tag + 100) if version == "4.1" else (tag + 100, dim)
        body += words.of("i", *place, kind) + words.of("Q", len(rows))
        for row in rows.tolist():
            nodes = [node + 1 for node in row]
            body += words.of("Q" if version == "4.1" else "i", number, *nodes)
            number += 1
    return words.section("Elements", body)


def _data(words, mesh):
    on_points, on_cells = sample(mesh)
    # the elements of the cells come last
    first = len(mesh.facets) + 1
    order = np.argsort(mesh.cell_tags, kind="stable")
    arrays = (
        ("NodeData", "u", 1, on_points["u"][:, None]),
        ("NodeData", "v", 1, np.pad(on_points["v"], ((0, 0), (0, 3 - mesh.dim)))),
        ("ElementData", "k", first, on_cells["k"][order][:, None]),
    )
    for name, label, start, values in arrays:
        head = f'1\n"{label}"\n1\n0\n3\n0\n{values.shape[1]}\n{len(values)}\n'.encode()
        rows = b"".join(
            words.of("i", start + i) + words.of("d", *row) for i, row in enumerate(values.tolist())
        )
        yield words.section(name, head + rows)
