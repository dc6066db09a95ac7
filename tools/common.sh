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

# count_tests FILE: prints why tests were skipped, then "N tests, N skipped", out of ctest's JUnit file.
count_tests() {
    [ -f "$1" ] || stop "ctest wrote no results" "read its messages above"
    # A skipped test's output is "FILE:LINE: Skipped" and its reason on the next line.
    awk '/: Skipped$/ { getline reason; ++skipped[reason] }
         END { for (reason in skipped) printf "skipped %d: %s\n", skipped[reason], reason }' "$1" | sort
    sed -n '/<testsuite /,/>/p' "$1" | tr '\n' ' ' |
        sed -n 's/.*tests="\([0-9]*\)".*skipped="\([0-9]*\)".*/\1 tests, \2 skipped\n/p'
}
