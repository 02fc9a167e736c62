#!/usr/bin/env bash
# Which lines the tests run (preset coverage): a table by folder on the screen and in build/coverage/lines.txt, line by line in build/coverage/lines.html.
# Exit 1: a folder of the numerics has fewer than `floor` per cent of its lines covered.
# tools/coverage.sh [quick|own]  quick: the tests of these folders and of the ranks, without those of the program
#                                own: the tests of these folders alone, no floor; neither io nor app is compiled
set -euo pipefail
cd "$(dirname "$0")/.."

jobs=${JOBS:-$(nproc)}
build=build/coverage
floor=90
folders=(core mesh kernels materials solver)
targets=(talus_core_tests talus_mesh_tests talus_kernels_tests talus_materials_tests talus_solver_tests talus_ranks_tests)
tests='^ranks\.'
case ${1-} in
  quick) ;;
  own) unset 'targets[-1]' tests && floor=0 ;;
  *) targets+=(talus talus_app_tests) ;;
esac

cmake --preset coverage -Wno-dev >/dev/null
cmake --build $build -j "$jobs" --target "${targets[@]}"
find $build -name '*.gcda' -delete # of an earlier run
for target in "${targets[@]}"; do
  case $target in
    *_ranks_tests | talus) ;;
    *) OMP_WAIT_POLICY=passive "$build/$target" --gtest_brief=1 --gtest_filter='-*Nightly*' ;;
  esac
done
[ -z "${tests-}" ] || ctest --test-dir $build --output-on-failure --no-tests=error -R "$tests"

filters=()
for folder in "${folders[@]}"; do filters+=(--filter "$folder/"); done
gcovr --root . --object-directory $build "${filters[@]}" --exclude-throw-branches --json $build/lines.json --html-details $build/lines.html -j "$jobs"
/usr/bin/python3 tools/coverage_table.py --floor $floor $build/lines.json "${folders[@]}" | tee $build/lines.txt
