# SPDX-License-Identifier: GPL-3.0-or-later
# What every scene's Makefile needs: the tools, built once into build/, and the environment they run in.
ROOT := $(patsubst %/data/common.mk,%,$(realpath $(lastword $(MAKEFILE_LIST))))
BUILD ?= $(ROOT)/build
BIN := $(BUILD)/bin
# Beside installed tools (hilo_VERSION_amd64.deb: cp -r /usr/share/hilo ~/hilo && make -C ~/hilo/data/firing) there is nothing to build.
ifeq ($(wildcard $(ROOT)/CMakeLists.txt),)
BIN := $(patsubst %/,%,$(dir $(shell command -v hilo-solve)))
BUILT := 1
endif
TOOLS := hilo-import hilo-tag hilo-part hilo-reduce hilo-solve hilo-advise hilo-post hilo-show
SHELL := /bin/bash
.SHELLFLAGS := -eu -o pipefail -c
.DELETE_ON_ERROR:

export OMPI_ALLOW_RUN_AS_ROOT := 1
export OMPI_ALLOW_RUN_AS_ROOT_CONFIRM := 1
export OMPI_MCA_mpi_yield_when_idle := 1
# more ranks than cores, bound to none: Open MPI 4 and 5
export OMPI_MCA_rmaps_base_oversubscribe := 1
export PRTE_MCA_rmaps_default_mapping_policy := :oversubscribe
export OMPI_MCA_hwloc_base_binding_policy := none
export PRTE_MCA_hwloc_default_binding_policy := none
# Open MPI 5.0.7 complains of every rank on a machine with IPv6 (open-mpi/ompi, issue 14079)
export OMPI_MCA_btl_tcp_disable_family := 6
export OPENBLAS_NUM_THREADS := 1
export PYTHONDONTWRITEBYTECODE := 1

.DEFAULT_GOAL := all
.PHONY: all build setup
ifeq ($(wildcard $(ROOT)/CMakeLists.txt),)
setup build:
else
setup:
	@$(ROOT)/.setup

# Ninja itself finds out that there is nothing to do; it takes as many jobs as make -jN says, or one for each core.
build: setup
	@[ -f $(BUILD)/build.ninja ] || cmake -S $(ROOT) -B $(BUILD) -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON > $(BUILD).log 2>&1 || { cat $(BUILD).log; exit 1; }
	@cmake --build $(BUILD) $(filter -j%,$(MAKEFLAGS)) --target $(TOOLS) hilo-petsc
endif

# A tool that was rebuilt redoes what it made.  `make -n` takes the tools as they are; so does who says BUILT=1, having built them.
ifeq ($(findstring n,$(firstword -$(MAKEFLAGS)))$(BUILT),)
$(TOOLS:%=$(BIN)/%): build ;
else
$(TOOLS:%=$(BIN)/%): ;
endif
