#!/usr/bin/env bash
# Does in a copy of the tree what the tutorials of an own law and an own kernel say: files into their folders, a line into each list, then builds, runs
# the contracts over the longer lists, drives the law and runs scenes.  Some minutes of all cores; the copy stays in build/tutorial_parts.
set -euo pipefail
cd "$(dirname "$0")/.."
parts=$PWD/docs/tutorials copy=$PWD/build/tutorial_parts

mkdir -p "$copy"
git ls-files -z | tar --create --null --files-from=- | tar --extract --directory "$copy"
cd "$copy"

cp "$parts/own_law/maxwell.hpp" materials/
cp "$parts/own_law/maxwell_test.cpp" tests/materials/
cp "$parts/own_kernel/cell_mean.hpp" kernels/
cp "$parts/own_kernel/cell_mean_test.cpp" tests/kernels/
sed -n '/^namespace/,$p' "$parts/own_law/sample.hpp" >> tests/materials/samples.hpp
sed -i 's|^#include "materials/johnson_cook.hpp"|&\n#include "materials/maxwell.hpp"|; s|^using Laws = TypeList<|&\n    Maxwell,|' materials/laws.hpp
sed -i 's|^#include "kernels/linear.hpp"|#include "kernels/cell_mean.hpp"\n&|; s|^using Kernels = TypeList<|&CellMean<D>, |' kernels/kernels.hpp
rm -r tests/tutorials    # a list has each name once
sed -i '/talus_tests(tutorials /d' CMakeLists.txt

cmake --preset dev -D TALUS_UNITY=ON -Wno-dev > /dev/null
cmake --build build/dev -j "${JOBS:-$(nproc)}" --target talus talus_materials_tests talus_kernels_tests
build/dev/talus_materials_tests --gtest_brief=1 --gtest_filter='*Contract*:Maxwell.*'
build/dev/talus_kernels_tests --gtest_brief=1 --gtest_filter='*Contract*:CellMean.*'
build/dev/talus drive "$parts/own_law/relax.yaml" --out relax.csv
build/dev/talus run "$parts/own_law/sag.yaml" --out runs/sag --quiet
build/dev/talus run scenes/colliding_disks/scene.yaml --set kernel=cell_mean --out runs/cell_mean --quick --quiet
echo "the parts of the tutorials work in a tree of their own: $copy"
