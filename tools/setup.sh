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

packages_build=(g++ cmake ninja-build ccache libeigen3-dev pybind11-dev python3-dev libtbb-dev
    libocct-foundation-dev libocct-modeling-data-dev libocct-modeling-algorithms-dev
    libocct-data-exchange-dev libocct-ocaf-dev libembree-dev libhdf5-dev
    libcoin-dev libgl-dev qttools5-dev-tools
    libassimp-dev libfcl-dev libsvm-dev python3-pythran libgtest-dev libbenchmark-dev
    libfontconfig-dev) # OpenCASCADE 7.8 names it among its own libraries, and its package does not
packages_scan=(libpcl-dev) # aligning scans; large, and not needed for anything else
packages_run=(freecad python3-numpy python3-jsonschema python3-matplotlib xvfb xauth libgl1-mesa-dri)
packages_test=(weasyprint poppler-utils python3-pytest python3-h5py python3-pil calculix-ccx cloudcompare)

say() { printf '%s\n' "$*" >&2; }

# install_missing PACKAGE...: by apt, only what dpkg does not have.
install_missing() {
    command -v dpkg-query >/dev/null || {
        say "This set-up knows Debian's apt only; install yourself: $*"
        return 1
    }
    local missing=() package
    for package in "$@"; do
        dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed ||
            missing+=("$package")
    done
    ((${#missing[@]})) || return 0
    local as_root=()
    if ((EUID != 0)); then
        command -v sudo >/dev/null || {
            say "These packages are missing, and neither root nor sudo is there: ${missing[*]}"
            return 1
        }
        as_root=(sudo)
    fi
    say "Installing ${#missing[@]} packages: ${missing[*]}"
    local log
    log=$(mktemp)
    {
        "${as_root[@]}" apt-get update -qq &&
            "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
                apt-get install -y -qq --no-install-recommends "${missing[@]}"
    } >"$log" 2>&1 || {
        tail -n 20 "$log" >&2
        say "apt could not install them; the log is $log"
        return 1
    }
    rm -f "$log"
}

# build_all [TARGET]: configures once, then lets Ninja decide what is stale.
build_all() {
    local log=$root/build/build.log
    mkdir -p "$root/build"
    local late= # what was installed since the build was configured
    if compgen -G '/usr/lib/*/cmake/pcl/PCLConfig.cmake' >/dev/null; then
        grep -qs '^PCL_DIR:PATH=/' "$build/CMakeCache.txt" || late=PCL
    fi
    if [ ! -f "$build/build.ninja" ] || [ -n "$late" ]; then
        say "Configuring the build"
        (cd "$root" && cmake --preset release) >"$log" 2>&1 || {
            grep -A 6 'CMake Error' "$log" | head -n 20 >&2
            say "It could not be configured; the log is $log"
            return 1
        }
    fi
    say "Building (log: build/build.log)"
    (cd "$root" && cmake --build --preset release ${1:+--target "$1"}) >"$log" 2>&1 || {
        grep -E 'error|FAILED' "$log" | head -n 20 >&2
        say "The build failed; the log is $log"
        return 1
    }
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
