#!/usr/bin/env bash
# Feeds damaged inputs to what reads them (tests/fuzz): tools/fuzz.sh quick (10 s for each entry, nightly in CI), or
# tools/fuzz.sh long [minutes for each] [entry ...]. Inputs that break something are left in build/fuzz/findings; what has been tried and was
# worth keeping, in build/fuzz/corpus, from where the next call goes on.
set -euo pipefail
cd "$(dirname "$0")/.."

jobs=${JOBS:-$(nproc)}
build=build/fuzz
findings=$build/findings
all=(scene msh checkpoint raster points stl outlines record particles series summary history request)
quick_seconds=10 # for each, JOBS of them at a time

leg=${1-}
shift || true
case $leg in
  quick)
    seconds=$quick_seconds
    set --
    ;;
  long)
    minutes=${1:-60}
    shift || true
    seconds=$((minutes * 60))
    ;;
  *)
    echo "usage: tools/fuzz.sh quick | long [minutes] [entry ...]; entries: ${all[*]}" >&2
    exit 2
    ;;
esac
entries=("$@")
[ ${#entries[@]} -gt 0 ] || entries=("${all[@]}")

# The clang that is there: group fuzz of tools/debian-packages.txt.
for clang in clang++-14 clang++; do
  if command -v $clang >/dev/null; then break; fi
done
cmake --preset fuzz -D CMAKE_C_COMPILER="${clang/++/}" -D CMAKE_CXX_COMPILER="$clang" -D TALUS_WERROR="${TALUS_WERROR-OFF}" -Wno-dev >/dev/null
cmake --build $build --target fuzzers -j "$jobs"

# What each starts from, besides its own corpus.
more_seeds() {
  case $1 in
    scene) echo tests/io/scenes tests/io/bad_scenes ;;
  esac
}

# Longer inputs only repeat what shorter ones do; a run of one takes milliseconds. A raster has a thousand times as many cells as bytes.
longest() {
  case $1 in
    raster) echo 4000 ;;
    *) echo 20000 ;;
  esac
}

fuzz() {
  local entry=$1 seeds dictionary=()
  read -ra seeds <<<"$(more_seeds "$entry")"
  mkdir -p "$build/corpus/$entry" "$findings"
  [ ! -f "tests/fuzz/$entry.dict" ] || dictionary=("-dict=tests/fuzz/$entry.dict")
  # OpenMP's threads would only wait: the inputs are small. What has been freed would fill the memory they may take.
  OMP_NUM_THREADS=1 ASAN_OPTIONS=quarantine_size_mb=32 LSAN_OPTIONS=print_suppressions=0 "$build/talus_fuzz_$entry" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=1024 -max_len="$(longest "$entry")" \
    "${dictionary[@]}" -artifact_prefix="$findings/$entry-" -print_final_stats=1 \
    "$build/corpus/$entry" "tests/fuzz/corpus/$entry" "${seeds[@]}" >"$build/$entry.log" 2>&1 || touch "$build/$entry.failed"
}

for entry in "${entries[@]}"; do
  rm -f "$build/$entry.failed"
  while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do wait -n || true; done
  fuzz "$entry" &
done
wait
failed=()
for entry in "${entries[@]}"; do
  [ ! -e "$build/$entry.failed" ] || failed+=("$entry")
  echo "$entry: $(sed -n 's/^stat::number_of_executed_units: */executions /p' "$build/$entry.log"), $(find "$build/corpus/$entry" -type f | wc -l) inputs kept"
done

for entry in "${failed[@]}"; do
  echo "fuzz: $entry ended badly ($build/$entry.log):" >&2
  grep -E 'ERROR:|SUMMARY:|runtime error:|uncaught|Test unit written to' "$build/$entry.log" >&2 || tail -20 "$build/$entry.log" >&2
  echo "again: $build/talus_fuzz_$entry INPUT   then: fix it, and add the input to tests/fuzz/corpus/$entry" >&2
done
[ ${#failed[@]} -eq 0 ]
