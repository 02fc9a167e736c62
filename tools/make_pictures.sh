#!/usr/bin/env bash
# Runs scenes and writes the picture of each: tools/make_pictures.sh [scene ...], all of them without names, and those of the tutorials then.
set -euo pipefail
cd "$(dirname "$0")/.."
[ -x build/talus ] || { echo "build/talus is missing: make build" >&2; exit 3; }

scenes=("$@")
[ ${#scenes[@]} -gt 0 ] || mapfile -t scenes < <(find scenes -mindepth 1 -maxdepth 1 -type d -printf '%f\n' | sort)
for name in "${scenes[@]}"; do
  build/talus run "scenes/$name/scene.yaml" --out "runs/$name"
  frame=last
  [ "$name" = cantilever ] && frame=14  # t = 0.7 s, its lowest point; at the end it is back up
  build/talus render "runs/$name" --frames "$frame" --size 900x420 --out "scenes/$name/picture.png"
  if [ "$name" = slope_failure_3d ]; then cp "scenes/$name/picture.png" docs/images/slope_failure_3d.png; fi
done
if [ $# -eq 0 ]; then tools/run_tutorials.py build/talus --pictures; fi
