"""Results take the same bytes on every CPU: nothing that decides them may round by the CPU.

BLAS and LAPACK, NumPy's loops of exp, log and power, and the C library's own, are chosen when the
process runs, by the instructions that the CPU has, and round differently. Python's ``**`` of floats
is the C library's ``pow``, even for squares; ``numpy.square`` and products are plain arithmetic.
Sorts that are not stable are chosen in the same way, and leave equal keys in different orders.
"""

import ast
from fnmatch import fnmatchcase

import pytest
from arithmetic import called, called_in_core
from test_architecture import CORE, is_within, sources

SPARSE = (
    "sparse times dense or sparse: SciPy's own loops, compiled once for all CPUs, on one thread"
)
PICTURE = "draws; nothing is decided by a picture"
INPUT = "makes the input of a demonstration, as a user's own code would"
EXACT = "whole numbers, exact whatever takes the power"

# Places that may, as `module:function what`, and why.
MAY = {
    "anistar.adapters.vtk.glyphs:* *": PICTURE,
    "anistar.pictures.plane:* *": PICTURE,
    "anistar.pictures.volume:* *": PICTURE,
    "anistar.views.scene:* *": PICTURE,
    "anistar.views.web_view:* *": PICTURE,
    "anistar.generating.report.shapes:least_angles numpy.arccos": "rounded figures of a report",
    "anistar.formats.content.plane:_no_plane numpy.linalg": "chooses the words of an error",
    "anistar.formats.content.second_order:_rows_of @": EXACT,
    "anistar.formats.content.second_order:_refined **": EXACT,
    "anistar.demo.problem:* *": INPUT,
    "anistar.demo.volume:* *": INPUT,
    "anistar.loops.loop_options:LoopOptions.complexity_after **": EXACT,
    "anistar.loops.loop:_stages **": EXACT,
    "anistar.transfer.projection.bounded:_refilled @": SPARSE,
    "anistar.transfer.interpolation:Interpolator.carried @": SPARSE,
    "anistar.transfer.values.labels:majority @": SPARSE,
    "anistar.transfer.projection.loading:overlapped.loaded @": SPARSE,
    "anistar.transfer.projection.l2_projection:Projector.* @": SPARSE,
    "anistar.metric.sources.boundary_shape:_two_rings @": SPARSE,
    "anistar.metric.kernels.graph:_opposite_pairs **": EXACT,
    "anistar.metric.sources.indicators:dwr_metric scipy.optimize": "root-find in plain arithmetic",
    "anistar.metric.kernels.elementary:* numpy.*": "the NumPy twins, used without the core",
    "anistar.metric.recovery.methods.boundary:Boundary.extrapolated @": SPARSE,
    "anistar.metric.recovery.samples.cells:boundary_facets **": EXACT,
    "anistar.metric.recovery.patches.fit:_patches @": SPARSE,
    "anistar.metric.recovery.methods.projection:L2Projection.* @": SPARSE,
    "anistar.metric.recovery.methods.quadratic:quadratic_cloud @": SPARSE,
}

# The one file of the core that holds elementary functions of its own.
CORE_MAY = {"base/elementary.h"}


def places(package):
    """Return ``{place: file:line}`` of the modules of a package, as `MAY` writes places."""
    found = {}
    for module, path in sources().items():
        in_metric = is_within(module, "anistar.metric")
        if in_metric == (package == "anistar.metric"):
            for (function, what), line in called(path.read_text()).items():
                found[f"{module}:{function} {what}"] = f"{path}:{line}"
    return found


def is_allowed(place):
    return any(fnmatchcase(place, pattern) for pattern in MAY)


@pytest.mark.parametrize("package", ["anistar", "anistar.metric"])
def test_nothing_that_decides_a_result_rounds_by_the_cpu(package):
    found = places(package)
    assert [f"{where} {place}" for place, where in found.items() if not is_allowed(place)] == []


def test_every_place_that_may_round_by_the_cpu_still_does():
    found = [*places("anistar"), *places("anistar.metric")]
    assert [p for p in MAY if not any(fnmatchcase(place, p) for place in found)] == []


def test_the_core_takes_its_elementary_functions_from_one_file():
    found = []
    for path in sorted([*CORE.rglob("*.cpp"), *CORE.rglob("*.h")]):
        name = path.relative_to(CORE).as_posix()
        if name not in CORE_MAY:
            found += [f"{name}:{n} {what}" for what, n in called_in_core(path.read_text()).items()]
    assert found == []


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ("import numpy as np; np.linalg.norm(x)", "numpy.linalg"),
        ("import numpy; y = numpy.exp", "numpy.exp"),
        ("from numpy import log1p", "numpy.log1p"),
        ("from numpy.linalg import solve", "numpy.linalg"),
        ("import numpy as np; np.linalg.LinAlgError", "numpy.linalg"),
        ("import math; math.hypot(a, b)", "math.hypot"),
        ("from math import exp", "math.exp"),
        ("from scipy.sparse.linalg import cg", "scipy.sparse.linalg"),
        ("import scipy; scipy.linalg.pinvh(A)", "scipy.linalg"),
        ("from scipy import linalg", "scipy.linalg"),
        ("a @ b", "@"),
        ("a @= b", "@"),
        ("(a + b).dot(c)", ".dot"),
        ("x**2", "**"),
        ("0.75**0.5", "**"),
        ("x **= 3", "**"),
        ("pow(x, 2)", "**"),
        ("import numpy as np; np.einsum('ij,jk', a, b, optimize=True)", "einsum(optimize=)"),
        ("import numpy as np; np.argsort(x)", "argsort"),
        ("x.argsort(kind='quicksort')", "argsort"),
        ("import numpy as np; np.argpartition(x, 3)", "argpartition"),
    ],
)
def test_what_rounds_by_the_cpu_is_seen(line, what):
    source = f"class C:\n    def f(self):\n        {line}\n"
    ast.parse(source)
    assert called(source) == {("C.f", what): 3}


@pytest.mark.parametrize(
    "line",
    [
        "import numpy as np; np.sqrt(np.square(x).sum(axis=1)); np.einsum('ij,jk', a, b)",
        "from scipy.sparse.linalg import LinearOperator, aslinearoperator",
        "import scipy; scipy.sparse.csr_array(a)",
        "import math; math.sqrt(x) + math.ldexp(1.0, 3) + math.floor(x)",
        "import numpy as np; np.argsort(x, kind='stable'); x.argsort(axis=1, kind='stable')",
        "2**63 - 10**3 + 2.0**29",
        "f(**options)",
        "log = np_log = self.exp(x)",
    ],
)
def test_what_rounds_alike_everywhere_is_free(line):
    assert called(line) == {}


def test_comments_of_the_core_may_name_functions():
    assert called_in_core("// std::exp\nx = std::sqrt(y);  // not std::log\n") == {}
    assert called_in_core("x = 1;\ny = std::pow(x, 3);\n") == {"std::pow": 2}
