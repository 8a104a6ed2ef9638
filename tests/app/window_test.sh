#!/usr/bin/env bash
# The trainer in a real window, driven by real key and mouse events, its screenshots looked at.
#   window_test.sh PROGRAM ASSETS_FOLDER
# Starts an X server of its own without a screen (Xvfb). Fails at the first thing that is not as it must be.
set -euo pipefail
program=$1
export INSONATE_ASSETS=$2
work=$(mktemp -d)
state="$work/state.json"
server="" trainer=""
finish() {
  [ -z "$trainer" ] || kill "$trainer" 2>/dev/null || true
  [ -z "$server" ] || kill "$server" 2>/dev/null || true
  rm -rf "$work"
}
trap finish EXIT

fail() {
  echo "FAILED: $*" >&2
  [ -f "$state" ] && cat "$state" >&2
  [ -f "$work/log" ] && cat "$work/log" >&2
  exit 1
}

# One value of the state file; empty when it is not there.
value() { sed -n "s/^ \"$1\": \"\{0,1\}\([^\",]*\)\"\{0,1\},\{0,1\}$/\1/p" "$state" 2>/dev/null; }

# Waits until a shell condition holds; the machine may be slow, so the limit is wide.
await() {
  local what=$1
  shift
  for _ in $(seq 1 600); do
    if "$@"; then return 0; fi
    kill -0 "$trainer" 2>/dev/null || fail "the trainer ended while waiting for: $what"
    sleep 0.2
  done
  fail "$what"
}
is() { [ "$(value "$1")" = "$2" ]; }
is_not() { [ "$(value "$1")" != "$2" ]; }
# Whether a number of the state moved away from another by more than a distance.
moved() { awk -v a="$(value "$1")" -v b="$2" -v d="$3" 'BEGIN { exit !((a - b > d) || (b - a > d)) }'; }

# What is on the screen, cut to a panel: `shot FILE PANEL [MARGIN]`.
shot() {
  local margin=${3:-0}
  import -display "$DISPLAY" -window root \
    -crop "$(($(value "$2_w") - 2 * margin))x$(($(value "$2_h") - 2 * margin))+$(($(value "$2_x") + margin))+$(($(value "$2_y") + margin))" \
    +repage "$1"
}
# Mean and standard deviation of a picture's brightness, 0 to 1.
brightness() { convert "$1" -colorspace Gray -format '%[fx:mean] %[fx:standard_deviation]' info:; }
# Pixels that differ between two pictures by more than 5 %.
different() { compare -metric AE -fuzz 5% "$1" "$2" null: 2>&1 || true; }

pointer_to() { xdotool mousemove "$1" "$2"; }
middle_x() { echo $(($(value "$1_x") + $(value "$1_w") / 2)); }
middle_y() { echo $(($(value "$1_y") + $(value "$1_h") / 2)); }

# -displayfd lets the server pick a display that is free.
exec 3>"$work/display"
Xvfb -displayfd 3 -screen 0 1280x800x24 -nolisten tcp >"$work/xvfb.log" 2>&1 &
server=$!
for _ in $(seq 1 100); do [ -s "$work/display" ] && break; sleep 0.1; done
[ -s "$work/display" ] || fail "the X server did not start: $(cat "$work/xvfb.log")"
DISPLAY=:$(cat "$work/display")
export DISPLAY

"$program" --seconds 300 --out "$work/out" --state-file "$state" >"$work/log" 2>&1 &
trainer=$!

echo "a bundled scan is replayed and seen"
await "the session starts" is activity exam
await "poses arrive" is_not face_x ""
x=$(value face_x) z=$(value face_z)
await "the tracker moves the probe" moved face_z "$z" 1
await "the scan comes to the view that is asked for" is_not hold_share 0.0
shot "$work/first.png" ultrasound 20
read -r mean deviation <<<"$(brightness "$work/first.png")"
awk -v m="$mean" -v d="$deviation" 'BEGIN { exit !(m > 0.03 && m < 0.8 && d > 0.05) }' ||
  fail "the ultrasound is black or uniform: mean $mean, deviation $deviation"
shot "$work/space.png" space 4
read -r mean deviation <<<"$(brightness "$work/space.png")"
awk -v d="$deviation" 'BEGIN { exit !(d > 0.03) }' || fail "the 3D view is uniform: deviation $deviation"

echo "Tab takes the probe, arrow keys slide it, the picture follows"
xdotool key Tab
await "the learner has the probe" is holder learner
is activity practice || fail "what the tracker found counts for the learner"
sleep 1
shot "$work/before.png" ultrasound 20
x=$(value face_x) y=$(value face_y) z=$(value face_z)
for _ in $(seq 1 8); do
  xdotool keydown Left
  sleep 0.3
  xdotool keyup Left
