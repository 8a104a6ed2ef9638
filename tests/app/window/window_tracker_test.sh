#!/usr/bin/env bash
# A tracker whose server is killed, and the buttons on a probe, in a real window.
#   window_tracker_test.sh PROGRAM ASSETS_FOLDER POSE_SERVER SETUP_FILES
. "$(dirname "$0")/window_session.sh"
water "$work/water.mha"

serve() {
  "$1" "$2" >"$work/port" &
  pose_server=$!
  helpers=("$pose_server")
  for _ in $(seq 1 100); do [ -s "$work/port" ] && break; sleep 0.1; done
  [ -s "$work/port" ] || fail "the pose server did not start"
}
serve "$3" 0
port=$(cat "$work/port")
start_trainer --ct "$work/water.mha" --tracker "igtl://127.0.0.1:$port/Probe"

echo "poses come over OpenIGTLink and move the probe"
await "the session starts" is activity practice
await "poses arrive" is_not face_z ""
remember_probe
await "the tracker moves the probe" far_enough
is lost false || fail "the picture is said to stand still while poses come"
# Of the picture below its annotations and above its banner.
middle_of_picture() { shot "$work/$1" ultrasound 220; }

echo "the server is killed: the picture stands still and a banner says so"
kill -9 "$pose_server"
await "the loss is noticed" is lost true
await "the reason is shown" contains tracker_problem ': "[A-Za-z]'
await "the banner is drawn" amber_in ultrasound
remember_probe
await "the simulator rests" at_rest
middle_of_picture standing.png
sleep 2
middle_of_picture still_standing.png
pixels=$(different "$work/standing.png" "$work/still_standing.png")
[ "$pixels" = 0 ] || fail "$pixels pixels of a picture that stands still have changed"
moved face_z "$z" 0 && fail "the probe moved without a tracker"
is lost true || fail "the loss is not shown any more"

echo "the server is there again: the trainer recovers by itself"
serve "$3" "$port"
await "poses come again" is lost false
remember_probe
await "the probe moves again" far_enough
banner_gone() { ! amber_in ultrasound; }
await "the banner is gone" banner_gone

echo "who only looks at the set-up is not told that it is not complete"
xdotool key F2
await "the set-up opens" is overlay setup
xdotool key Escape
await "the set-up closes" is overlay ""
await "poses come" is_not face_z ""
remember_probe
await "the tracker moves the probe" far_enough
contains calibration_warning ': ""' || fail "there is a warning"
kill -0 "$trainer" || fail "the trainer ended by itself"
kill "$trainer"
wait "$trainer" 2>/dev/null || true

echo "buttons on the probe: mark marks, go on closes what lies over the screen"
"$4" "$work" "$INSONATE_ASSETS/calibration/abdomen.toml" || fail "no file with buttons"
start_trainer --ct "$work/water.mha" --tracker "replay:$work/buttons.igs.mha" --record "$work/marked.igs.mha"
await "the session starts" is activity practice
await "the button marks the moment" is marks 1
xdotool key F1
await "F1 shows the keys" is overlay help
await "the button goes on" is overlay ""
is marks 1 || fail "a button held across a loss of tracking marked $(value marks) times"
xdotool key r
await "the recording ends" is recording ""
recorded() { [ -s "$work/marked.igs.mha" ]; }
await "the recording is made" recorded
grep -aq '_Buttons = 2' "$work/marked.igs.mha" || fail "the mark is not in the recording"

kill -0 "$trainer" || fail "the trainer ended by itself"
echo "passed"
