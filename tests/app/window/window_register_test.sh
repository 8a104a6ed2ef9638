#!/usr/bin/env bash
# Live registration in a real window: pictures, keys and buttons, with a stand-in for a tracked scanner.
#   window_register_test.sh PROGRAM ASSETS_FOLDER SWEEP_SENDER
. "$(dirname "$0")/window_session.sh"

"$3" 0 "$work" >"$work/port" &
sender=$!
helpers=("$sender")
for _ in $(seq 1 600); do [ -s "$work/port" ] && break; sleep 0.1; done
[ -s "$work/port" ] || fail "the sender did not start"
start_trainer register --tracker "igtl://127.0.0.1:$(head -1 "$work/port")" --ct "$work/ct.nrrd" \
  --image-to-probe "$work/image.txt" --start "$work/start.txt" --search-mm 12 --search-deg 10 --no-refining \
  --screenshot "$work/screen.png"
at_least() { [ "$(value "$1" | cut -d. -f1)" -ge "$2" ] 2>/dev/null; }
bright() { [ "$(shot "$work/$1.png" "$1" && brightness "$work/$1.png" | awk '{ print ($2 > 0.05) }')" = 1 ]; }

echo "images arrive, and all three pictures show something"
await "pictures are drawn" at_least pictures_drawn 20
for picture in received simulated blended; do await "the picture $picture" bright "$picture"; done
is rounds 0 || fail "it refines before it is told to"
is work resting || fail "it does not rest"
[ "$(value problem)" = "" ] || fail "there is a problem"
shot "$work/before.png" simulated

echo "refining follows the estimate and changes the simulated picture"
click_on refine
await "rounds end" at_least rounds 3
contains verdict "no wide search has looked for other places" || fail "a local search counts"
shot "$work/after.png" simulated
[ "$(different "$work/before.png" "$work/after.png")" -gt 500 ] || fail "the simulated picture is as before"

echo "a wide search makes it count, and it is saved"
xdotool key w
await "it has converged" is converged true
xdotool key s
saved() { [ -s "$work/out/registration.json" ]; }
await "it is saved" saved
grep -q '"converged": true' "$work/out/registration.json" || fail "saved without its verdict"

echo "back to the start, without refining"
xdotool key f
await "refining is off" is refines false
click_on reset
await "it begins again" is rounds 0
await "the verdict is gone" is verdict ""

echo "the server is killed: a sentence says so"
kill -9 "$sender"
await "the loss is noticed" is_not problem ""
contains problem "127.0.0.1" || fail "no sentence"

echo "Escape closes the window"
xdotool key Escape
wait "$trainer" || fail "exit code $?"
[ -s "$work/screen.png" ] || fail "no screenshot"
trainer=""
echo "passed"
