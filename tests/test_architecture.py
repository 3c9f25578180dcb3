"""The folder list is the architecture, and imports point one way."""

import ast
import re
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "plugin" / "anistar"
CORE = ROOT / "plugin" / "core"

FOLDERS = {"docs", "metric", "packaging", "plugin", "requirements", "solver_examples", "tests"}
# A folder of the core includes itself and those before it; the bindings include all.
CORE_FOLDERS = [
    "base",
    "mesh",
    "search",
    "metric",
    "transfer",
    "certificate",
    "stars",
    "remesh",
    "plane",
    "surface",
    "volume",
    "generate",
]
# 2D and 3D know nothing of each other.
APART = [("plane", "surface"), ("plane", "volume")]
# The rooms of a mesher, a storey a line. Those of one storey do not include each other.
ROOMS_OF_A_MESHER = [{"geometry"}, {"mesh"}, {"passes", "pure", "stars"}]

MADE_BY_COMMANDS = {"anistar-demo", "anistar-demo-3d", "build", "dist"}

# The rooms of the package from the ground up, a line per storey: a room imports from itself and
# from the storeys before its own. `__init__` and `__main__` are above all.
PACKAGE_ROOMS = [
    {"metric"},
    {"base"},
    {"meshes"},
    {"objects"},
    {"formats"},
    {"judging", "transfer"},
    {"pictures", "remeshing"},
    {"generating", "views"},
    {"loops"},
    {"adapters", "runs"},
    {"demo"},
    {"cli"},
]
METRIC_ROOMS = [
    {"base"},
    {"kernels"},
    {"tensors"},
    {"laws", "recovery"},
    {"sources"},
    {"pipeline"},
]

# So many modules can be looked over at once.
MODULES_SIDE_BY_SIDE = 14
SUFFIXES = {".py", ".h", ".cpp"}

# The demo is an example that ships inside the package; it solves with scikit-fem.
DEMO_PROBLEM = "anistar.demo.problem"

# It finds out where dolfinx is before it looks for it.
DIAGNOSIS = "anistar.cli.diagnosis"

# ParaView loads this file by its path, as no part of a package.
PARAVIEW_PLUGIN = "anistar.adapters.vtk.paraview_plugin"


def module_name(path, folder, package):
    parts = path.relative_to(folder).with_suffix("").parts
    return ".".join([package, *(part for part in parts if part != "__init__")])


def sources():
    """Every module of the import package, by name; `metric/` is `anistar.metric`."""
    found = {
        module_name(path, ROOT / "metric", "anistar.metric"): path
        for path in modules(ROOT / "metric")
    }
    inside = (path for path in modules(PACKAGE) if path.relative_to(PACKAGE).parts[0] != "metric")
    return found | {module_name(path, PACKAGE, "anistar"): path for path in inside}


def modules(folder):
    return sorted(folder.rglob("*.py"))


def imports(name, path):
    """Absolute names of what a module imports, of functions and names as well as of modules."""
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    found = set()
    for node in ast.walk(ast.parse(path.read_text(), str(path))):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            found |= imported_from(node, package)
    return found


def imported_from(node, package):
    base = node.module or ""
    if node.level:
        above = package.split(".")[: len(package.split(".")) - node.level + 1]
        base = ".".join([*above, base] if base else above)
    return {f"{base}.{alias.name}" for alias in node.names}


def is_within(name, package):
    return name == package or name.startswith(package + ".")


ALL = {name: imports(name, path) for name, path in sources().items()}


def importers_of(package, among):
    return sorted(name for name in among if any(is_within(other, package) for other in ALL[name]))


def test_top_level_folders_are_the_fixed_ones():
    found = {path.name for path in ROOT.iterdir() if path.is_dir() and path.name[0] != "."}
    assert found - MADE_BY_COMMANDS - {"__pycache__", "shared"} <= FOLDERS


def test_plugin_holds_the_package_and_the_core_only():
    assert {path.name for path in (ROOT / "plugin").iterdir()} - {"__pycache__"} == {
        "anistar",
        "core",
    }


