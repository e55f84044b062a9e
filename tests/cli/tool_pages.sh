#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The pages of docs/tools are what the tools say of themselves today, and there is one for each.  Usage: tool_pages.sh REPO BIN
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$1/docs/tools/write.sh" "$2" "$folder"
[ -s "$folder/hilo-post.md" ] || { echo "tool_pages: no page was written" >&2; exit 1; }
mkdir "$folder/kept"
cp "$1"/docs/tools/*.md "$folder/kept"
mkdir "$folder/fresh"
mv "$folder"/*.md "$folder/fresh"
for commands in "$1"/docs/tools/hilo-*/; do cp -r "$commands" "$folder/kept"; done
for commands in "$folder"/hilo-*/; do mv "$commands" "$folder/fresh"; done
diff -ru "$folder/kept" "$folder/fresh" || { echo "tool_pages: run docs/tools/write.sh $2" >&2; exit 1; }
