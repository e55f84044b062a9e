#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Every tool on an emulated processor without AVX (and so without AVX-512): none may meet an instruction that it does not have, and results
# are those of this machine's processor but for rounding.  Usage: old_processor.sh BIN
set -euo pipefail
bin=$(realpath "$1")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cat > bar.geo <<'END'
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 0.1, 0.1};
Physical Volume("bar") = {1};
Physical Surface("root") = Surface In BoundingBox {-0.01, -0.01, -0.01, 0.01, 0.11, 0.11};
Physical Surface("tip") = Surface In BoundingBox {0.99, -0.01, -0.01, 1.01, 0.11, 0.11};
END
cat > scene.toml <<'END'
gravity = [0, 0, -9.81]
[material.steel]
E = 205e9
nu = 0.29
density = 7850
[region.bar]
material = "steel"
[[joint]]
kind = "fixed"
name = "wall"
b = "root"
at = [0, 0.05, 0.05]
[[probe]]
name = "tip"
on = "tip"
[time]
end = 2e-3
step = 1e-4
END
run() { timeout 600 "$@" > log 2>&1 || { echo "old_processor: exit $?: $*" >&2; cat log >&2; exit 1; }; }
old() { run qemu-x86_64 -cpu Nehalem "$bin/$@"; }
old hilo-import bar.geo --size 0.1 -o mesh.h5
old hilo-tag mesh.h5 --nonlinear bar -o tags.h5
old hilo-part tags.h5 -n 2 -o parts-2.h5
old hilo-show --check mesh.h5
old hilo-tag mesh.h5 --linear bar -o linear.h5
old hilo-reduce scene.toml linear.h5 -o reduced.h5
for solver in light direct; do
  old hilo-solve scene.toml tags.h5 --set "solver.kind=\"$solver\"" -o "old-$solver.h5"
  run "$bin/hilo-solve" scene.toml tags.h5 --set "solver.kind=\"$solver\"" -o "new-$solver.h5"
  for age in old new; do run "$bin/hilo-post" series "$age-$solver.h5" probe.tip.z -o "$age.csv"; done
  paste -d, old.csv new.csv | awk -F, -v kind=$solver 'NR > 1 {d = $2 - $4; if (d < 0) d = -d; if (d > worst) worst = d; n = $4 - 0.05; if (n < 0) n = -n; if (n > size) size = n}
    END {printf "%s: %d instants, largest difference %.1e of %.1e m\n", kind, NR - 1, worst, size; exit !(NR > 20 && size > 0 && worst < 1e-8 * size)}'
done
old hilo-post series old-light.h5 probe.tip.z -o series.csv
echo "seven tools without AVX: done"
