#!/usr/bin/env bash
# The checks of a change: tools/ci.sh <stage>... runs them one by one, `all` what .ci/run wants, some beside each other; `lint` those that build nothing.
set -euo pipefail
cd "$(dirname "$0")/.."

jobs=${JOBS:-$(nproc)}
python=/usr/bin/python3
[ -x "$python" ] || python=python3
folders=(core mesh kernels materials solver io app)
lint_stages=(format layers text spelling shell cppcheck tidy)
all_stages=(setup "${lint_stages[@]}" build docs site verify tutorials test)
other_stages=(tidy_all dev fuzz asan traps valgrind coverage aarch64 mutants bench)

# A warning of a compiler is an error here, and nowhere else: what a user types must not fail by a warning of a compiler that we do not have.
export TALUS_WERROR=ON

cxx_files() { git ls-files -- '*.hpp' '*.cpp'; }

stage_setup() { tools/install_packages.sh; }

stage_format() { cxx_files | xargs -r clang-format --dry-run --Werror --ferror-limit=3; }

stage_layers() { "$python" tools/check_layers.py; }

stage_text() { "$python" tools/check_text.py; }

# Scenes that are wrong on purpose are misspelt on purpose.
stage_spelling() {
  git ls-files -z -- ':!LICENSE' ':!*.svg' ':!*.msh' ':!*.csv' ':!*.png' ':!tests/io/bad_*' ':!tests/fuzz/corpus' | xargs -0 -r codespell --ignore-words tools/codespell-ignore.txt
}

stage_shell() { git ls-files -z -- '*.sh' .ci/run | xargs -0 -r shellcheck; }

stage_cppcheck() {
  cppcheck -j "$jobs" --quiet --language=c++ --std=c++20 --enable=warning,performance,portability --inline-suppr --error-exitcode=1 \
    --suppressions-list=tools/cppcheck-suppressions.txt -I . "${folders[@]}"
}

# All sources of a folder in one (preset lint): most of the time goes into the headers they share and what several instantiate. A name that two of them have in an anonymous
# namespace clashes there and nowhere else; rename one. Without the precompiled header: that is gcc's own format. omp.h is looked for
# where gcc keeps it, after everything of clang's.  Every warning of clang as a compiler is an error too; -Wsign-conversion is not part of gcc's
# -Wconversion, and sources that are read together shadow each other's names: these two are off.  The largest folders come last in the list and first in turn.
run_tidy() { # options of clang-tidy
  cmake --preset lint -Wno-dev >/dev/null
  cmake --build build/lint --target talus_version_header >/dev/null
  sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' build/lint/compile_commands.json | grep -vE '/tests/|talus_([a-z]+_tests|speed)\.dir' \
    | tac | xargs -r -n 1 -P "$jobs" clang-tidy -p build/lint --quiet --warnings-as-errors='*' "$@" \
      --extra-arg="-idirafter$(g++ -print-file-name=include)" --extra-arg=-Wno-unknown-warning-option --extra-arg=-Wno-sign-conversion --extra-arg=-Wno-shadow \
      2> >(grep -vE '(warnings?|errors?) generated' >&2)
}

# Of the checks of .clang-tidy without those that take long and seldom have something to look at here; these are left to the night, `tidy_all`.
stage_tidy() {
  run_tidy --checks=-bugprone-undelegated-constructor,-bugprone-suspicious-string-compare,-bugprone-infinite-loop,-modernize-use-nullptr,-bugprone-assert-side-effect,-bugprone-unused-raii,-bugprone-not-null-terminated-result
}

stage_tidy_all() { run_tidy; }

# With asserts, ours and those of Eigen and the standard library.
stage_dev() {
  cmake --preset dev -D TALUS_WERROR=$TALUS_WERROR -Wno-dev >/dev/null
  cmake --build build/dev -j "$jobs"
  ctest --preset dev -j "$jobs"
}

# What a newcomer types, in a folder that no other use touches, and for another processor than this machine's: what is said of code depends
# on the instructions that it is compiled to. Stage `test` goes on there.
newcomer="BUILD=build/newcomer LEVEL=x86-64-v3"
# shellcheck disable=SC2086 # some words
stage_build() { make build $newcomer JOBS="$jobs"; }

# The program of stage `build`, of which the next stages are.
talus=build/newcomer/talus

# The scene reference is written by the program: it must be the one in the tree.  Links lead somewhere, scenes shown pass `check`.
stage_docs() {
  "$talus" manual | diff -u docs/reference/scene.md - || {
    echo "docs/reference/scene.md is stale: make docs" >&2
    return 1
  }
  "$python" tools/check_docs.py "$talus"
}

# The benchmarks, quick level. Ends badly where a run fails or a judged number does that passed in the release; a change is named from the second
# digit on, since compilers and processors round otherwise. Cases of which nothing passed then can get no worse, and are left to `make verify`.
# Fourteen more, over half of the processor time, are left to the nightly stage `traps`, which runs all: other cases judge the same parts of the code, the
# orders of convergence (manufactured_solution, vibrating_bar), bending and stress (cantilever, plate_with_hole), soil that slides (slope_failure_2d, column_collapse, sliding_block), soil that fails
# (strip_footing, factor_of_safety), contact (contact, rigid_bodies) and fluids (dam_break).
nightly_cases=(generalized_vortex slope_failure_3d cohesive_collapse granular_chute infinite_slope contact_bodies floating_block fluid_layer pulled_bar wedge cook_membrane irregular_bar seepage saturated_soil equilibrium arrest random_slope snow_block)
stage_verify() {
  tools/verify.sh --program "$PWD/$talus" --level quick --judged --but "${nightly_cases[@]}" --digits 2 --jobs "$jobs" --regression --out build/verify
}

