#!/usr/bin/env bash
# Core, mesh, kernels and materials for aarch64: compiled by a cross compiler, their tests run under an emulator (packages: group cross of
# tools/debian-packages.txt). The libraries are unpacked into build/aarch64/sysroot; the system stays as it is. On Debian; takes some twenty minutes.
# tools/cross_aarch64.sh [FOLDER ...]     default: core mesh kernels materials
set -euo pipefail
cd "$(dirname "$0")/.."

jobs=${JOBS:-$(nproc)}
build=$PWD/build/aarch64
sysroot=$build/sysroot
folders=("$@")
[ ${#folders[@]} -gt 0 ] || folders=(core mesh kernels materials)
packages=(libc6-dev libeigen3-dev libfmt-dev libopenmpi-dev libmetis-dev libgtest-dev libgmock-dev libgomp1 libstdc++6)

tools/install_packages.sh build test cross

# Packages of arm64 and all they need, by an apt of their own that takes nothing for installed.
if [ ! -e "$sysroot/complete" ]; then
  apt=$build/apt
  mkdir -p "$apt"/{state/lists/partial,cache/archives/partial} "$sysroot"
  : >"$apt/status"
  own=(-o APT::Architecture=arm64 -o APT::Architectures::=arm64 -o Dir::State="$apt/state" -o Dir::State::status="$apt/status"
    -o Dir::Cache="$apt/cache" -o Debug::NoLocking=1 -o APT::Install-Recommends=false -o APT::Sandbox::User=root)
  # What others have put beside Debian's own list may have nothing for arm64.
  own+=(-o Dir::Etc::sourceparts=/dev/null -o Dir::Etc::sourcelist="$apt/sources.list")
  (
    # shellcheck source=/dev/null
    . /etc/os-release
    echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian $VERSION_CODENAME main"
  ) >"$apt/sources.list"
  apt-get -qq "${own[@]}" update
  apt-get -qq "${own[@]}" --download-only -y install "${packages[@]}"
  for deb in "$apt"/cache/archives/*.deb; do dpkg-deb -x "$deb" "$sysroot"; done
  # Links that leave the folder.
  find "$sysroot" -type l -lname '/*' -print0 | while IFS= read -r -d '' link; do
    ln -sfnr "$sysroot$(readlink "$link")" "$link"
  done
  ln -s ompi-c.pc "$sysroot/usr/lib/aarch64-linux-gnu/pkgconfig/mpi-c.pc" # one of Debian's alternatives, which only an installation sets
  touch "$sysroot/complete"
fi

cat >"$build/toolchain.cmake" <<END
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_SYSROOT $sysroot)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64;-L;$sysroot)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
# What the linker looks for on behalf of libraries is found there, too.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-rpath-link,$sysroot/usr/lib/aarch64-linux-gnu -Wl,--allow-shlib-undefined")
# Open MPI's own compiler on this machine names headers and libraries of this machine: pkg-config says it instead,
# but for where the library is, for which FindMPI.cmake does not take its word.
set(MPI_SKIP_COMPILER_WRAPPER ON)
set(MPI_mpi_LIBRARY $sysroot/usr/lib/aarch64-linux-gnu/openmpi/lib/libmpi.so)
END
export PKG_CONFIG_SYSROOT_DIR=$sysroot PKG_CONFIG_LIBDIR=$sysroot/usr/lib/aarch64-linux-gnu/pkgconfig:$sysroot/usr/share/pkgconfig
cmake -S . -B "$build/tests" -G Ninja -D CMAKE_TOOLCHAIN_FILE="$build/toolchain.cmake" -D CMAKE_BUILD_TYPE=Debug -D CMAKE_CXX_FLAGS=-D_GLIBCXX_ASSERTIONS \
  -D CMAKE_CXX_FLAGS_DEBUG=-O1 -D TALUS_NATIVE=OFF -D TALUS_PROGRAMS=OFF -D TALUS_UNITY=ON -D TALUS_QUICK_TESTS=ON -D TALUS_WERROR="${TALUS_WERROR-OFF}" \
  -Wno-dev >/dev/null
targets=()
for folder in "${folders[@]}"; do targets+=("talus_${folder}_tests"); done
cmake --build "$build/tests" -j "$jobs" --target "${targets[@]}"
file -L "$build/tests/${targets[0]}" | grep -q 'ARM aarch64'
failed=()
for target in "${targets[@]}"; do
  echo "$target:"
  OMP_NUM_THREADS=2 OMP_WAIT_POLICY=passive qemu-aarch64 -L "$sysroot" "$build/tests/$target" --gtest_brief=1 --gtest_filter='-*Nightly*' || failed+=("$target")
done
[ ${#failed[@]} -eq 0 ] || {
  echo "failed: ${failed[*]}" >&2
  exit 1
}
