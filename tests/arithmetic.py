"""What sources call that rounds differently from CPU to CPU."""

import ast
import re

ELEMENTARY = (
    r"exp2?|expm1|log(2|10|1p|addexp2?)?|pow|(float_)?power|cbrt|hypot|dist|erfc?|t?l?gamma|fma|"
    r"(a|arc)?(sin|cos|tan)h?|(a|arc)tan2"
)
# NumPy picks loops of these by the instruction set that it finds, or leaves them to the C library,
# which does the same; products of matrices go to BLAS, which picks its kernels.
NUMPY = re.compile(
    rf"{ELEMENTARY}|v?dot|inner|mat(mul|vec)|vec(mat|dot)|tensordot|einsum_path|linalg|"
    r"polynomial|polyfit|convolve|correlate|cov|corrcoef|sinc|angle|(log|geom)space"
)
MATH = re.compile(ELEMENTARY)
# Equal keys come out in an order that depends on the instruction set as well.
SORTS = {"argsort", "argpartition"}
# Of SciPy's solvers only what wraps a function as an operator is free.
WRAPPERS = {"LinearOperator", "aslinearoperator"}
SCIPY = ("linalg", "sparse.linalg", "special", "optimize", "interpolate", "fft", "stats", "signal")
METHODS = {"dot"}

CORE = re.compile(rf"\bstd::({ELEMENTARY})\b")


class Calls(ast.NodeVisitor):
    """Collects ``{(function, what): line}`` of what a module does in such arithmetic."""

    def __init__(self, source):
        self.found, self.names, self.inside = {}, {}, []
        self.visit(ast.parse(source))

    def note(self, what, node):
        self.found.setdefault((".".join(self.inside) or "(module)", what), node.lineno)

    def visit_FunctionDef(self, node):
        self.inside.append(node.name)
        self.generic_visit(node)
        self.inside.pop()

    def visit_ClassDef(self, node):
        self.visit_FunctionDef(node)

    def visit_Import(self, node):
        for alias in node.names:
            root = alias.name.partition(".")[0]
            self.names[alias.asname or root] = alias.name if alias.asname else root
            self.note_name(alias.name, node)

    def visit_ImportFrom(self, node):
        for alias in node.names:
            if node.level == 0:
                self.names[alias.asname or alias.name] = f"{node.module}.{alias.name}"
                self.note_name(f"{node.module}.{alias.name}", node)

    def visit_Attribute(self, node):
        name = self.full_name(node)
        if name:
            self.note_name(name, node)
        else:
            if node.attr in METHODS:
                self.note(f".{node.attr}", node)
            self.generic_visit(node)

    def full_name(self, node):
        """Return the dotted name of an attribute of an imported module."""
        parts = []
        while isinstance(node, ast.Attribute):
            parts.append(node.attr)
            node = node.value
        if isinstance(node, ast.Name) and node.id in self.names:
            return ".".join([self.names[node.id], *reversed(parts)])
        return None

    def note_name(self, name, node):
        root, _, rest = name.partition(".")
        first = rest.partition(".")[0]
        if (root == "numpy" and NUMPY.fullmatch(first)) or (
            root == "math" and MATH.fullmatch(first)
        ):
            self.note(f"{root}.{first}", node)
        elif root == "scipy":
            for package in SCIPY:
                inner = rest.removeprefix(package)
                if inner != rest and inner[:1] in ("", ".") and inner[1:] not in WRAPPERS:
                    self.note(f"scipy.{package}", node)

    def visit_BinOp(self, node):
        self.note_operator(node.op, node.left, node.right, node)

    def visit_AugAssign(self, node):
        self.note_operator(node.op, node.target, node.value, node)

    def note_operator(self, operator, left, right, node):
        if isinstance(operator, ast.MatMult):
            self.note("@", node)
        elif isinstance(operator, ast.Pow) and not is_exact(left, right):
            self.note("**", node)
        self.generic_visit(node)

    def visit_Call(self, node):
        if isinstance(node.func, ast.Name) and node.func.id == "pow":
            self.note("**", node)
        if self.full_name(node.func) == "numpy.einsum":
            for keyword in node.keywords:
                if keyword.arg == "optimize":
                    self.note("einsum(optimize=)", node)
        if isinstance(node.func, ast.Attribute) and node.func.attr in SORTS and not is_stable(node):
            self.note(node.func.attr, node)
        self.generic_visit(node)


def is_stable(sort):
    """Tell whether the call of a sort asks for a stable one."""
    return any(
        keyword.arg == "kind" and getattr(keyword.value, "value", None) == "stable"
        for keyword in sort.keywords
    )


def is_exact(base, exponent):
    """Tell whether a power is one of whole literals, or of 2: those are exact however taken."""
    literals = [node.value for node in (base, exponent) if isinstance(node, ast.Constant)]
    return len(literals) == 2 and (
        all(isinstance(value, int) for value in literals)
        or (literals[0] == 2.0 and isinstance(literals[1], int))
    )


def called(source):
    """Return ``{(function, what): line}`` of a Python source."""
    return Calls(source).found


def called_in_core(source):
    """Return ``{what: line}`` of a C++ source, comments aside."""
    found = {}
    for number, line in enumerate(source.splitlines(), start=1):
        for match in CORE.finditer(line.partition("//")[0]):
            found.setdefault(match[0], number)
    return found