def test_the_metric_package_is_a_leaf_except_that_kernels_may_use_the_core():
    outside = {
        name: [
            other
            for other in ALL[name]
            if is_within(other, "anistar") and not is_within(other, "anistar.metric")
        ]
        for name in ALL
        if is_within(name, "anistar.metric")
    }
    allowed = outside.pop("anistar.metric.kernels.compiled")
    assert all(is_within(name, "anistar._core") for name in allowed)
    assert {name: other for name, other in outside.items() if other} == {}


def test_the_metric_package_needs_numpy_and_scipy_only():
    allowed = {"anistar", "numpy", "scipy", "__future__"}
    for name in ALL:
        if is_within(name, "anistar.metric"):
            roots = {other.partition(".")[0] for other in ALL[name]}
            third_party = {root for root in roots - allowed if not is_standard(root)}
            assert not third_party, f"{name} imports {third_party}"


def is_standard(root):
    import sys

    return root in sys.stdlib_module_names


def test_only_adapters_the_demo_problem_and_the_diagnosis_import_adapters():
    library = [name for name in ALL if not is_within(name, "anistar.adapters")]
    assert set(importers_of("anistar.adapters", library)) <= {DEMO_PROBLEM, DIAGNOSIS}


def test_modules_import_each_other_without_circles():
    assert in_circles({name: {module_of(other) for other in ALL[name]} for name in ALL}) == set()


@pytest.mark.parametrize(
    ("package", "storeys"), [("anistar", PACKAGE_ROOMS), ("anistar.metric", METRIC_ROOMS)]
)
def test_rooms_import_from_those_below_them_only(package, storeys):
    floor = {room: number for number, rooms in enumerate(storeys) for room in rooms}
    assert {room_of(name, package) for name in ALL} - {None} == floor.keys()
    found = {(room_of(one, package), room_of(other, package)) for one in ALL for other in ALL[one]}
    inside = {(one, other) for one, other in found if {one, other} <= floor.keys() and one != other}
    assert inside
    assert sorted(pair for pair in inside if floor[pair[1]] >= floor[pair[0]]) == []


def room_of(name, package):
    """Return the module or folder of a package that a name is in; None for what is above them."""
    if not name.startswith(package + "."):
        return None
    room = name.removeprefix(package + ".").partition(".")[0]
    return None if room == "__main__" else room


@pytest.mark.parametrize("top", [PACKAGE, ROOT / "metric", CORE], ids=lambda path: path.name)
def test_no_folder_has_more_modules_than_can_be_looked_over(top):
    # a header and its source are one
    files = {path.with_suffix("") for path in top.rglob("*.*") if path.suffix in SUFFIXES}
    side_by_side = Counter(path.parent for path in files if path.name != "__init__")
    assert side_by_side
    crowded = {room: n for room, n in side_by_side.items() if n > MODULES_SIDE_BY_SIDE}
    assert crowded == {}


def in_circles(graph):
    """Nodes that reach themselves by way of others, or reach such nodes."""
    left = {name: others & graph.keys() - {name} for name, others in graph.items()}
    while free := {name for name, others in left.items() if not others}:
        left = {name: others - free for name, others in left.items() if name not in free}
    return set(left)


def module_of(name):
    """Return the module that a name is, or is from; None where it is not ours, or compiled."""
    above = name.rpartition(".")[0]
    return name if name in ALL else above if above in ALL and name != "anistar._core" else None


def test_importing_anistar_does_not_import_the_demo():
    reached, waiting = set(), ["anistar"]
    while waiting:
        name = waiting.pop()
        if name in reached or name not in ALL:
            continue
        reached.add(name)
        for other in ALL[name]:
            waiting += [other, other.rpartition(".")[0]]
    assert "anistar.metric" in reached
    assert DEMO_PROBLEM not in reached


@pytest.mark.parametrize("package", ["solver_examples", "tests"])
def test_the_package_never_imports_examples_or_tests(package):
    assert importers_of(package, ALL) == []


def test_modules_of_the_package_import_each_other_relatively():
    absolute = {
        name
        for name, path in sources().items()
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.ImportFrom)
        and node.level == 0
        and is_within(node.module, "anistar")
    }
    assert absolute == {PARAVIEW_PLUGIN}


