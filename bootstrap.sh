#!/usr/bin/env bash
# Makes .venv with everything that building and testing anistar needs, and installs anistar
# into it. Run it as often as you like: it does only what changed since the last time.
#
#   ./bootstrap.sh demo       what `make demo` needs: no solver but scikit-fem
#   ./bootstrap.sh            what `make test` needs: every solver that the tests drive
#   ./bootstrap.sh docs       also what `make docs` needs
#   ./bootstrap.sh bench      also what `make bench` needs
#   ./bootstrap.sh wheel      also what `make wheel` needs
#   ./bootstrap.sh programs   only the browser and the solver that tests run if they are there
#   ./bootstrap.sh paraview   also what `make paraview-test` needs
#   ./bootstrap.sh environment  all but anistar itself, of which another build goes elsewhere
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
source packaging/find_python.sh

readonly VENV=.venv
readonly STAMPS=$VENV/stamps
readonly BUILD_PACKAGES=(g++ cmake ninja-build libcgal-dev libeigen3-dev)
readonly SOLVER_PACKAGES=(libegl1 libgl1 libglu1-mesa libxcursor1 libxft2 libxinerama1 libxrender1)
readonly PROGRAMS=(chromium fonts-dejavu-core freefem++)
readonly PARAVIEW_PACKAGES=(paraview python3-paraview xvfb xauth libgl1-mesa-dri)

say() { printf 'bootstrap: %s\n' "$*" >&2; }

fail() {
  say "$*"
  exit 1
}

# --- Debian packages ---------------------------------------------------------------------

missing_debian_packages() { # missing_debian_packages PACKAGE...
  local package
  for package in "$@"; do
    dpkg-query --show --showformat='${db:Status-Status}\n' "$package" 2>/dev/null |
      grep -qx installed || printf '%s\n' "$package"
  done
}

# On other systems the same libraries have other names: check what can be checked.
require_tools() {
  local tool
  for tool in c++ cmake ninja; do
    command -v "$tool" >/dev/null ||
      fail "$tool is missing; install what Debian calls: ${BUILD_PACKAGES[*]}"
  done
}

install_debian_packages() { # install_debian_packages PACKAGE...
  local missing sudo=()
  if ! command -v dpkg-query >/dev/null; then
    require_tools
    return
  fi
  mapfile -t missing < <(missing_debian_packages "$@")
  [ "${#missing[@]}" -gt 0 ] || return 0
  if [ "$(id -u)" -ne 0 ]; then
    if ! { command -v sudo >/dev/null && sudo -n true 2>/dev/null; } && [ ! -t 0 ]; then
      fail "missing Debian packages; run: sudo apt-get install ${missing[*]}"
    fi
    command -v sudo >/dev/null ||
      fail "missing Debian packages; as root run: apt-get install ${missing[*]}"
    sudo=(sudo)
  fi
  say "installing Debian packages: ${missing[*]}"
  "${sudo[@]}" apt-get update -qq
  "${sudo[@]}" apt-get install --assume-no --no-install-recommends "${missing[@]}" 2>/dev/null |
    sed -n 's/^Need to get/bootstrap: to download:/p' >&2 || true
  "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
    -o DPkg::Lock::Timeout=600 --no-install-recommends "${missing[@]}" >&2
}

# --- Python ------------------------------------------------------------------------------

make_environment() {
  local python
  if "$VENV/bin/python" -m pip --version >/dev/null 2>&1; then
    return
  fi
  python=$(find_python 3.12 3.13 3.14 3.11) ||
    fail "Python 3.12 (or 3.11 with the venv module) is missing, on PATH and below ~/.pyenv/versions"
  say "making $VENV with $("$python" --version) at $python"
  rm -rf "$VENV"
  "$python" -m venv "$VENV"
}

# --- Packages ----------------------------------------------------------------------------

digest() { sha256sum | cut -d ' ' -f 1; }

is_done() { # is_done STAMP DIGEST
  [ -f "$STAMPS/$1" ] && [ "$(<"$STAMPS/$1")" = "$2" ]
}

mark_done() {
  mkdir -p "$STAMPS"
  printf '%s\n' "$2" >"$STAMPS/$1"
}

requirements_digest() { cat requirements/development.txt "requirements/$1.txt" | digest; }

# What a requirements file says of itself, measured by its author.
downloads() { sed -n 's/^# Downloads about \(.*\)\.$/\1/p' "$1" | head -n 1; }