done
far_enough() { moved face_x "$x" 3 || moved face_y "$y" 3 || moved face_z "$z" 3; }
await "the left arrow slides the probe" far_enough
sleep 0.5
shot "$work/after.png" ultrasound 20
pixels=$(different "$work/before.png" "$work/after.png")
awk -v n="$pixels" 'BEGIN { exit !(n > 2000) }' || fail "the picture did not follow the probe: $pixels pixels changed"

echo "where nothing changes nothing is computed"
sleep 1.5
runs=$(value simulator_runs)
sleep 2
is simulator_runs "$runs" || fail "the simulator ran while nothing changed"

echo "keys turn the probe and the console's knobs"
beam=$(value beam_y)
xdotool keydown d
await "D tilts the probe" moved beam_y "$beam" 0.02
xdotool keyup d
depth=$(value depth_mm)
xdotool key bracketright
await "the bracket changes the depth" is_not depth_mm "$depth"
xdotool key space
await "space freezes" is frozen true
xdotool key space
await "space lets go" is frozen false

echo "the console's buttons are clicked"
# Freeze is the first of the console's right-hand block of buttons, Keys the one below it.
click() {
  pointer_to "$1" "$2"
  sleep 0.3
  xdotool mousedown 1
  sleep 0.3
  xdotool mouseup 1
}
button_x=$(($(value console_x) + $(value console_w) - 16 - 276 + 43))
click "$button_x" $(($(middle_y console) - 26))
await "a click on Freeze freezes" is frozen true
click "$button_x" $(($(middle_y console) - 26))
await "a click on Live lets go" is frozen false
click "$button_x" $(($(middle_y console) + 26))
await "a click on Keys shows the keys" is overlay help
xdotool key Escape
await "Escape closes them" is overlay ""

echo "dragging on the ultrasound moves the probe, dragging beside the patient turns the view"
x=$(value face_x) y=$(value face_y) z=$(value face_z)
pointer_to "$(middle_x ultrasound)" "$(middle_y ultrasound)"
sleep 0.3
xdotool mousedown 1
for step in $(seq 1 12); do
  pointer_to $(($(middle_x ultrasound) + 8 * step)) "$(middle_y ultrasound)"
  sleep 0.1
done
xdotool mouseup 1
await "dragging slides the probe" far_enough
shot "$work/view_before.png" space 4
runs=$(value simulator_runs)
corner_x=$(($(value space_x) + 30)) corner_y=$(($(value space_y) + $(value space_h) - 40))
pointer_to "$corner_x" "$corner_y"
sleep 0.3
xdotool mousedown 1
for step in $(seq 1 10); do
  pointer_to $((corner_x + 10 * step)) "$corner_y"
  sleep 0.1
done
xdotool mouseup 1
sleep 1.5
shot "$work/view_after.png" space 4
pixels=$(different "$work/view_before.png" "$work/view_after.png")
awk -v n="$pixels" 'BEGIN { exit !(n > 2000) }' || fail "the patient did not turn: $pixels pixels changed"

# Held for longer than a slow frame: Dear ImGui 1.86 does not see a key that is up again by the next one.
press_return() {
  xdotool keydown Return
  sleep 0.4
  xdotool keyup Return
}
echo "help opens and closes, a bad file brings a dialog and the trainer goes on"
xdotool key F1
await "F1 shows the keys" is overlay help
xdotool key Escape
await "Escape closes them" is overlay ""
xdotool key ctrl+o
await "Ctrl O asks for a path" is overlay open
sleep 0.5
xdotool type --delay 60 "/nowhere.toml"
sleep 0.5
press_return
await "a missing file brings a dialog" is overlay problem
value problem | grep -q "no such file" || fail "the dialog does not say what is wrong: $(value problem)"
import -window root "$work/dialog.png"
press_return
await "the dialog can be acknowledged" is overlay ""

echo "giving the probe back starts the bundled scan over"
xdotool key Tab
await "the tracker has the probe" is holder tracker
is activity exam || fail "the exam did not start over"
x=$(value face_x) y=$(value face_y) z=$(value face_z)
await "the tracker moves it" far_enough

echo "the exam ends with a score sheet and a report"
await "the score sheet appears" is overlay score
[ -s "$work/out/report.html" ] || fail "there is no report"
[ -s "$work/out/score.json" ] || fail "there is no score"
grep -q '"passed": true' "$work/out/score.json" || fail "the bundled good scan did not pass"
import -window root "$work/sheet.png"
sheet=$(convert "$work/sheet.png" -crop 600x1+340+400 -colorspace Gray -format '%[fx:mean]' info:)
awk -v m="$sheet" 'BEGIN { exit !(m < 0.5) }' || fail "the sheet is not where it should be"

kill -0 "$trainer" || fail "the trainer ended by itself"
echo "passed"
