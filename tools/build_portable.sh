#!/usr/bin/env bash
# One program for every x86-64 processor: its libraries are built for two kinds of them, and the loader takes the best that the processor at hand can
# run (glibc-hwcaps, glibc 2.33 and later). build/portable/talus and build/portable/lib are all of it; where the folder stands does not matter.
set -euo pipefail
cd "$(dirname "$0")/.."

jobs=${JOBS:-$(nproc)}
build() {  # preset -> build/<preset>
  cmake --preset "$1" -D TALUS_WERROR="${TALUS_WERROR-OFF}" -Wno-dev >/dev/null
  cmake --build "build/$1" --target programs -j "$jobs"
}

build portable
build portable-v3
mkdir -p build/portable/lib/glibc-hwcaps/x86-64-v3
install --mode=644 --strip build/portable-v3/lib/*.so build/portable/lib/glibc-hwcaps/x86-64-v3/

python3 -B tools/check_hardening.py build/portable/talus build/portable/talus-render build/portable/lib/*.so build/portable/lib/glibc-hwcaps/x86-64-v3/*.so

# Which libraries are taken here, and that the plainest run as well.
loader=/lib64/ld-linux-x86-64.so.2
flags() { grep -o 'march=[a-z0-9-]*' | head -n 1; }
echo "build/portable/talus takes the libraries for $(build/portable/talus info | flags)"
echo "kept to the oldest it takes those for $("$loader" --glibc-hwcaps-mask none build/portable/talus info | flags)"
