#!/usr/bin/env bash
# Called by conda-build. Not run here.
set -euo pipefail
mod=$PREFIX/Mod/BeltGrinding # the system's Mod folder of conda-forge's FreeCAD
pocketfft=$(find "$PREFIX" -path '*pythran/pythonic/numpy/fft/pocketfft.hpp' | head -n 1)
cmake -S . -B build/conda -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$PREFIX" \
    -DCMAKE_INSTALL_PREFIX="$PREFIX" -DPython_EXECUTABLE="$PYTHON" -DPOCKETFFT_INCLUDE_DIR="${pocketfft%/*}" \
    -DBELTGRINDING_MOD_DIR="$mod" -DBELTGRINDING_WORKBENCH=ON -DBELTGRINDING_TESTS=OFF -DBELTGRINDING_BENCHMARKS=OFF
cmake --build build/conda
cmake --install build/conda
ln -s "$mod/beltgrinding" "$SP_DIR/beltgrinding"
printf '#!/bin/sh\nexec "%s/bin/python" "%s/beltgrind.py" "$@"\n' "$PREFIX" "$mod" >"$PREFIX/bin/beltgrind"
chmod +x "$PREFIX/bin/beltgrind"
