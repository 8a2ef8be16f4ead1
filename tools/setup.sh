# Sourced by the tools: installs what is missing and builds what is stale. Quick when nothing is.
#
# After it: $root (the checkout), $build (the release build), $python (FreeCAD's Python), and
# PYTHONPATH for `import beltgrinding`.
# shellcheck shell=bash

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$root/build/release
python=/usr/bin/python3
export BELTGRINDING_SHARED=${BELTGRINDING_SHARED:-$root/../shared}
export PYTHONPATH=$root/Mod/BeltGrinding:$build/python${PYTHONPATH:+:$PYTHONPATH}
export QTWEBENGINE_DISABLE_SANDBOX=1 LANG=${LANG:-C.UTF-8}
# numpy's functions for AVX-512 round otherwise, and the examples' parts with them: figures and pictures are the same
# on every processor without these.
# numpy warns of those that the processor lacks, which our messages would then begin with.
vectors=
for one in AVX512F:avx512f AVX512CD:avx512cd AVX512_SKX:avx512vl AVX512_CLX:avx512_vnni AVX512_CNL:avx512vbmi \
    AVX512_ICL:avx512_vbmi2; do
    if grep -qw "${one#*:}" /proc/cpuinfo; then vectors+=" ${one%%:*}"; fi
done
if [ -n "$vectors" ]; then export NPY_DISABLE_CPU_FEATURES=${vectors# }; else unset NPY_DISABLE_CPU_FEATURES; fi
unset one vectors
# What one checkout compiled serves another on the same machine: ccache sees paths from the checkout on.
export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$root} CCACHE_NOHASHDIR=1

packages_build=(g++ cmake ninja-build ccache libeigen3-dev pybind11-dev python3-dev libtbb-dev libfmt-dev
    libocct-foundation-dev libocct-modeling-data-dev libocct-modeling-algorithms-dev
    libocct-data-exchange-dev libocct-ocaf-dev libembree-dev libhdf5-dev
    libcoin-dev libgl-dev qttools5-dev-tools
    libnanoflann-dev lib3mf-dev libassimp-dev libfcl-dev libompl-dev libsvm-dev python3-pythran libgtest-dev libbenchmark-dev
    libfontconfig-dev) # OpenCASCADE 7.8 names it among its own libraries, and its package does not
packages_run=(freecad python3-numpy python3-jsonschema python3-matplotlib python3-pil libjs-three
    python3-dask python3-distributed python3-openturns xvfb xauth libgl1-mesa-dri)
packages_docs=(mkdocs mkdocs-material doxygen graphviz)
packages_test=(pkg-config libxtst6 python3-pykdl "${packages_docs[@]}" weasyprint poppler-utils zsh fish groff-base chromium python3-pytest python3-pytest-xdist python3-scipy python3-h5py python3-yaml mypy pmccabe calculix-ccx cloudcompare slurmctld slurmd slurm-client)

say() { printf '%s\n' "$*" >&2; }

dpkg_status=/var/lib/dpkg/status # changes whenever a package comes or goes

