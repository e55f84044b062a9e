#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Writes the page of every tool from its own table of options.  Usage: docs/tools/write.sh [BIN [FOLDER]]
set -euo pipefail
here=$(dirname "$(realpath "$0")")
bin=$(realpath "${1:-$here/../../build/bin}")
folder=${2:-$here}
for tool in "$bin"/hilo-*; do
  [ -f "$tool" ] && [ -x "$tool" ] && "$tool" --markdown > "$folder/${tool##*/}.md"
done
