#!/usr/bin/env bash
# Runs scenes and writes the picture of each: tools/make_pictures.sh [scene ...], all of them without names, and those of the tutorials then; docs: those of pages in docs.
set -euo pipefail
cd "$(dirname "$0")/.."
[ -x build/talus ] || { echo "build/talus is missing: make build" >&2; exit 3; }

render() { build/talus render "runs/$1" --size 900x420 "${@:2}"; }

docs() {
  for name in slope_failure_2d slope_failure_3d layered_slope; do
    [ -f "runs/$name/summary.json" ] || build/talus run "scenes/$name/scene.yaml" --out "runs/$name"
  done
  render slope_failure_2d --field stress:xy --map coolwarm --window 20 10 70 40 --out docs/images/pictures_window.png
  render slope_failure_2d --outline start --out docs/images/pictures_outline.png
  [ -f runs/landslide_maps/summary.json ] || build/talus run scenes/landslide/scene.yaml --out runs/landslide_maps --set \
    'outputs.runout.sections=[{name: path, along: [[512070, 5180320], [512500, 5180310], [512640, 5180200], [512710, 5180150]]}]'
  build/talus map runs/landslide_maps --only sections
  build/talus map runs/landslide_maps --only thickness_max --size 900x580
  cp runs/landslide_maps/pictures/section_path.png docs/images/runout_section.png
  cp runs/landslide_maps/pictures/map_thickness_max.png docs/images/runout_thickness.png
  build/talus render runs/landslide_maps --size 900x640 --frames 8 --range 0 25 --out docs/images/pictures_ground.png
  render slope_failure_3d --view iso --clip z 5 --outline start --out docs/images/pictures_clip.png
  build/talus render runs/layered_slope --frames first --field body --mesh edges --no-ground --window 17 6 101 44 --size 1200x560 \
    --out docs/images/terrain_columns.png
  awk '/^```yaml/ {in_scene = 1; next} /^```/ {in_scene = 0} in_scene' README.md > runs/block.yaml
  build/talus run runs/block.yaml --out runs/block
  render block --outline start --out docs/images/first_scene.png
  awk '/^scene: block.yaml/ {in_study = 1} /^```/ {in_study = 0} in_study' docs/guide/parameter_studies.md > runs/block_latin.yaml
  sed 's/^combine: latin/combine: tornado/; /^samples/d' runs/block_latin.yaml > runs/block_tornado.yaml
  for kind in latin tornado; do build/talus sweep "runs/block_$kind.yaml" --out "runs/block_$kind"; done
  cp runs/block_latin/exceedance_toe.png docs/images/sweep_exceedance.png
  cp runs/block_tornado/tornado_toe.png docs/images/sweep_tornado.png
  build/talus fos benchmarks/factor_of_safety/acads.yaml --from 0.9 --to 1.1 --width 0.025 --out runs/acads_fos
  cp runs/acads_fos/mechanism.png docs/images/fos_mechanism.png
  for script in python/examples/gallery/*.py; do
    TALUS=build/talus /usr/bin/python3 -B "$script" --out "docs/images/python_$(basename "$script" .py).png"
  done
}

[ "$*" = docs ] && { docs; exit; }
scenes=("$@")
[ ${#scenes[@]} -gt 0 ] || mapfile -t scenes < <(find scenes -mindepth 1 -maxdepth 1 -type d -printf '%f\n' | sort)
for name in "${scenes[@]}"; do
  build/talus run "scenes/$name/scene.yaml" --out "runs/$name"
  frame=last range=(last) window=()
  [ "$name" = cantilever ] && frame=14 range=(whole)  # t = 0.7 s, its lowest point; at the end it is back up
  [ "$name" = foam ] && window=(--window -0.1 0 0.1 0.11)
  [ "$name" = honey ] && frame=5 range=(whole) window=(--window -0.06 0 0.06 0.07)  # the thread still falls into the puddle
  [ "$name" = jelly ] && frame=4 range=(whole)  # the cube at its lowest
  [ "$name" = sensitive_clay ] && frame=17 range=(0 1)  # the second slide, as a block with a sunken wedge behind it
  render "$name" --frames "$frame" --range "${range[@]}" "${window[@]}" --out "scenes/$name/picture.png"
done
if [ $# -eq 0 ]; then tools/run_tutorials.py build/talus --pictures; fi