def including(pattern):
    """Sources of the core with an include that matches."""
    line = re.compile(rf'^\s*#\s*include\s*[<"]({pattern})', re.MULTILINE)
    files = [*CORE.rglob("*.cpp"), *CORE.rglob("*.h")]
    assert files
    return [path.relative_to(CORE) for path in files if line.search(path.read_text())]


def test_only_the_bindings_know_python():
    found = including(r"nanobind/|Python\.h|numpy/|bindings/")
    assert found
    assert {path.parts[0] for path in found} == {"bindings"}


def test_the_compiled_module_exports_nothing_that_only_tests_use():
    stub = ast.parse((PACKAGE / "_core.pyi").read_text())
    exported = {node.name for node in stub.body if hasattr(node, "name")}
    text = "\n".join(path.read_text() for path in sources().values())
    text += (PACKAGE / "_core.pyi").read_text()
    assert {name for name in exported if len(re.findall(rf"\b{name}\b", text)) < 2} == set()


def test_cgal_stays_in_source_files_of_the_core():
    found = including("CGAL/")
    assert [str(path) for path in found if path.suffix != ".cpp"] == []
    assert [str(path) for path in found if path.parts[0] == "bindings"] == []


def included():
    """What each concept of the core, a header with its source, includes."""
    found = {}
    for path in [*CORE.rglob("*.cpp"), *CORE.rglob("*.h")]:
        names = re.findall(r'^#include "([^"]+)"', path.read_text(), re.MULTILINE)
        places = [folder / name for name in names for folder in (path.parent, CORE)]
        concepts = {place.resolve().with_suffix("") for place in places if place.exists()}
        found.setdefault(path.with_suffix(""), set()).update(concepts)
    return found


def test_concepts_of_the_core_include_each_other_without_circles():
    assert in_circles(included()) == set()


@pytest.mark.parametrize("mesher", ["plane", "volume"])
def test_no_two_uses_of_random_numbers_in_a_mesher_share_a_stream(mesher):
    sources = [path for room in (mesher, "stars") for path in (CORE / room).rglob("*.[ch]*")]
    drawn = Counter(
        stream for path in sources for stream in re.findall(r"Stream::(\w+)", path.read_text())
    )
    assert {"relocate", "mend", "pick"} <= drawn.keys()
    assert set(drawn.values()) == {1}


def core_includes():
    """Pairs of folders of the core, the first with an include of the second."""
    found = set()
    for path in [*CORE.rglob("*.cpp"), *CORE.rglob("*.h")]:
        folder = path.relative_to(CORE).parts[0]
        for other in re.findall(r'^#include "([^"]+)"', path.read_text(), re.MULTILINE):
            found.add((folder, other.partition("/")[0] if "/" in other else folder))
    return found


def test_folders_of_the_core_include_in_one_direction():
    assert {path.name for path in CORE.iterdir()} == {*CORE_FOLDERS, "bindings"}
    rank = {folder: number for number, folder in enumerate([*CORE_FOLDERS, "bindings"])}
    assert [(one, other) for one, other in core_includes() if rank[other] > rank[one]] == []


@pytest.mark.parametrize("mesher", ["plane", "volume"])
def test_rooms_of_a_mesher_include_in_one_direction(mesher):
    rank = {room: k for k, storey in enumerate(ROOMS_OF_A_MESHER) for room in storey}
    assert {path.name for path in (CORE / mesher).iterdir() if path.is_dir()} <= rank.keys()
    upward = []
    for path in (CORE / mesher).glob("*/*.*"):
        room = path.parent.name
        for other in re.findall(rf'^#include "{mesher}/([^"]+)"', path.read_text(), re.MULTILINE):
            inside = other.partition("/")[0]
            if inside != room and not ("/" in other and rank[inside] < rank[room]):
                upward.append((path.name, other))
    assert upward == []


def test_the_2d_and_the_3d_mesher_do_not_include_each_other():
    both = {*APART, *((other, one) for one, other in APART)}
    assert core_includes() & both == set()
