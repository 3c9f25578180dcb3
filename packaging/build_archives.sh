#!/usr/bin/env bash
# Builds into dist/ the source archive, a wheel for Python 3.12 and every later one, and one for
# 3.11 where that is installed with its headers. `./bootstrap.sh wheel` comes before it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source packaging/find_python.sh

readonly PYTHON=.venv/bin/python
readonly MADE=build/wheel
readonly ENVIRONMENT_3_11=build/python3.11

say() { printf 'wheel: %s\n' "$*" >&2; }

build_wheel() { # build_wheel PYTHON [PIP_ARGUMENT...]
  "$1" -m pip wheel --quiet --disable-pip-version-check --no-build-isolation --no-deps \
    --config-settings cmake.define.ANISTAR_FOR_TESTS=OFF "${@:2}" --wheel-dir "$MADE" .
}

make_environment_3_11() {
  local python=$1
  "$ENVIRONMENT_3_11/bin/python" -m pip --version >/dev/null 2>&1 ||
    "$python" -m venv --clear "$ENVIRONMENT_3_11"
  "$ENVIRONMENT_3_11/bin/python" -m pip install --quiet --disable-pip-version-check \
    --constraint requirements/development.txt -r requirements/build.txt
}

# What its build has left of the core, which knows no Python.
core_of() { # core_of WHEEL: name-version-tag.whl
  local tag=${1##*/}
  tag=${tag#*-}
  tag=${tag#*-}
  printf '%s\n' "$PWD/build/${tag%.whl}/libanistar_core.a"
}

# In a folder of its own: CMake remembers there that the core is another's.
build_wheel_for_3_11() { # build_wheel_for_3_11 CORE
  local python
  if ! python=$(find_python 3.11) || ! has_headers "$python"; then
    say "no wheel for Python 3.11: it, its headers or its venv module are missing"
    return
  fi
  make_environment_3_11 "$python"
  build_wheel "$ENVIRONMENT_3_11/bin/python" --config-settings build-dir=build/linked-3.11 \
    --config-settings "cmake.define.ANISTAR_CORE_LIBRARY=$1"
}

rm -rf "$MADE" dist
mkdir -p "$MADE" dist
"$PYTHON" -c 'from scikit_build_core.build import build_sdist; build_sdist("dist")' >/dev/null
build_wheel "$PYTHON"
core=$(core_of "$MADE"/*.whl)
printf '%s\n' "$core" >"$MADE/core" # for those who try the source archive
if is_python "$PYTHON" 3.11; then
  say "no wheel for Python 3.12 and later: .venv is of Python 3.11"
else
  build_wheel_for_3_11 "$core"
fi
# The shared libraries that the core needs go into the wheels.
PATH="$PWD/.venv/bin:$PATH" "$PYTHON" -m auditwheel repair --wheel-dir dist "$MADE"/*.whl \
  2>"$MADE/auditwheel.log" || { cat "$MADE/auditwheel.log" >&2; exit 1; }
ls -s -h dist
