#!/usr/bin/env bash
# Runs the benchmarks against their references and writes docs/verification.md: tools/verify.sh [case ...] [--level full] [--reuse]
set -euo pipefail
cd "$(dirname "$0")/.."

python=/usr/bin/python3 # Debian's: the one that has numpy, matplotlib and lz4
[ -x "$python" ] || python=python3
exec "$python" benchmarks/verify.py "$@"
