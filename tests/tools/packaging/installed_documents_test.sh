#!/usr/bin/env bash
# Installs the documents and the assets into an empty folder. No document may have a link to a file that is not there,
# and the copyright file has to name what is compiled in.
#   installed_documents_test.sh CMAKE BUILD
set -euo pipefail
cmake=$1
build=$2
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for component in assets documents; do
  "$cmake" --install "$build" --component "$component" --prefix "$work" >/dev/null
done
cd "$work"/share/doc/insonate

links=0
while IFS=: read -r document link; do
  target=$(sed -E 's/^\]\(//; s/[)#].*//' <<<"$link")
  [ -e "$(dirname "$document")/$target" ] || fail "$document links to $target, which is not installed"
  links=$((links + 1))
done < <(grep -roE --include='*.md' '\]\([^)#:]+[)#]' .)
[ "$links" -gt 50 ] || fail "only $links links are found"

# An asset, a source file and a picture.
grep -q '\[assets/tissues.toml\](../../insonate/tissues.toml)' README.md || fail "README.md does not link to the asset"
grep -q '`sim/model/beam.h`' docs/effects.md || fail "docs/effects.md does not name the header"
grep -q '](images/effects/gain.png)' docs/effects.md || fail "docs/effects.md has lost its pictures"

# The package's copyright file names every library whose code is in the programs. GCC's runtime asks for nothing, and
# the Python module is not in the package.
copyright=$build/tools/packaging/debian/usr/share/doc/insonate/copyright
compiled=$(sed -n '/^## Compiled into/,/^## Loaded/p' THIRD_PARTY.md | awk -F ' *[|] *' '$3 ~ /-dev/ { print $3 }')
[ "$(wc -w <<<"$compiled")" -gt 5 ] || fail "THIRD_PARTY.md lists only these compiled libraries: $compiled"
for package in ${compiled//pybind11-dev/}; do
  grep -qw -- "$package" "$copyright" || fail "$copyright does not name $package"
done
