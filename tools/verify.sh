#!/usr/bin/env bash
# The verification suite with build/talus, for developers: tools/verify.sh [case ...] [--level full] [--jobs 2] [--write-docs] [--release]
# As `talus verify`; tools/verify.sh tradeoff case ... as `talus tradeoff`.
set -euo pipefail
cd "$(dirname "$0")/.."

python=/usr/bin/python3 # Debian's: the one that has numpy, matplotlib, lz4 and markdown
[ -x "$python" ] || python=python3
suite=verify
if [ "${1-}" = tradeoff ]; then
  suite=tradeoff
  shift
fi
exec "$python" "benchmarks/$suite.py" "$@"
