#!/bin/sh
# Builds the core with the address and undefined-behaviour sanitizers into an environment of its own, build/sanitized,
# which sees the packages of the development environment, and runs the tests that exercise it, with few examples of
# each property (SANITIZED_TESTS names other test files). Left out are long tests, those of the planning doors, as a
# server's worker may take too little memory for the sanitizers' shadow of it, and those that spend their time in
# Python, NumPy, Ray, Shapely or a solver. The first report of a sanitizer ends the run with an error.
set -eu
python=${PYTHON:-.venv/bin/python}
environment=build/sanitized
"$python" -m venv --clear "$environment"
packages() { "$1" -c 'import sysconfig; print(sysconfig.get_path("purelib"))'; }
packages "$python" > "$(packages "$environment/bin/python")/developed.pth"  # of it alone, not the muster that it names
"$environment/bin/pip" install --quiet --no-deps -C cmake.define.MUSTER_SANITIZE=ON -C cmake.define.MUSTER_WERROR=ON \
    -C build-dir=build/sanitizing -C install.strip=false .
core=$(find "$environment" -path '*/muster/core/_core*.so')
if ! ldd "$core" | grep -q libasan; then
    echo "the core in $environment was built without the sanitizers" >&2
    exit 1
fi
# The sanitizers must be loaded before Python, and libstdc++ beside them, or they miss C++ exceptions. Python itself
# keeps memory until it ends, so leaks are not looked for.
LD_PRELOAD="$(g++ -print-file-name=libasan.so) $(g++ -print-file-name=libubsan.so) $(g++ -print-file-name=libstdc++.so)" \
ASAN_OPTIONS=detect_leaks=0 \
UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1 \
HYPOTHESIS_PROFILE=few \
    "$environment/bin/python" -m pytest -p no:cacheprovider -n 2 --dist loadgroup --max-worker-restart 0 -rs \
    --suite=fast ${SANITIZED_TESTS:-tests/core tests/allocation tests/conformance tests/motion tests/simulation
    tests/traffic} \
    --ignore tests/core/test_stub.py --ignore tests/conformance/test_planning_doors.py \
    --ignore tests/allocation/test_bounds.py --ignore tests/allocation/test_exact.py \
    --ignore tests/allocation/test_ray_cluster.py --ignore tests/allocation/test_as_run.py \
    --ignore tests/allocation/test_map_travel.py --ignore tests/motion/areas
