#!/bin/sh
# Looks for what a fresh Debian 12 needs before anything can be built, and names the line that installs what is missing.
set -u
python=${PYTHON:-python3}
missing=""
need() { # PACKAGE COMMAND...: the command succeeds where the package is there
    package=$1
    shift
    "$@" >/dev/null 2>&1 || missing="$missing $package"
}
need python3 "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))'
need python3-venv "$python" -c 'import ensurepip, venv'
need python3-dev "$python" -c 'import os, sysconfig; open(os.path.join(sysconfig.get_path("include"), "Python.h"))'
need g++ g++ --version
need git git --version
if [ -n "$missing" ]; then
    echo "Muster cannot be built yet. Install what is missing:" >&2
    echo "    sudo apt-get install$missing" >&2
    exit 1
fi
