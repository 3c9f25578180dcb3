"""Files of geometry for tests."""

from solids import CORNERS, SIDES


def written(folder, name, content):
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def is_cube(plc):
    return (plc.n_points, plc.n_facets, len(plc.triangles), len(plc.segments)) == (8, 6, 12, 12)


POLY = """# a box with a hole in its lid, a rib and a point
12 3 0 0
{points}
# facets
7 1
1 0 11
4 1 4 3 2
3 1 12  # the lid
4 5 6 7 8
4 9 10 11
  12
2 9 5
1 0.5 0.5 1
{sides}
1 0 20
2 9 10
1
1 0.5 0.5 0.5
1
1 0.1 0.1 0.1 3 0.001
"""


def poly_text():
    lid = [[0.25, 0.25, 1], [0.75, 0.25, 1], [0.75, 0.75, 1], [0.25, 0.75, 1]]
    rows = [f"{k} {x} {y} {z}" for k, (x, y, z) in enumerate([*CORNERS, *lid], start=1)]
    sides = ["1 0 13\n4 " + " ".join(str(v + 1) for v in side) for side in SIDES[2:]]
    text = POLY.format(points="\n".join(rows), sides="\n".join(sides))
    return text.replace("7 1\n1 0 11", "6 1\n1 0 11").replace("1 0 20\n2 9 10\n", "")
