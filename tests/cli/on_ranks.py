# SPDX-License-Identifier: GPL-3.0-or-later
"""The environment in which mpirun starts ranks as root, on fewer cores than ranks and bound to none, by Open MPI 4 (OMPI_MCA_) and 5 (PRTE_MCA_).
Without IPv6: Open MPI 5.0.7 complains of every rank on a machine that has it (open-mpi/ompi, issue 14079)."""
import os

ENVIRONMENT = dict(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_mpi_yield_when_idle="1",
                   OMPI_MCA_rmaps_base_oversubscribe="1", PRTE_MCA_rmaps_default_mapping_policy=":oversubscribe",
                   OMPI_MCA_hwloc_base_binding_policy="none", PRTE_MCA_hwloc_default_binding_policy="none",
                   OMPI_MCA_btl_tcp_disable_family="6", OPENBLAS_NUM_THREADS="1")


def use(tools=None):
    """What this process starts from now on has this environment, with the folder `tools` first in its path."""
    os.environ.update(ENVIRONMENT)
    if tools:
        os.environ["PATH"] = tools + ":" + os.environ["PATH"]
