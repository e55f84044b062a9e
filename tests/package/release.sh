#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What a release needs, but for the suite itself: version and docs/changes.md agree, the tree is clean, the pages hold, the reference has no
# warning, packages build, and lintian finds no error in them.  Usage: release.sh REPO BUILD      make -C tests release
set -euo pipefail
repo=$(realpath "$1") build=$(realpath "$2")
failed=0
item() { if [ "$2" = 0 ]; then echo "release: $1: done"; else echo "release: $1: NOT YET" >&2; failed=1; fi; }
version=$(sed -n 's/^project(hilo VERSION \([0-9.]*\).*/\1/p' "$repo/CMakeLists.txt")
grep -q "^## $version" "$repo/docs/changes.md" && code=0 || code=1
item "docs/changes.md has a section for $version" $code
! grep -rnE "hilo(-post|-dev)?_[0-9.]+_amd64" "$repo/docs" --include='*.md' | grep -v "_${version}_" && code=0 || code=1
item "pages name the packages of $version" $code
[ -z "$(git -C "$repo" status --porcelain 2> /dev/null)" ] && code=0 || code=1
item "the tree is clean" $code
"$repo/tests/cli/docs_words.py" "$repo" && code=0 || code=1
item "sentences and pages are short" $code
"$repo/tests/cli/docs_links.py" "$repo" "$build" > /dev/null && code=0 || code=1
item "links and commands of the pages are there" $code
make -s -C "$repo/docs" api BUILD="$build" > /dev/null && code=0 || code=1
item "the reference has no warning" $code
rm -f "$build"/hilo*.deb
cmake "$build" > "$build/release.log" && cmake --build "$build" --target hilo-import hilo-tag hilo-part hilo-reduce hilo-solve hilo-advise hilo-post hilo-show hilo-petsc hilo-dynamics \
  >> "$build/release.log" && (cd "$build" && cpack >> release.log) && code=0 || code=1
item "packages build ($(cd "$build" && echo hilo*.deb))" $code
lintian --fail-on error "$build"/hilo*_"$version"_amd64.deb > "$build/lintian.log" 2>&1 && code=0 || code=1
item "lintian finds no error ($build/lintian.log)" $code
exit $failed
