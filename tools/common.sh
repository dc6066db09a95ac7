# Shared by the commands in tools/. Source it; it moves to the root of the checkout.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# With a terminal, step lines stand out; in a log they are plain.
if [ -t 1 ]; then bold=$'\e[1m' plain=$'\e[0m'; else bold='' plain=''; fi
say() { printf '%s== %s%s\n' "$bold" "$*" "$plain"; }
stop() { printf 'error: %s\n' "$1" >&2; [ -z "${2:-}" ] || printf '  remedy: %s\n' "$2" >&2; exit 1; }

# Every core, but never more compilers at once than memory carries (about 1.5 GB each).
jobs() {
    local cores memory
    cores=$(nproc)
    memory=$(awk '/MemAvailable/ { print int($2 / 1500000) }' /proc/meminfo)
    [ "$memory" -ge 1 ] || memory=1
    echo $((cores < memory ? cores : memory))
}

# configure PRESET: once; later ninja itself notices what changed.
configure() {
    [ -f "build/$1/build.ninja" ] && return
    say "Configuring build/$1"
    cmake --preset "$1" >"/tmp/touchstone-configure.$$" 2>&1 || {
        cat "/tmp/touchstone-configure.$$" >&2
        rm -f "/tmp/touchstone-configure.$$" "build/$1/build.ninja"
        stop "the $1 build could not be configured" "read the messages above; tools/setup installs what is missing"
    }
    rm -f "/tmp/touchstone-configure.$$"
}

# build PRESET [TARGET...]
build() {
    local preset=$1
    shift
    configure "$preset"
    say "Building ${*:-everything} in build/$preset"
    ninja -C "build/$preset" -j "$(jobs)" "$@"
}

# count_tests BUILD: prints why tests were skipped, then "N tests, N skipped", out of ctest's JUnit file and, for programs that run in
# parts (tests/CMakeLists.txt), GoogleTest's. Fails where a part wrote none: it ended before its last case, whatever its status was.
count_tests() {
    local results=$1/test_results.xml
    [ -f "$results" ] || stop "ctest wrote no results" "read its messages above"
    # ctest has the output of a skipped test: "FILE:LINE: Skipped", and the reason on the next line. GoogleTest has "FILE:LINE", the end of a
    # line and the reason in an attribute.
    { cat "$results" && find "$1/test_parts" -name '*.xml' -exec cat {} + 2>/dev/null || true; } |
        awk '/<testcase name=/ { part = /<testcase name="Together\./; parts += part; tests += !part }
             /<testsuites / { ++written }
             /: Skipped$/ && !part { getline reason; ++skipped[reason]; ++all }
             sub(/.*<skipped message="[^"]*:[0-9]+&#x0A;/, "") { sub(/(&#x0A;)*".*/, ""); ++skipped[$0]; ++all }
             END { for (reason in skipped)
                       printf "skipped %d: %s\n", skipped[reason], reason == "" ? "no reason" : reason | "sort"
                   close("sort")
                   printf "%d tests, %d skipped\n", tests, all
                   if (parts != written)
                       printf "of %d parts of programs %d ended without results\n", parts, parts - written
                   exit parts != written }'
}

# figures_of_the_window <SCRIPT: runs a Python script that drives the real window on a virtual screen and saves parts
# of it to docs/figures (tools/workbench_driver.py): Workbench(*where, SCENE, OPTION...).
figures_of_the_window() {
    local program work status=0
    for program in import convert xdotool; do
        command -v $program >/dev/null || stop "$program is missing" "apt-get install imagemagick xdotool"
    done
    build release touchstone
    work=$(mktemp -d)
    # shellcheck disable=SC2064 # the folder of this call
    trap "rm -rf '$work'" EXIT
    mkdir -p "$work/touchstone" "$work/home/"{Documents,Downloads,Models,Scans}
    cp assets/scenes/{box,doughnut,prism_smooth}.glb "$work/home"
    {
        echo 'import sys, time'
        echo 'sys.path.insert(0, "tools")'
        echo 'from workbench_driver import Workbench, run'
        echo 'where = sys.argv[1:4]'
        cat
    } >"$work/script.py"
    HOME=$work/home TOUCHSTONE_FILE_DIALOG=window XDG_STATE_HOME=$work XDG_CACHE_HOME=$work xvfb-run -a -s '-screen 0 1280x800x24' \
        env PYTHONDONTWRITEBYTECODE=1 python3 "$work/script.py" "$PWD/build/release/bin/touchstone" "$work" docs/figures || status=$?
    return "$status"
}