# The documentation as a site: build/site/index.html.  A warning, a broken link and a page that the navigation lacks are errors.
stage_site() { "$python" -m mkdocs build --quiet --config-file tools/site/mkdocs.yml; }

# Every command of docs/tutorials: what they write is there, what they print is what the page shows.
stage_tutorials() { "$python" tools/run_tutorials.py "$talus"; }

# 10 s of libFuzzer for each entry, besides what it takes to compile the readers with clang and its sanitizers; warnings of clang are errors here too.
# Nightly; stage `test` replays the inputs found.
stage_fuzz() { tools/fuzz.sh quick; }

# shellcheck disable=SC2086
stage_test() { make test $newcomer JOBS="$jobs"; }

# All tests but the nightly ones, and every scene, with address and undefined-behaviour sanitizers.
stage_asan() {
  cmake --preset asan -Wno-dev >/dev/null
  cmake --build build/asan -j "$jobs"
  ctest --preset asan -j "$jobs"
}

# Runs die where they compute what is not finite: every scene; every law, kernel, transfer, boundary and kind of stage (the scenes of the tests of
# restarts); the benchmarks.
stage_traps() {
  cmake --preset traps -Wno-dev >/dev/null
  cmake --build build/traps -j "$jobs" --target talus talus_app_tests
  ctest --preset traps -j "$jobs" --tests-regex '^scenes\.run|Restart'
  tools/verify.sh --program "$PWD/build/traps/talus" --level quick --jobs "$jobs" --regression --out build/verify_traps
}

# The tests of the folders, every load and store watched.  Of stage dev: slow enough without -O0.  Tests of the solver count what operator new
# gives; their own delete is inlined, so memcheck sees a free() that is not theirs.
stage_valgrind() {
  local folder
  for folder in core mesh kernels materials solver io gmsh; do
    OMP_NUM_THREADS=2 OMP_WAIT_POLICY=passive valgrind --quiet --error-exitcode=1 --show-mismatched-frees=no \
      "build/dev/talus_${folder}_tests" --gtest_brief=1 --gtest_filter='-*Nightly*'
  done
}

# Lines that the tests run; ends badly where a folder has fewer than it should.
stage_coverage() { make coverage JOBS="$jobs"; }

# Core, mesh, kernels and laws for another architecture, their tests under an emulator.
stage_aarch64() { tools/cross_aarch64.sh; }

# A sample of changes of single operators, signs and numbers, of which the tests have to notice nine out of ten.  Most of the time goes into compiling
# all of them at once; what the tests of the folders let pass is tried on those of the program.
stage_mutants() { "$python" tools/mutate.py --program; }

stage_bench() { make bench JOBS="$jobs"; }

run_stage() {
  local start=$SECONDS
  echo "==> $1"
  "stage_$1"
  times+="$1 $((SECONDS - start)) s, "
  echo "<== $1: $((SECONDS - start)) s"
}

# Stages one by one. The last one has the last word: after `test` nothing may follow the lines of ctest.
run_stages() {
  local name last=${*: -1}
  for name in "${@:1:$#-1}"; do
    run_stage "$name"
  done
  [ -z "$times" ] || echo "seconds: ${times%, }"
  echo "==> $last"
  "stage_$last"
}

# What `all` does beside each other: jobs, each of them this script with some stages, in a session of its own so that it can be ended as a whole.
# A job says in `$ended` how it has ended: bash's own `wait -n` overlooks those that end while nobody waits.
declare -A sessions=() begun=()
times=""
begin() { # name of the job, stages
  local name=$1
  shift
  mkdir -p build
  # shellcheck disable=SC2016 # of the shell inside
  setsid bash -c 'status=0; "$@" || status=$?; echo "$0 $status" >&3' "$name" tools/ci.sh "$@" >"build/ci_$name.log" 2>&1 &
  sessions[$name]=$! begun[$name]=$SECONDS
}

end_all() {
  local name
  for name in "${!sessions[@]}"; do
    kill -- "-${sessions[$name]}" 2>/dev/null || true
  done
}

# Until the job has ended, and with it those that end before. The output of a job is printed as a whole at its end. If one ends badly, all do.
await() { # name of the job
  local name status
  while [ -n "${sessions[$1]-}" ]; do
    read -r name status <&3
    unset "sessions[$name]"
    cat "build/ci_$name.log"
    times+="$name $((SECONDS - begun[$name])) s, "
    echo "<== $name: $((SECONDS - begun[$name])) s"
    [ "$status" -eq 0 ] || exit "$status"
  done
}

# The lints, the documentation and its tutorials run beside what compiles and what computes long: there are cores to spare at the end of each.
run_all() {
  local pipe
  pipe=$(mktemp -u)
  mkfifo "$pipe"
  exec 3<>"$pipe"
  rm "$pipe"
  trap end_all EXIT
  trap 'exit 130' INT TERM
  run_stage setup
  JOBS=1 begin lint lint
  begin build build
  await build
  begin pages docs site tutorials
  begin verify verify
  await verify
  await pages
  await lint
  exec 3>&-
  run_stages test
}

stages=()
for name in "$@"; do
  case $name in
    all) stages+=("${all_stages[@]}") ;;
    lint) stages+=("${lint_stages[@]}") ;;
    *) declare -F "stage_$name" >/dev/null || {
      echo "no stage '$name': all, lint, ${all_stages[*]}, ${other_stages[*]}" >&2
      exit 2
    }
      stages+=("$name") ;;
  esac
done
if [ ${#stages[@]} -eq 0 ]; then
  echo "usage: tools/ci.sh <stage>...   all, lint, ${all_stages[*]}, ${other_stages[*]}" >&2
  exit 2
fi
if [ "$*" = all ]; then
  run_all
else
  run_stages "${stages[@]}"
fi
