#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# A cluster of two nodes on this machine, by Slurm (slurmd -N), two ranks on each: the batch script of docs/cluster.md goes through three jobs
# of one run, and its numbers are those of one job.  Usage: slurm.sh REPO BIN, as root
set -euo pipefail
repo=$(realpath "$1")
bin=$(realpath "$2")
[ "$(id -u)" = 0 ] || { echo "slurm: needs root, for its daemons" >&2; exit 4; }
folder=$(mktemp -d)
own_munge=
ended() {
  scancel --full --user root 2> /dev/null || true
  pkill -F "$folder/n1.pid" 2> /dev/null || true
  pkill -F "$folder/n2.pid" 2> /dev/null || true
  pkill -F "$folder/control.pid" 2> /dev/null || true
  [ -z "$own_munge" ] || runuser -u munge -- /usr/sbin/munged --stop || true  # mpirun waits two seconds for a socket that nobody serves
  sleep 1
  rm -rf "$folder"
}
trap ended EXIT
fail() { echo "slurm: $*" >&2; cat "$folder"/work/slurm-*.out >&2; tail -n 3 "$folder"/*.log "$folder"/work/slurm-*.out >&2 || true; exit 1; }

# ---- the cluster
install -d -o munge -g munge /run/munge
pgrep -x munged > /dev/null || { runuser -u munge -- /usr/sbin/munged; own_munge=yes; }
mkdir "$folder"/{state,n1,n2,work}
export SLURM_CONF=$folder/slurm.conf
host=$(hostname -s)
cat > "$SLURM_CONF" << END
ClusterName=hilo
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=16817
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/%n
SlurmctldPidFile=$folder/control.pid
SlurmdPidFile=$folder/%n.pid
SlurmctldLogFile=$folder/control.log
SlurmdLogFile=$folder/%n.log
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=16818 CPUs=2
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=16819 CPUs=2
PartitionName=all Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP
END
slurmctld
slurmd -N n1
slurmd -N n2
for _ in $(seq 30); do [ "$(sinfo --noheader --states=idle --format=%D)" = 2 ] && break; sleep 1; done
[ "$(sinfo --noheader --states=idle --format=%D)" = 2 ] || fail "no two idle nodes"

# ---- the run: by one job, and by the script of the page, whose limits are cut so that it takes three
cd "$folder/work"
export PATH=$bin:$PATH OPENBLAS_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
export OMPI_MCA_btl=self,tcp OMPI_MCA_btl_tcp_if_include=lo  # two nodes of one host name would share memory that is not theirs
export PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe
export OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_hwloc_base_binding_policy=none PRTE_MCA_hwloc_default_binding_policy=none
cp "$repo"/data/turret/scene.toml .
hilo-import --quiet --trust "$repo/data/turret/turret.geo" -o mesh.h5 --define SIZE=0
hilo-tag --quiet mesh.h5 "$repo/data/turret/tags-flexible.toml" -o tags.h5
sed -i 's/^end = .*/end = 0.2/' scene.toml
awk '/^```sh$/ {on = 1; text = ""; next} /^```$/ {if (on && text ~ /SBATCH/) printf "%s", text; on = 0} on {text = text $0 "\n"}' "$repo/docs/cluster.md" > page.sh
grep -q 'nodes=4 --ntasks=64' page.sh || fail "the page has no batch script that asks for 4 nodes and 64 tasks"
sed -i 's/nodes=4 --ntasks=64/nodes=2 --ntasks=4/' page.sh
sed 's/-o run.h5/-o alone.h5/g; s/run\./alone./g; s/--time-limit [0-9hms]*//; /sbatch/d' page.sh > alone.sh
began=$SECONDS
sbatch --wait --output=slurm-alone.out alone.sh > /dev/null || fail "the run by one job ended with $?"
took=$((SECONDS - began))
for share in 40 20 10; do  # percent: other work may have slowed that one
  limit=$((took * share / 100 + 1))s
  rm -f slurm-[0-9]*.out run.*
  sed "s/3h50m/$limit/; s/page\.sh/limited.sh/" page.sh > limited.sh
  sbatch limited.sh > /dev/null
  for _ in $(seq 300); do [ -z "$(squeue --noheader)" ] && break; sleep 1; done
  jobs=$(ls slurm-[0-9]*.out | wc -l)
  echo "slurm: one job took $took s; with a limit of $limit the run took $jobs jobs"
  [ "$jobs" -lt 3 ] || break
done
[ "$jobs" -ge 3 ] || fail "it took $jobs jobs, not three or more"
/usr/bin/python3 - << 'END' || fail "the numbers differ"
import json
import h5py
import numpy as np

assert json.load(open("run.json"))["complete"] and json.load(open("alone.json"))["complete"]
worst = 0.0
with h5py.File("run.h5") as run, h5py.File("alone.h5") as alone:
    def compare(name, mine):
        global worst
        if isinstance(mine, h5py.Dataset) and mine.dtype.kind == "f":
            its = alone["history/" + name][:]
            assert mine.shape == its.shape, name
            size = np.abs(its).max()
            if name.split("/")[0] in ("body", "probe", "joint", "t", "sensor") and size > 0:
                worst = max(worst, np.abs(mine[:] - its).max() / size)
    run["history"].visititems(compare)
print(f"slurm: histories of bodies, probes, sensors and joints differ by {worst:.1e} of their largest value")
assert worst < 1e-6
END
