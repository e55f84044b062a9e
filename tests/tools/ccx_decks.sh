#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Imports every deck of the Debian package calculix-ccx-test and writes the table docs/ccx-decks.md.
#   tests/tools/ccx_decks.sh [folder of hilo-import] [file to write]
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
bin=${1:-$root/build/bin}
out=${2:-$root/docs/ccx-decks.md}
decks=/usr/share/doc/calculix-ccx-test/examples/test
[ -d "$decks" ] || { echo "ccx_decks.sh: no $decks (apt-get install calculix-ccx-test)" >&2; exit 4; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$decks"/*.inp "$decks"/*.inp.gz "$work"
cd "$work"
gunzip -f ./*.gz
imported=0 refused=0
for deck in *.inp; do
  name=${deck%.inp}
  if "$bin/hilo-import" "$deck" -o "$name.h5" --json >"$name.json" 2>"$name.err"; then
    row=$(/usr/bin/python3 -c '
import json, sys
d = json.load(open(sys.argv[1]))
shapes = {}
for r in d["regions"]:
    for s, n in r["shapes"].items():
        shapes[s] = shapes.get(s, 0) + n
left = [n["what"] for n in d["not_read"] if not n["output"]]
print(len(d["regions"]), ", ".join(f"{n} {s}" for s, n in shapes.items()), d["nodes"], ", ".join(left) or "-", sep=" | ")' "$name.json")
    echo "| $name | $row |" >>imported.md
    imported=$((imported + 1))
  else
    code=$?
    # 2 is the only way to say no; anything else, or a file left behind, is our fault
    [ $code -eq 2 ] && [ ! -e "$name.h5" ] || { echo "ccx_decks.sh: $deck: exit $code" >&2; cat "$name.err" >&2; exit 5; }
    echo "| $name | $(head -1 "$name.err" | sed 's/^hilo-import: //; s/|/\\|/g') |" >>refused.md
    refused=$((refused + 1))
  fi
done
{
  echo "# The decks of calculix-ccx-test"
  echo
  echo "Every .inp file of the Debian package calculix-ccx-test through hilo-import, as written by \`tests/tools/ccx_decks.sh\`:"
  echo "$imported import, $refused are refused.  \"Not read\" lists what the deck says beyond mesh, materials, supports and loads; requests"
  echo "for output are not listed."
  echo
  echo "## Imported"
  echo
  echo "| deck | regions | cells | nodes | not read |"
  echo "|------|---------|-------|-------|----------|"
  cat imported.md
  echo
  echo "## Refused"
  echo
  echo "| deck | reason |"
  echo "|------|--------|"
  cat refused.md
} >"$out.tmp"
mv "$out.tmp" "$out"
echo "$imported imported, $refused refused" >&2
