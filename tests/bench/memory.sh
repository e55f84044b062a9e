#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Peak memory of every rank on the vehicle, size M, two steps from equilibrium, default solver:  tests/bench/memory.sh BIN [RANKS] [--set ...]
set -eu
bin=$(realpath "$1"); ranks=${2:-4}; shift; shift || true
scene=$(realpath "$(dirname "$0")/../../data/firing")
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_mpi_yield_when_idle=1
export PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe
export OMPI_MCA_hwloc_base_binding_policy=none PRTE_MCA_hwloc_default_binding_policy=none OPENBLAS_NUM_THREADS=1
"$bin/hilo-import" "$scene/vehicle.geo" -o "$folder/mesh.h5" --define SIZE=1 > "$folder/log"
"$bin/hilo-tag" "$folder/mesh.h5" "$scene/../scaling/tags.toml" -o "$folder/tags.h5" >> "$folder/log"
"$bin/hilo-part" "$folder/tags.h5" "$scene/scene.toml" -n "$ranks" -o "$folder/parts.h5" >> "$folder/log"
peak() { sed -n 's/.*"peak_memory_bytes": \([0-9]*\),.*/\1/p' "$1"; }
options=(--quiet --set time.end=0.0005 --set output.interval=0.0005 "$@")
cd "$scene"
"$bin/hilo-solve" scene.toml "$folder/tags.h5" -o "$folder/run-1.h5" "${options[@]}"
mpirun -n "$ranks" "$bin/hilo-solve" scene.toml "$folder/parts.h5" -o "$folder/run-n.h5" "${options[@]}"
one=$(peak "$folder/run-1.json"); many=$(peak "$folder/run-n.json")
for f in 1 n; do sed -n 's/ *"solver": "\(.*\)",/\1/p' "$folder/run-$f.json"; done
awk -v a="$one" -v b="$many" -v n="$ranks" 'BEGIN { printf "serial %.0f MB, largest of %d ranks %.0f MB: %.3f\n", a / 1e6, n, b / 1e6, b / a }'
