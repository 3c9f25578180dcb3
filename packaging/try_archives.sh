#!/usr/bin/env bash
# Tries what `make wheel` has left in dist/ as a new user would: an environment and a home of its
# own, no compiler on the path, no variable set. The source archive is built without a network.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
source packaging/find_python.sh

readonly TRIED=$PWD/build/tried
readonly LARGEST=4000000 # bytes of a wheel

say() { printf 'wheel-test: %s\n' "$*" >&2; }

fail() {
  say "$*"
  exit 1
}

# Only what reaches an index is taken over, for machines behind a proxy, and pip's own store.
clean() { # clean FOLDER COMMAND...
  local kept=() name
  for name in PIP_CERT PIP_INDEX_URL SSL_CERT_FILE http_proxy https_proxy no_proxy; do
    [ -z "${!name:-}" ] || kept+=("$name=${!name}")
  done
  (cd "$1" && env -i PATH=/nowhere HOME="$1/home" LANG=C.UTF-8 \
    PIP_CACHE_DIR="$TRIED/pip" "${kept[@]}" "${@:2}")
}

try_wheel_with() { # try_wheel_with FOLDER WHEEL MAJOR.MINOR...: with the first of these that is there
  local python
  if python=$(find_python "${@:3}"); then
    try_wheel "$2" "$python" "$1"
  else
    say "$(basename "$2") is not tried with Python ${*:3}, which is not there"
  fi
}

try_wheel() { # try_wheel WHEEL PYTHON FOLDER
  local place=$TRIED/$3 python=$TRIED/$3/venv/bin/python started
  [ "$(stat -c %s "$1")" -lt "$LARGEST" ] || fail "$1 is larger than $LARGEST bytes"
  mkdir -p "$place/home"
  "$2" -m venv --clear "$place/venv"
  cp packaging/first_mesh.py "$place"
  started=$(date +%s%N)
  clean "$place" "$python" -m pip install --quiet --disable-pip-version-check \
    --constraint "$PWD/requirements/development.txt" "$1"
  clean "$place" "$python" first_mesh.py
  say "$(basename "$1") with $("$2" --version): $((($(date +%s%N) - started) / 1000000)) ms" \
    "from pip install to the first adapted meshes"
  clean "$place" "$place/venv/bin/anistar" --version
  clean "$place" "$place/venv/bin/anistar" doctor >"$place/doctor.txt" || fail "see $place/doctor.txt"
  ! clean "$place" "$python" -c 'import anistar.adapters.vtk' 2>"$place/missing.txt" ||
    fail "the VTK adapter works without VTK"
  grep -q -F -- "$python -m pip install 'vtk>=" "$place/missing.txt" ||
    fail "the advice is wrong: $(tail -n 1 "$place/missing.txt")"
  ! ls "$place"/venv/lib/python*/site-packages/anistar/_core_for_tests* 2>/dev/null ||
    fail "a module that only tests import is in $1"
}

# In a network of its own that leads nowhere, where that may be made.
offline() {
  if unshare --net true 2>/dev/null; then
    unshare --net "$@"
  elif unshare --map-root-user --net true 2>/dev/null; then
    unshare --map-root-user --net "$@"
  else
    say "WARNING: unshare may make no network here: what follows is tried with the network of this" \
      "machine, and shows nothing of how it does without"
    "$@"
  fi
}

# The core is the one that lies in build/, if the archive holds the very sources it was made of:
# to compile it anew takes minutes.
try_source_archive() { # try_source_archive ARCHIVE
  local place=$TRIED/source core
  core=$(<build/wheel/core)
  mkdir -p "$place/archive"
  tar --extract --gzip --file "$1" --directory "$place/archive" --strip-components 1
  diff --recursive --brief plugin/core "$place/archive/plugin/core"
  diff --recursive --brief CMakeLists.txt "$place/archive/CMakeLists.txt"
  offline .venv/bin/python -m pip wheel --quiet --disable-pip-version-check --no-index --no-deps \
    --no-build-isolation --wheel-dir "$place/made" \
    --config-settings "cmake.define.ANISTAR_CORE_LIBRARY=$core" "$PWD/$1"
  try_wheel "$place"/made/*.whl .venv/bin/python source
}

rm -rf "$TRIED"
mkdir -p "$TRIED"
for tags in cp311-cp311 cp312-abi3; do
  ls dist/*-"$tags"-*.whl >/dev/null 2>&1 || say "there is no wheel $tags to be tried: make wheel says why"
done
for wheel in "$PWD"/dist/*.whl; do
  case $wheel in
    *-cp311-cp311-*) try_wheel_with 3.11 "$wheel" 3.11 ;;
    *-cp312-abi3-*)
      try_wheel_with 3.12 "$wheel" 3.12
      # and with the newest there is, for which it was not compiled
      try_wheel_with later "$wheel" 3.14 3.13
      ;;
    *) fail "$wheel is for no Python that was asked for" ;;
  esac
done
try_source_archive dist/*.tar.gz
