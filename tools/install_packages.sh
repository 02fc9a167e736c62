#!/usr/bin/env bash
# Installs the packages of tools/debian-packages.txt that are missing: tools/install_packages.sh [GROUP ...], by default all groups that a
# developer needs. Exit 2: there is no such group. Exit 3: an administrator has to install them; the text says which.
set -euo pipefail
cd "$(dirname "$0")/.."

list=${TALUS_PACKAGES:-tools/debian-packages.txt}
groups=("$@")
[ ${#groups[@]} -gt 0 ] || groups=(build draw scripts test docs fuzz check)

# group -> its entries, one a line
entries_of() {
  sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$list" | awk -v group="[$1]" '/^\[/ { here = $0 == group; next } here'
}

entries=()
for group in "${groups[@]}"; do
  mapfile -t some < <(entries_of "$group")
  if [ ${#some[@]} -eq 0 ]; then
    echo "tools/debian-packages.txt has no group '$group'" >&2
    exit 2
  fi
  entries+=("${some[@]}")
done

# Of what is needed, what no program on the path stands for.
wanted=()
for entry in "${entries[@]}"; do
  command=${entry#\?}
  if [[ $command == *:* ]] && command -v "${command%%:*}" >/dev/null; then
    continue
  fi
  wanted+=("$entry")
done
names_of() { # entry -> the packages it names, one a line
  local entry=${1#\?}
  tr '|' '\n' <<<"${entry#*:}"
}

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "This is not Debian. Talus needs for ${groups[*]}, under the names that Debian gives them:" >&2
  for entry in "${wanted[@]}"; do
    names_of "$entry" | paste -sd'|' | sed 's/|/ or /g; s/^/  /' >&2
  done
  echo "Once they are there, go on with: cmake --preset release && cmake --build build/release --target programs" >&2
  exit 3
fi

mapfile -t names < <(for entry in "${wanted[@]}"; do names_of "$entry"; done | sort -u)
format="\${db:Status-Abbrev} \${Package}\n"
declare -A is_installed=()
while read -r name; do is_installed[$name]=1; done < <(dpkg-query -W -f="$format" "${names[@]}" 2>/dev/null | sed -n 's/^ii *//p')

# Sorts what is not installed, as apt knows it now: `must` and `may` (?) be installed; `left_out` and `nowhere` are those that apt does not have.
sort_missing() {
  must=() may=() left_out=() nowhere=()
  local entry name some chosen
  local -A has_candidate=()
  while read -r name; do has_candidate[$name]=1; done < <(
    LC_ALL=C apt-cache policy "${names[@]}" 2>/dev/null | awk '/^[^ ].*:$/ { name = substr($1, 1, length($1) - 1) } /^  Candidate: [^(]/ { print name }'
  )
  for entry in "${wanted[@]}"; do
    mapfile -t some < <(names_of "$entry")
    chosen=
    for name in "${some[@]}"; do
      [ -z "${is_installed[$name]-}" ] || continue 2
    done
    for name in "${some[@]}"; do
      if [ -n "${has_candidate[$name]-}" ]; then
        chosen=$name
        break
      fi
    done
    case $entry/$chosen in
      \?*/) left_out+=("${some[0]}") ;;
      \?*) may+=("$chosen") ;;
      */) nowhere+=("$(names_of "$entry" | paste -sd'|' | sed 's/|/ or /g')") ;;
      *) must+=("$chosen") ;;
    esac
  done
}

end_without() { # what could not be had and can be done without
  if [ $# -gt 0 ]; then
    echo "packages: done without $*: what needs them is left out, and says so"
  else
    echo "packages: all for ${groups[*]} are installed"
  fi
  exit 0
}

sort_missing
if [ ${#must[@]} -eq 0 ] && [ ${#may[@]} -eq 0 ] && [ ${#nowhere[@]} -eq 0 ]; then
  end_without "${left_out[@]}"
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
    as_root=(sudo)
  elif [ ${#must[@]} -eq 0 ] && [ ${#nowhere[@]} -eq 0 ]; then
    end_without "${may[@]}" "${left_out[@]}"
  else
    echo "Some packages are missing, and this user may not install them. As root:" >&2
    echo "  apt-get update && apt-get install -y --no-install-recommends ${must[*]} ${may[*]} ${nowhere[*]%% or *}" | sed 's/  *$//; s/\([a-z]\)  */\1 /g' >&2
    exit 3
  fi
fi

apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=600 -o Dpkg::Use-Pty=0)
"${apt[@]}" update || echo "packages: the lists could not be renewed, trying with the old ones" >&2
sort_missing
if [ ${#nowhere[@]} -gt 0 ]; then
  echo "packages: apt has none of these, which Talus needs for ${groups[*]}:" >&2
  printf '  %s\n' "${nowhere[@]}" >&2
  exit 3
fi
if [ ${#must[@]} -gt 0 ]; then
  echo "packages: installing ${must[*]}"
  "${apt[@]}" install -y --no-install-recommends "${must[@]}"
fi
if [ ${#may[@]} -gt 0 ]; then
  echo "packages: installing ${may[*]}"
  "${apt[@]}" install -y --no-install-recommends "${may[@]}" || left_out+=("${may[@]}")
fi
[ ${#left_out[@]} -eq 0 ] || end_without "${left_out[@]}"
