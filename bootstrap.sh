#!/usr/bin/env bash
# Makes .venv with everything that building and testing anistar needs, and installs anistar
# into it. Run it as often as you like: it does only what changed since the last time.
#
#   ./bootstrap.sh            what `make demo` and `make test` need
#   ./bootstrap.sh docs       also what `make docs` needs
#   ./bootstrap.sh bench      also what `make bench` needs
#   ./bootstrap.sh wheel      also what `make wheel` needs
#   ./bootstrap.sh environment  all but anistar itself, of which another build goes elsewhere
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

readonly VENV=.venv
readonly STAMPS=$VENV/stamps
readonly DEBIAN_PACKAGES=(g++ cmake ninja-build libcgal-dev libeigen3-dev libegl1 libgl1
  libxrender1)

say() { printf 'bootstrap: %s\n' "$*" >&2; }

fail() {
  say "$*"
  exit 1
}

# --- Debian packages ---------------------------------------------------------------------

missing_debian_packages() {
  local package
  for package in "${DEBIAN_PACKAGES[@]}"; do
    dpkg-query --show --showformat='${db:Status-Status}\n' "$package" 2>/dev/null |
      grep -qx installed || printf '%s\n' "$package"
  done
}

# On other systems the same libraries have other names: check what can be checked.
require_tools() {
  local tool
  for tool in c++ cmake ninja; do
    command -v "$tool" >/dev/null ||
      fail "$tool is missing; install what Debian calls: ${DEBIAN_PACKAGES[*]}"
  done
}

install_debian_packages() {
  local missing sudo=()
  if ! command -v dpkg-query >/dev/null; then
    require_tools
    return
  fi
  mapfile -t missing < <(missing_debian_packages)
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
  "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
    --no-install-recommends "${missing[@]}" >&2
}

# --- Python ------------------------------------------------------------------------------

# A name on PATH may be a launcher that fails when it is run, so every candidate is run.
is_python() { # is_python EXECUTABLE MAJOR.MINOR
  "$1" -c "
import sys, venv, ensurepip
sys.exit('%d.%d' % sys.version_info[:2] != '$2')" >/dev/null 2>&1
}

find_python() { # find_python MAJOR.MINOR...: the first that runs, in the order given
  local version candidate
  for version in "$@"; do
    for candidate in "python$version" python3 \
      "$HOME/.pyenv/versions/$version".*/bin/python; do
      if is_python "$candidate" "$version"; then
        command -v "$candidate"
        return
      fi
    done
  done
  return 1
}

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

install_requirements() { # install_requirements NAME
  local file=requirements/$1.txt wanted
  [ -f "$file" ] || fail "there is no $file; known: development docs bench wheel"
  wanted=$(digest <"$file")
  is_done "$1" "$wanted" && return
  say "installing $file"
  "$VENV/bin/python" -m pip install --quiet --disable-pip-version-check -r "$file"
  if [ "$1" = development ] && is_python "$VENV/bin/python" 3.11; then
    say "Python 3.11: PETSc and dolfinx are left out, their wheels need Python 3.12"
  fi
  mark_done "$1" "$wanted"
}

source_digest() {
  {
    "$VENV/bin/python" --version
    find CMakeLists.txt pyproject.toml README.md LICENSE metric plugin -type f \
      \( -name '*.py' -o -name '*.pyi' -o -name py.typed -o -name '*.cpp' -o -name '*.h' \
      -o -name CMakeLists.txt -o -name pyproject.toml -o -name README.md -o -name LICENSE \) \
      -print0 | LC_ALL=C sort -z | xargs -0 sha256sum
  } | digest
}

# A plain install, not an editable one: type checkers and documentation builds cannot follow the
# import hook of an editable one, and the tests should see what a user gets. The build folder
# is kept, so that only the C++ files that changed are compiled again.
install_anistar() {
  local wanted
  wanted=$(source_digest)
  is_done anistar "$wanted" && return
  say "building and installing anistar"
  "$VENV/bin/python" -m pip install --quiet --disable-pip-version-check \
    --no-build-isolation --no-deps --force-reinstall \
    --config-settings cmake.define.ANISTAR_FOR_TESTS=ON .
  mark_done anistar "$wanted"
}

main() {
  local extra
  install_debian_packages
  make_environment
  install_requirements development
  if [ "$*" = environment ]; then
    return
  fi
  for extra in "$@"; do
    install_requirements "$extra"
  done
  install_anistar
}

main "$@"
