#!/usr/bin/env bash
# Registers what a stand-in for a tracked scanner sends, without a window, and asks for what cannot be done.
#   register_test.sh PROGRAM ASSETS_FOLDER SWEEP_SENDER
set -euo pipefail
program=$1 sender=$3
export INSONATE_ASSETS=$2
work=$(mktemp -d)
serving=""
trap '[ -z "$serving" ] || { kill "$serving" && wait "$serving" || true; }; rm -rf "$work"' EXIT
fail() {
  echo "FAILED: $*" >&2
  cat "$work/said" >&2
  exit 1
}

"$sender" 0 "$work" >"$work/port" &
serving=$!
for _ in $(seq 1 600); do [ -s "$work/port" ] && break; sleep 0.1; done
port=$(head -1 "$work/port")
[ -n "$port" ] || fail "the sender did not start"
live="register --headless --tracker igtl://127.0.0.1:$port --ct $work/ct.nrrd"
near="--search-mm 12 --search-deg 10"

echo "a near start is registered, and everything about it is written"
# shellcheck disable=SC2086
"$program" $live $near --image-to-probe "$work/image.txt" --start "$work/start.txt" --seconds 400 --out "$work/out" \
  --state-file "$work/state.json" >"$work/said" 2>&1 || fail "exit code $?"
grep -q '^Found in the images: curvilinear, radius ' "$work/said" || fail "the probe was not found"
grep -q '^Converged: the expected error' "$work/said" || fail "no verdict"
for file in registration.json ct_from_sweep.tfm sweep_from_ct.tfm ct_from_sweep.h5 sweep_from_ct.h5 scene.mrml sweep.nrrd evaluations.csv index.html; do
  [ -s "$work/out/$file" ] || fail "$file is missing"
done
grep -q '"converged": true' "$work/state.json" || fail "the state is not that at the end"
# Where both maps put the tracker's point that truly lies in the middle of the body. A voxel is 1.3 to 2.1 mm large.
cat "$work/truth.txt" "$work/out/ct_from_sweep.tfm" | awk '
  NR <= 3 { for (c = 1; c <= 4; ++c) t[NR, c] = $c }
  /^Parameters/ {
    for (r = 1; r <= 3; ++r) { for (c = 1; c <= 3; ++c) m[r, c] = $(1 + 3 * (r - 1) + c); m[r, 4] = $(10 + r) }
  }
  END {
    body[1] = 0; body[2] = 50; body[3] = 0
    for (c = 1; c <= 3; ++c) for (r = 1; r <= 3; ++r) p[c] += t[r, c] * (body[r] - t[r, 4])
    for (r = 1; r <= 3; ++r) { q = m[r, 4] - body[r]; for (c = 1; c <= 3; ++c) q += m[r, c] * p[c]; s += q * q }
    printf "off by %.2f mm\n", sqrt(s); exit !(s > 0 && sqrt(s) < 3)
  }' || fail "it lies elsewhere"

echo "what was saved is a start, and the next name is taken"
# shellcheck disable=SC2086
"$program" $live $near --image-to-probe "$work/image.txt" --start "$work/out/registration.json" --seconds 400 \
  --out "$work/out" >"$work/said" 2>&1 || fail "exit code $?"
grep -q "^Saved to $work/out-2.$" "$work/said" || fail "not saved beside it"

echo "what cannot be done is refused in a sentence"
refused() {
  local sentence=$1 code=0
  shift
  "$program" "$@" >"$work/said" 2>&1 || code=$?
  [ "$code" = 2 ] || fail "exit code $code for: $sentence"
  grep -qF -- "$sentence" "$work/said" || fail "not said: $sentence"
  [ "$(grep -vc '^insonate: waiting: ' "$work/said")" = 1 ] || fail "more than a sentence"
}
# shellcheck disable=SC2086
{
  refused "no start is named; give the map from the tracker's frame" $live
  refused "only an OpenIGTLink server sends images" register --headless --tracker mouse: --start "$work/start.txt" \
    --ct "$work/ct.nrrd"
  echo '{"patient_from_probe": []}' >"$work/pose.json"
  refused "there is no key 'ct_from_sweep'" $live --start "$work/pose.json"
  echo "1 0 0 0 0 1 0 900 0 0 1 0 0 0 0 1" >"$work/far.txt"
  refused "of what the sweep shows lies in the CT" $live --image-to-probe "$work/image.txt" --start "$work/far.txt" \
    --seconds 20
  refused "No connection to 127.0.0.1:1: Connection refused; is the OpenIGTLink server started there?" register \
    --headless --tracker igtl://127.0.0.1:1 --ct "$work/ct.nrrd" --start "$work/start.txt" --seconds 2
  grep -q '^insonate: waiting: No connection to 127.0.0.1:1' "$work/said" || fail "not said while it waits"
  refused "--tracker is required" register --headless --start "$work/start.txt"
}

echo "a server that ends is named while it is waited for"
# shellcheck disable=SC2086
"$program" $live --image-to-probe "$work/image.txt" --start "$work/start.txt" --seconds 600 --out "$work/lost" \
  --state-file "$work/lost.json" >"$work/said" 2>&1 &
running=$!
seen() { for _ in $(seq 1 600); do grep -q "$1" "$2" 2>/dev/null && return; sleep 0.1; done; fail "not seen: $1"; }
seen '"received": [1-9]' "$work/lost.json"
kill "$serving"
serving=""
seen "^insonate: waiting: .*127.0.0.1:$port" "$work/said"
kill "$running"
echo "passed"
