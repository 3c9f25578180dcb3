"""Compute the same things as on other CPUs and compare the bytes, see `cpu_levels`.

make same-bytes
"""

import hashlib
import json
import sys
from collections import defaultdict
from pathlib import Path

from cpu_levels import Level, blas_levels, libm_levels, output_at, simd_levels

RESULTS = Path(__file__).with_name("printed_digests.py")


def main():
    """Print what each level chose and how many digests there are; 0 if there is one."""
    plain = Level(name="as this CPU is", variables={})
    levels = [plain, *blas_levels(), *simd_levels(), *libm_levels()]
    found, usual = defaultdict(lambda: defaultdict(list)), None
    for level in levels:
        made = json.loads(output_at(level, [sys.executable, str(RESULTS)]))
        chosen = made["level"]
        usual = usual or chosen
        if not level.took_effect(chosen, usual):
            raise RuntimeError(f"{level.name} changed nothing: {chosen}")
        print(f"{level.name:40} BLAS {chosen['blas']}, SIMD {' '.join(chosen['simd']) or '-'}")
        for name, digest in made["digests"].items():
            found[name][digest].append(level.name)
    different = {name: by for name, by in found.items() if len(by) > 1}
    for name, by in different.items():
        print(f"{name}:")
        for digest, names in by.items():
            print(f"  {digest}  {', '.join(names)}")
    print(f"{len(levels)} levels, {len(found)} results, {len(different)} that differ")
    if not different:
        whole = hashlib.sha256("".join(digest for by in found.values() for digest in by).encode())
        print(f"one digest: {whole.hexdigest()[:16]}")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
