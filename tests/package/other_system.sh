#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# hilo built and tested on another Debian: a bare folder by debootstrap, the packages of .setup, the working tree of REPO, `make -C tests`.
# What was made there stays, so that a second run compiles only what changed.  Prints a table: versions, units, tests, and what failed.
# Usage, as root: other_system.sh REPO SUITE FOLDER [REGEX of tests]        make -C tests other-system SUITE=trixie
set -euo pipefail
repo=$(realpath "$1") suite=$2 root=$(realpath -m "$3") only=${4:-.}
if [ -z "${INSIDE:-}" ]; then  # mounts of its own, which end with it
  [ "$(id -u)" = 0 ] || { echo "other-system: needs root, for debootstrap and chroot" >&2; exit 4; }
  INSIDE=1 exec unshare --mount "$0" "$repo" "$suite" "$root" "$only"
fi
log=$root/root/other-system
if [ ! -e "$root/etc/debian_version" ]; then
  mkdir -p "$root"
  debootstrap --variant=minbase "$suite" "$root" > "$root.log" || { tail "$root.log"; exit 4; }
fi
mkdir -p "$log" "$root/hilo"
mount --make-rprivate /
for system in proc sys dev; do mount --rbind "/$system" "$root/$system"; done
cp /etc/resolv.conf "$root/etc/resolv.conf"
printf '#!/bin/sh\nexit 101\n' > "$root/usr/sbin/policy-rc.d"  # no package starts a service
chmod +x "$root/usr/sbin/policy-rc.d"
(cd "$repo" && git ls-files -z | tar --null -T - -c) | tar -x -C "$root/hilo"  # with its times: only what changed is built again
inside() { chroot "$root" env DEBIAN_FRONTEND=noninteractive LC_ALL=C HOME=/root nice -n 10 bash -c "cd /hilo && $1"; }
inside 'command -v make git > /dev/null || { apt-get update -q && apt-get install -y -q --no-install-recommends make git; }' > "$log/make.log" 2>&1
began=$SECONDS failed=0
inside "make -C tests built" > "$log/build.log" 2>&1 || failed=1
built=$((SECONDS - began))
inside "ctest --test-dir build -j2 --output-on-failure -R '$only'" > "$log/test.log" 2>&1 || failed=1
row() { printf '%-10s %s\n' "$1" "$2"; }
version() { inside "dpkg-query -W -f '\${Version}' $1"; }
row Debian "$(cat "$root/etc/debian_version") ($suite)"
for of in gcc:g++ Eigen:libeigen3-dev VTK:libvtk9-dev HDF5:libhdf5-openmpi-dev "Open MPI:libopenmpi-dev" PETSc:libpetsc-real-dev gmsh:libgmsh-dev; do
  row "${of%%:*}" "$(version "${of##*:}")"
done
row build "$(grep -c '^FAILED' "$log/build.log" || true) units refused, $((built / 60)) minutes"
row tests "$(grep -E 'tests passed' "$log/test.log" || echo "none ran")"
sed -n '/tests FAILED/,$p' "$log/test.log"
grep -E 'error:' "$log/build.log" | sort -u | head -n 40 || true
exit "$failed"
