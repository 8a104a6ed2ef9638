#!/usr/bin/env bash
# Installs the library and the assets into an empty folder, and builds docs/examples outside the source tree with them.
# The example must render the same picture as the one in the build.
#   library_test.sh CMAKE BUILD EXAMPLES
set -euo pipefail
cmake=$1
build=$2
examples=$3
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for component in assets development; do
  "$cmake" --install "$build" --component "$component" --prefix "$work/installed" >/dev/null
done
# Moved, so that a path of the folder it was installed to would not be found.
mv "$work/installed" "$work/moved"
cp -r "$examples" "$work/project"
"$cmake" -S "$work/project" -B "$work/build" -G Ninja -DCMAKE_PREFIX_PATH="$work/moved" -DCMAKE_BUILD_TYPE=Release >"$work/log" 2>&1 &&
  "$cmake" --build "$work/build" >>"$work/log" 2>&1 || fail "the project does not build: $(cat "$work/log")"
# The trainer learns from a log's plan which exam the log is of.
for log in "$work"/moved/share/insonate/logs/*.igs.mha; do
  [ -f "${log%.igs.mha}.toml" ] || fail "no plan lies beside $log"
done
# No header is installed without the library that it declares.
for room in "$work"/moved/include/insonate/sim/*/; do
  compgen -G "$work/moved/lib*/libinsonate_$(basename "$room").a" >/dev/null ||
    compgen -G "$work/moved/lib*/*/libinsonate_$(basename "$room").a" >/dev/null || fail "no library for $room"
done
# Debugging information may name the sources; nothing that the project reads may.
named=$(grep -rlF --include='*.cmake' --include='*.h' "$(cd "$build/../.." && pwd)" "$work/moved") || true
[ -z "$named" ] || fail "the install names the source tree: $named"

"$build/bin/insonate-case" phantom --set voxel_mm=4 "$work/case" >/dev/null
env -u INSONATE_ASSETS "$work/build/example-render-ct" "$work/case/ct.nrrd" "$work/outside.png" || fail "it does not run"
"$build/bin/example-render-ct" "$work/case/ct.nrrd" "$work/inside.png"
cmp "$work/outside.png" "$work/inside.png" || fail "the pictures differ"
