import ast
from pathlib import Path

import anistar.metric

ALLOWED = {"numpy", "scipy"}
STANDARD = {
    "__future__", "abc", "collections", "dataclasses", "difflib", "functools", "html", "importlib",
    "itertools", "logging", "math", "operator", "typing",
}  # fmt: skip


def test_the_metric_package_imports_numpy_and_scipy_only_and_kernels_alone_the_core():
    folder = Path(anistar.metric.__file__).parent
    files = sorted(folder.rglob("*.py"))
    assert len(files) > 10
    for file in files:
        depth = len(file.relative_to(folder).parts)
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                roots = {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                roots = {str(node.module).split(".")[0]}
            elif isinstance(node, ast.ImportFrom):
                assert node.level <= depth, f"{file.name} reaches out of the package"
                continue
            else:
                continue
            assert roots <= ALLOWED | STANDARD, f"{file.name} imports {roots}"
        if file.relative_to(folder).parts != ("kernels", "compiled.py"):
            assert "_core" not in file.read_text(encoding="utf-8"), file.name
