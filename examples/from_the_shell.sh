#!/bin/sh
# From an empty folder to a mission carried out: what it writes is in a folder that it names.
set -eu
folder=$(mktemp -d)
cd "$folder"
muster init harbour
muster check harbour.yaml
muster solve harbour.yaml --iterations 1000 --seed 1 -o plan.json
muster verify harbour.yaml plan.json
muster simulate harbour.yaml --plan plan.json
echo "written: $folder"
