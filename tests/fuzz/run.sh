#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds the readers with clang's libFuzzer, address and undefined-behaviour sanitizers, and feeds each for SECONDS, one after the other,
# beginning with the repository's own files and what was found before.  A finding lies in FOLDER/found/NAME-..., smaller ones are looked for.
# BIN has tools as they are for use: they make meshes to begin with.
# Usage: run.sh REPO BIN FOLDER SECONDS [READER ...]      make -C tests fuzz
set -euo pipefail
repo=$(realpath "$1") bin=$(realpath "$2") folder=$(realpath -m "$3") seconds=$4
shift 4
[ -n "${BUILT:-}" ] || cmake -S "$repo" -B "$folder" -G Ninja -DCMAKE_C_COMPILER=clang-19 -DCMAKE_CXX_COMPILER=clang++-19 -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1 -fno-omit-frame-pointer -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined -Wno-error -w" \
  > "$folder.log" || { cat "$folder.log"; exit 1; }
[ -n "${BUILT:-}" ] || cmake --build "$folder" --target fuzz
fuzz=$folder/bin/fuzz
mkdir -p "$folder/found"
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=0:alloc_dealloc_mismatch=0
[ $# -gt 0 ] || mapfile -t all < <("$fuzz")
[ $# -gt 0 ] && all=("$@")

# Seeds: what the repository has, and meshes that the tools make of it.
seeds=$folder/seeds
if [ ! -d "$seeds" ]; then
  "$repo/tests/fuzz/seeds.py" "$repo" "$bin" "$seeds"
fi
failed=0
for reader in "${all[@]}"; do
  mkdir -p "$folder/corpus/$reader"
  find "$repo/tests/faults/corpus" -name "$reader-*" -exec cp -t "$seeds/$reader" {} + 2> /dev/null || true
  words=()
  [ -e "$repo/tests/fuzz/$reader.dict" ] && words=(-dict="$repo/tests/fuzz/$reader.dict")
  log=$folder/$reader.log limit=10
  [ "$reader" != store ] || limit=90  # the child that walks through a file has 60 s (solver/model/store_guard.cpp)
  if HILO_FUZZ=$reader "$fuzz" -max_total_time="$seconds" -timeout=$limit -rss_limit_mb=2500 -malloc_limit_mb=1000 -max_len=16384 -use_value_profile=1 \
    -artifact_prefix="$folder/found/$reader-" "${words[@]}" "$folder/corpus/$reader" "$seeds/$reader" > "$log" 2>&1; then
    echo "$reader: $(grep -oE '^Done [0-9]+ runs in [0-9]+ second' "$log")s, $(grep -oE 'cov: [0-9]+' "$log" | tail -1), nothing found"
  else
    failed=1
    echo "$reader: FOUND $(grep -oE "$folder/found/[^ ;]+" "$log" | tail -1): $(grep -E 'ERROR: |runtime error|^[a-z]+: ' "$log" | head -2 | tr '\n' ' ')"
  fi
done
exit $failed