install_requirements() { # install_requirements NAME
  local file=requirements/$1.txt wanted
  [ -f "$file" ] || fail "there is no $file; known: demo docs bench wheel programs paraview"
  wanted=$(requirements_digest "$1")
  is_done "$1" "$wanted" && return
  say "installing $file (downloads about $(downloads "$file"), less what pip has kept)"
  "$VENV/bin/python" -m pip install --quiet --disable-pip-version-check \
    --constraint requirements/development.txt -r "$file"
  if [ "$1" = development ] && is_python "$VENV/bin/python" 3.11; then
    say "Python 3.11: PETSc and dolfinx are left out, their wheels need Python 3.12"
  fi
  mark_done "$1" "$wanted"
}

source_digest() {
  {
    "$VENV/bin/python" --version
    find CMakeLists.txt pyproject.toml README.md LICENSE metric plugin -type f \
      \( -name '*.py' -o -name '*.pyi' -o -name '*.js' -o -name py.typed -o -name '*.cpp' -o -name '*.h' \
      -o -name CMakeLists.txt -o -name pyproject.toml -o -name README.md -o -name LICENSE \) \
      -print0 | LC_ALL=C sort -z | xargs -0 sha256sum
  } | digest
}

# How far the compiler is: in one line on a terminal, else in ten.
show_steps() {
  local step count total shown=0 end='\n' every=10
  [ -t 2 ] && end='\r' every=100
  while IFS= read -r step; do
    [[ $step =~ ^\ *\[([0-9]+)/([0-9]+)\] ]] || continue
    count=${BASH_REMATCH[1]} total=${BASH_REMATCH[2]}
    if [ $((count * every / total)) -gt "$shown" ] || [ "$count" -eq "$total" ]; then
      shown=$((count * every / total))
      printf "bootstrap: built %d of %d$end" "$count" "$total" >&2
    fi
  done
  [ ! -t 2 ] || printf '\n' >&2
}

# As many compilers as there are cores, but no more than memory holds: the largest source takes 1 GB.
compilers() {
  local cores gigabytes
  cores=$(nproc 2>/dev/null || echo 2)
  gigabytes=$(awk '/^MemAvailable/ { print int($2 / 1e6) }' /proc/meminfo 2>/dev/null || echo 2)
  [ "$gigabytes" -ge 1 ] || gigabytes=1
  echo $((cores < gigabytes ? cores : gigabytes))
}

# A plain install, not an editable one: type checkers and documentation builds cannot follow the
# import hook of an editable one, and the tests should see what a user gets. The build folder
# is kept, so that only the C++ files that changed are compiled again.
install_anistar() { # install_anistar ON|OFF: with or without the module that only tests import
  local wanted log=build/install.log
  wanted=$(source_digest)
  is_done anistar "$wanted ON" && return
  is_done anistar "$wanted $1" && return
  say "building and installing anistar; the compiler's words go to $log"
  mkdir -p build
  export CMAKE_BUILD_PARALLEL_LEVEL=${CMAKE_BUILD_PARALLEL_LEVEL:-$(compilers)}
  "$VENV/bin/python" -m pip install --verbose --disable-pip-version-check \
    --no-build-isolation --no-deps --force-reinstall \
    --config-settings cmake.define.ANISTAR_FOR_TESTS="$1" . 2>&1 | tee "$log" | show_steps || {
    tail -n 40 "$log" >&2
    fail "the build failed; all it said is in $log"
  }
  mark_done anistar "$wanted $1"
}

# Python 3.11 has no stable ABI that serves: its wheel takes the headers of that very version.
install_python_for_old_wheel() {
  local python
  if python=$(find_python 3.11) && has_headers "$python"; then
    return
  fi
  if apt-cache show python3.11-dev >/dev/null 2>&1; then
    install_debian_packages python3.11-dev python3.11-venv
  fi
}

main() {
  local extra
  if [ "$*" = programs ]; then
    install_debian_packages "${PROGRAMS[@]}"
    return
  fi
  install_debian_packages "${BUILD_PACKAGES[@]}"
  make_environment
  if [ "$*" = demo ]; then
    is_done development "$(requirements_digest development)" || install_requirements demo
    install_anistar OFF
    return
  fi
  install_debian_packages "${SOLVER_PACKAGES[@]}"
  install_requirements development
  if [ "$*" = environment ]; then
    return
  fi
  for extra in "$@"; do
    case $extra in
      paraview) install_debian_packages "${PARAVIEW_PACKAGES[@]}" ;;
      wheel)
        install_python_for_old_wheel
        install_requirements wheel
        ;;
      *) install_requirements "$extra" ;;
    esac
  done
  install_anistar ON
}

main "$@"
