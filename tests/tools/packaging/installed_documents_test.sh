#!/usr/bin/env bash
# Installs the documents and the assets into an empty folder. No document may have a link to a file that is not there.
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