# install_missing PACKAGE...: by apt, only what dpkg does not have. What was found installed is noted
# in build/packages, and not asked for again until dpkg's status changes.
install_missing() {
    command -v dpkg-query >/dev/null || {
        say "This set-up knows Debian's apt only; install yourself: $*"
        return 1
    }
    local noted=$root/build/packages package
    if [ "$noted" -nt "$dpkg_status" ] && grep -qsxF -- "$*" "$noted"; then
        return 0
    fi
    local -A installed=()
    while read -r package; do
        installed[$package]=1
    done < <(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "$@" 2>/dev/null | sed -n 's/ installed$//p')
    local missing=()
    for package in "$@"; do
        [ -n "${installed[$package]:-}" ] || missing+=("$package")
    done
    if ((${#missing[@]})); then
        apt_install "${missing[@]}" || return 1
    fi
    mkdir -p "$root/build"
    [ "$noted" -nt "$dpkg_status" ] || : >"$noted"
    printf '%s\n' "$*" >>"$noted"
}

# apt_install PACKAGE...: as root or by sudo.
apt_install() {
    local as_root=() log
    if ((EUID != 0)); then
        command -v sudo >/dev/null || {
            say "These packages are missing, and neither root nor sudo is there: $*"
            return 1
        }
        as_root=(sudo)
    fi
    say "Installing $# packages: $*"
    log=$(mktemp)
    {
        "${as_root[@]}" apt-get update -qq &&
            "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
                apt-get install -y -qq --no-install-recommends "$@"
    } >"$log" 2>&1 || {
        tail -n 20 "$log" >&2
        say "apt could not install them; the log is $log"
        return 1
    }
    rm -f "$log"
}

build_sources=(CMakeLists.txt CMakePresets.json package.xml cmake include src tests/core tests/benchmark tests/fuzz/native
    Resources/translations) # what a build reads; folders tell of files that are gone

# build_stale STAMP: whether a build that began when STAMP was made is missing or too old. By the time
# of each change of a file (ctime), which a restored or copied file cannot carry along.
build_stale() {
    local stamp=$1 source sources=()
    if [ ! -f "$stamp" ] || [ "$dpkg_status" -nt "$stamp" ] || [ ! -f "$build/build.ninja" ] ||
        ! compgen -G "$build/python/beltgrinding_core*.so" >/dev/null; then
        return 0
    fi
    for source in "${build_sources[@]}"; do
        [ ! -e "$root/$source" ] || sources+=("$root/$source")
    done
    [ -n "$(find "${sources[@]}" -newercm "$stamp" -print -quit)" ]
}

# build_all [TARGET]: brings the release build, or a target of it, up to date. Neither CMake nor Ninja is
# started when nothing changed since the last time; of several at once one builds and the others wait.
build_all() {
    local target=${1:-all}
    local stamps=$root/build/stamps lock status=0
    if ! build_stale "$stamps/all" || ! build_stale "$stamps/$target"; then
        return 0
    fi
    mkdir -p "$stamps"
    exec {lock}>"$root/build/lock"
    flock -n "$lock" || {
        say "Waiting for another build"
        flock "$lock"
    }
    if build_stale "$stamps/all" && build_stale "$stamps/$target"; then
        build_now "$target" "$stamps" || status=$?
    fi
    exec {lock}>&-
    return "$status"
}

# build_now TARGET STAMPS: configures where that is needed, then lets Ninja decide what is stale. Each
# build has a log of its own in build/logs; build/build.log is a link to the last one.
build_now() {
    local target=$1 stamps=$2 logs=$root/build/logs log
    log=$logs/$(date +%Y%m%d-%H%M%S)-$$-$target.log
    mkdir -p "$logs"
    ls -t "$logs" | tail -n +20 | while read -r old; do rm -f "$logs/$old"; done
    ln -sfn "logs/${log##*/}" "$root/build/build.log"
    : >"$stamps/.$target" # as old as the build's begin: what changes meanwhile is built the next time
    if [ ! -f "$build/build.ninja" ]; then
        say "Configuring the build"
        (cd "$root" && cmake --preset release) >"$log" 2>&1 || {
            grep -A 6 'CMake Error' "$log" | head -n 20 >&2
            say "It could not be configured; the log is $log"
            return 1
        }
    fi
    say "Building (log: build/build.log)"
    (cd "$root" && cmake --build --preset release --target "$target") >>"$log" 2>&1 || {
        grep -E 'error|FAILED' "$log" | head -n 20 >&2
        say "The build failed; the log is $log"
        return 1
    }
    mv "$stamps/.$target" "$stamps/$target"
}

# in_freecad freecad|freecadcmd SCRIPT [NAME=VALUE...]: runs a Python file inside FreeCAD, without a
# display and with settings of its own; its status is the script's.
in_freecad() {
    local program=$1 script=$2 home status=0
    shift 2
    home=$(mktemp -d)
    local command=("$program" "$root/tools/in_freecad.py")
    [ "$program" = freecadcmd ] ||
        command=(xvfb-run -a -s "-screen 0 1600x1000x24" "${command[@]}")
    env HOME="$home" BELTGRINDING_RUN="$script" "$@" "${command[@]}" </dev/null || status=$?
    rm -rf "$home"
    return "$status"
}
