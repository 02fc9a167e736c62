#!/usr/bin/env bash
# Installs the packages of tools/debian-packages.txt that are missing. Exit 3: somebody else has to; the text says what.
set -euo pipefail
cd "$(dirname "$0")/.."

# "command:package" asks for the package only where nothing of that name can be run: what brings many others with it may be there already.
mapfile -t entries < <(sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' tools/debian-packages.txt)
wanted=()
for entry in "${entries[@]}"; do
  if [[ $entry != *:* ]] || ! command -v "${entry%%:*}" >/dev/null; then
    wanted+=("${entry#*:}")
  fi
done

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "This is not Debian. Talus needs, under the names Debian 12 gives them:" >&2
  printf '  %s\n' "${wanted[@]}" >&2
  echo "Once they are there, go on with: cmake --preset release && cmake --build build/release" >&2
  exit 3
fi

installed=$(dpkg-query -W -f='${db:Status-Abbrev} ${Package}\n' "${wanted[@]}" 2>/dev/null | sed -n 's/^ii *//p' || true)
mapfile -t missing < <(comm -23 <(printf '%s\n' "${wanted[@]}" | sort -u) <(sort -u <<<"$installed"))
if [ ${#missing[@]} -eq 0 ]; then
  echo "packages: all ${#wanted[@]} are installed"
  exit 0
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
    as_root=(sudo)
  else
    echo "Some packages are missing, and this user may not install them. As root:" >&2
    echo "  apt-get update && apt-get install -y --no-install-recommends ${missing[*]}" >&2
    exit 3
  fi
fi

echo "packages: installing ${missing[*]}"
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=600 -o Dpkg::Use-Pty=0)
"${apt[@]}" update || echo "packages: the lists could not be renewed, trying with the old ones" >&2
"${apt[@]}" install -y --no-install-recommends "${missing[@]}"
