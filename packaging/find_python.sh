# To be sourced: which Python there is, on PATH and below ~/.pyenv/versions.

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

has_headers() { # has_headers EXECUTABLE: whether C++ can be compiled for it
  "$1" -c "
import pathlib, sys, sysconfig
sys.exit(not pathlib.Path(sysconfig.get_path('include'), 'Python.h').exists())"
}
