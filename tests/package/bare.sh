#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The packages of BUILD on a bare Debian of this machine's release: apt installs them, an ordinary user runs the whole tour without the source
# tree, and a program is built on the libraries.  Prints what the packages bring along, beside what the build needs.
# The bare system is made once in FOLDER, by debootstrap, and stays bare: what a test does lies in a layer above it.
# Usage, as root: bare.sh REPO BUILD FOLDER        make -C tests package
set -euo pipefail
repo=$(realpath "$1") build=$(realpath "$2") folder=$(realpath -m "$3")
if [ -z "${INSIDE:-}" ]; then  # mounts of its own, which end with it
  [ "$(id -u)" = 0 ] || { echo "bare: needs root, for debootstrap and chroot" >&2; exit 4; }
  INSIDE=1 exec unshare --mount "$0" "$repo" "$build" "$folder"
fi
base=$folder/base root=$folder/root
if [ ! -e "$folder/done" ]; then
  rm -rf "$base"
  mkdir -p "$base"
  debootstrap --variant=minbase "$(. /etc/os-release; echo "$VERSION_CODENAME")" "$base" > "$folder/debootstrap.log" || { tail "$folder/debootstrap.log"; exit 4; }
  touch "$folder/done"
fi
rm -rf "$folder/upper" "$folder/work"
mkdir -p "$folder/upper" "$folder/work" "$root"
mount -t overlay overlay -o "lowerdir=$base,upperdir=$folder/upper,workdir=$folder/work" "$root"
for system in proc sys dev; do mount --rbind "/$system" "$root/$system"; done
cp /etc/resolv.conf "$root/etc/resolv.conf"
printf '#!/bin/sh\nexit 101\n' > "$root/usr/sbin/policy-rc.d"  # no package starts a service
chmod +x "$root/usr/sbin/policy-rc.d"
mkdir -p "$root/packages"
for package in hilo hilo-post hilo-dev; do cp "$build/${package}"_*.deb "$root/packages/$package.deb"; done
cp -r "$repo/tests/library" "$root/packages"

inside() { chroot "$root" env DEBIAN_FRONTEND=noninteractive LC_ALL=C "$@"; }
install() { inside apt-get install -y -q --no-install-recommends -o Dpkg::Options::=--force-unsafe-io "$@"; }
# packages, megabytes to fetch (those of hilo lie here), megabytes on disk
needs() {
  local said
  said=$(inside apt-get install --no-install-recommends --assume-no "${@:2}" || true)
  echo "$1: $(grep -oE '[0-9]+ newly installed' <<< "$said"), $(grep -oE '(Need to get .* of archives|[0-9.]+ [kMG]?B of additional)' <<< "$said" | tr '\n' ' ')"
}
inside apt-get update -q > "$folder/apt.log"
needs "hilo" /packages/hilo.deb
needs "hilo with hilo-post" /packages/hilo.deb /packages/hilo-post.deb
# shellcheck disable=SC2046
needs "what the build needs" $(sed -n '/^packages=/,/"$/p' "$repo/.setup" | tr -d '"' | sed 's/packages=//')
install make /packages/hilo.deb /packages/hilo-post.deb >> "$folder/apt.log" 2>&1 || { tail -n 30 "$folder/apt.log"; exit 1; }

inside useradd --create-home guest
as_guest() { inside su - guest -c "$1"; }
[ ! -e "$root$repo" ] || { echo "bare: the source tree is there" >&2; exit 1; }
as_guest 'hilo-solve --version'
for package in hilo hilo-post; do as_guest "grep -q '^License: GPL-3+' /usr/share/doc/$package/copyright"; done
for tool in import tag part reduce solve show post; do
  as_guest "zcat /usr/share/man/man1/hilo-$tool.1.gz | grep -q '^.SH EXIT STATUS' && bash -n /usr/share/bash-completion/completions/hilo-$tool"
done
as_guest 'cp -r /usr/share/hilo . && make -C hilo/data/tour' > "$folder/tour.log" 2>&1 || { tail -n 30 "$folder/tour.log"; exit 1; }
for file in model.png stress.png run.h5 run.mp4 moment.png two.png run-2.h5; do
  [ -s "$root/home/guest/hilo/data/tour/out/$file" ] || { echo "bare: the tour made no $file" >&2; exit 1; }
done
as_guest 'hilo-show --check hilo/data/tour/out/run.h5'
as_guest 'hilo-solve --quiet hilo/data/tour/out/scene.toml hilo/data/tour/out/tags.h5 --set "solver.kind=\"direct\"" --set time.end=0.01 -o direct.h5'
echo "the tour: done"
install g++ cmake /packages/hilo-dev.deb >> "$folder/apt.log" 2>&1 || { tail -n 30 "$folder/apt.log"; exit 1; }
as_guest 'cp -r /packages/library . && { cmake -S library -B made && cmake --build made; } > library.log && made/pendulum && made/own_material' || { tail -n 30 "$root/home/guest/library.log"; exit 1; }
