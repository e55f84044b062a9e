#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Builds hilo a second time, with address and undefined-behaviour sanitizers or as a release with assertions, and runs the whole suite and
# the scenes of data/ at size S on it.  Clean: every test passes, every scene runs, and no sanitizer has written a report.
# Usage: run.sh REPO FOLDER sanitizers|assertions [-j JOBS] [-R TESTS]      make -C tests sanitize
set -euo pipefail
repo=$(realpath "$1") folder=$(realpath -m "$2") kind=$3
shift 3
jobs=1 tests=.
while getopts j:R: option; do
  case $option in
    j) jobs=$OPTARG ;;
    R) tests=$OPTARG ;;
    *) exit 1 ;;
  esac
done
mkdir -p "$folder"
here=$repo/tests/sanitize
if [ "$kind" = sanitizers ]; then
  # Assertions on as well; of undefined behaviour all that is found is reported, not the first alone.  Eigen allocates as in libgmsh, which
  # takes its functions from the program.  Null, alignment, vptr and object-size would double the time of the build; what they see, other
  # than a call through a null pointer that reads nothing, is a fault of address too.
  cmake -S "$repo" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_UNITY_BUILD=ON \
    -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1 -fno-omit-frame-pointer -fsanitize=address,undefined -fno-sanitize=null,alignment,vptr,object-size \
      -DEIGEN_MALLOC_ALREADY_ALIGNED=1" > "$folder.log" || { cat "$folder.log"; exit 1; }
else
  cmake -S "$repo" -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DHILO_ASSERT=ON > "$folder.log" || { cat "$folder.log"; exit 1; }
fi
cmake --build "$folder" -j "$jobs"

# A report is a file, so that none is lost in a test that expects a failure; 99 is no exit code of hilo's.  Leaks leave the exit code as it
# is: Open MPI keeps memory in modules that are unloaded before the end and so have no names to suppress.  gmsh 4.8 deletes arrays of its
# own by the wrong operator (ClosureGen, prisms of second order), so that check is off; nothing of ours allocates arrays by new.
reports=$folder/reports
rm -rf "$reports"
mkdir -p "$reports"
export ASAN_OPTIONS="log_path=$reports/report:exitcode=99:detect_leaks=1:malloc_context_size=20:allocator_may_return_null=1:alloc_dealloc_mismatch=0:verify_asan_link_order=0"
export UBSAN_OPTIONS="log_path=$reports/report:print_stacktrace=1"
export LSAN_OPTIONS="suppressions=$here/leaks.txt:print_suppressions=0:exitcode=0"
failed=0
ctest --test-dir "$folder" -j "$jobs" -R "$tests" --output-on-failure --no-tests=error > "$folder/ctest.log" 2>&1 || failed=1
tail -n 40 "$folder/ctest.log"

# The scenes run in a copy of data/: what they made with the ordinary build stays.
if [ "$tests" = . ]; then
  rm -rf "$folder/data" "$folder/docs"
  tar -C "$repo" --exclude=out -cf - data docs | tar -C "$folder" -xf -
  for scene in tour crank firing suspension turret; do
    if make -C "$folder/data/$scene" BUILT=1 BUILD="$folder" ROOT="$repo" SIZE=S > "$folder/$scene.log" 2>&1; then
      echo "data/$scene: done"
    else
      echo "data/$scene: failed, see $folder/$scene.log"
      failed=1
    fi
  done
fi
# A leak is ours where a frame of it is a file of the repository.
grep -lr "ERROR: LeakSanitizer" "$reports" | while read -r report; do
  grep -qE "$repo/(solver|tools|post|tests)/" "$report" || grep -qE "ERROR: AddressSanitizer|runtime error" "$report" || rm "$report"
done || true
found=$(find "$reports" -type f | wc -l)
echo "$kind: $found reports in $reports"
find "$reports" -type f -exec grep -hE "ERROR: |runtime error: |SUMMARY: " {} + | sed -E 's/^==[0-9]+==//' | sort | uniq -c | sort -rn | head -n 40 || true
[ "$failed" = 0 ] && [ "$found" = 0 ]
