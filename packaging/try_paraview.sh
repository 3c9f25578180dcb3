#!/usr/bin/env bash
# ParaView itself, without a screen: installs the wheel for its Python where only ParaView looks,
# adapts a file with the plugin, and renders docs/images/paraview.png.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source packaging/find_python.sh

readonly PLACE=build/paraview
readonly SITE=$PLACE/with-anistar/lib/python3.11/site-packages

# Debian's ParaView renders to a screen only; without access control, for it reads no X cookies.
in_paraview() {
  PYTHONPATH=$SITE xvfb-run --auto-servernum --server-args="-ac -screen 0 1280x1024x24" \
    pvbatch "$@"
}

fail() {
  printf 'paraview-test: %s\n' "$*" >&2
  exit 1
}

wheel=(dist/*-cp311-cp311-*.whl)
[ -f "${wheel[0]}" ] || fail "make wheel has left no wheel for Python 3.11, which ParaView 5.11 runs"
python=$(find_python 3.11) || fail "Python 3.11, which ParaView 5.11 runs, is missing"

rm -rf "$PLACE"
mkdir -p "$PLACE"
"$python" -m venv "$PLACE/with-anistar"
"$PLACE/with-anistar/bin/python" -m pip install --quiet --disable-pip-version-check \
  --constraint requirements/development.txt "${wheel[0]}"

.venv/bin/python - "$PLACE/front.vtu" <<'PROGRAM'
import sys
import anistar, numpy, skfem
from anistar.adapters.skfem import from_skfem

mesh = from_skfem(skfem.MeshTet().refined(4))
u = numpy.tanh(20 * (numpy.linalg.norm(mesh.points, axis=1) - 0.7))
anistar.write(sys.argv[1], mesh, {"u": u})
PROGRAM

in_paraview "$SITE/anistar/adapters/vtk/paraview_run.py" \
  "$PLACE/front.vtu" "$PLACE/adapted.vtu" 3000 u
.venv/bin/anistar check "$PLACE/adapted.vtu"
in_paraview packaging/paraview_picture.py "$PLACE/adapted.vtu" "$PLACE/paraview.png"
cp "$PLACE/paraview.png" docs/images/paraview.png
ls -s -h docs/images/paraview.png
