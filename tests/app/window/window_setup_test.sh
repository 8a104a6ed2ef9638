#!/usr/bin/env bash
# The set-up of a tracker in a real window, by clicks and keys: a tip that is pivoted, touches that are refused, the file
# that comes of it, and the session through it.
#   window_setup_test.sh PROGRAM ASSETS_FOLDER SETUP_FILES [FOLDER for pictures of the window]
. "$(dirname "$0")/window_session.sh"
pictures=${4:-$work}
picture() { import -window root "$pictures/$1.png"; }
"$3" "$work" "$INSONATE_ASSETS/calibration/abdomen.toml" || fail "no files to set up with"
water "$work/water.mha"

cp "$work/lab.toml" "$work/old.toml"
start_trainer --tracker "replay:$work/pivot.igs.mha?loop=1" --calibration "$work/lab.toml" --ct "$work/water.mha" \
  --landmarks "$INSONATE_ASSETS/calibration/abdomen.toml"
echo "an old calibration is used and warned of"
await "the session starts" is activity practice
await "the probe is seen" is_not face_x ""
contains calibration_warning "8 days old" || fail "no warning: $(value calibration_warning)"
contains calibration_warning "of the built-in patient" || fail "no warning: $(value calibration_warning)"
picture warning

echo "a click opens the set-up at the first step that is to be made, a click on a step goes to it"
click_on setup
await "the set-up opens" is overlay setup
xdotool key F1
await "F1 shows its help" is overlay help
xdotool key F1
await "F1 closes it" is overlay setup
is setup_step lag || fail "it begins with $(value setup_step)"
await "the buttons are there" is_not setup_pivot_x ""
picture lag
click_on setup_axes
await "a click goes to a step" is setup_step axes
picture axes
xdotool key space
await "Space marks" is setup_part 1
picture axes_move
xdotool key BackSpace
await "Backspace takes the mark back" is setup_part 0
click_on setup_pivot
await "the tip is next" is setup_step pivot
picture pivot

echo "the tip is pivoted, its residual shown on the way"
click_on setup_mark
await "a click marks" is setup_reading true
await "the residual is shown" contains setup_feedback "residual 0."
picture pivoting
await "the tip is found" is setup_done true
contains setup_result "residual 0." || fail "no residual: $(value setup_result)"
picture tip
cmp -s "$work/lab.toml" "$work/old.toml" && fail "the file was not written"
grep -q '^\[tip\]' "$work/lab.toml" || fail "there is no tip in the file"

echo "touches that are all of one place are refused, in words"
click_on setup_mark
await "the next step is the face" is setup_step face
xdotool key space
await "the tip rests, so the first touch is read" is setup_part 1
picture face
for part in 2 3 4; do
  xdotool key space
  await "another touch is read" is setup_part "$part"
done
xdotool key space
await "the face is refused" contains setup_refusal "lie in one place"
picture refusal
click_on setup_undo
await "the refusal can be taken away" is setup_refusal ""
click_on setup_landmarks
await "the landmarks can be made with the tip" is setup_step landmarks
sleep 1
picture landmarks

echo "Escape closes the set-up, and the session goes on through the new file"
xdotool key Escape
await "the set-up closes" is overlay ""
await "the probe is seen again" is_not face_x ""
xdotool key F2
await "F2 opens it again" is overlay setup
click_on setup_close
await "a click closes it" is overlay ""
kill -0 "$trainer" || fail "the trainer ended by itself"
kill "$trainer"
wait "$trainer" 2>/dev/null || true

echo "without its calibration the set-up begins by itself, and the session goes on without when it is left"
start_trainer --tracker "replay:$work/pivot.igs.mha?loop=1" --calibration "$work/new.toml" --ct "$work/water.mha"
await "the set-up opens" is overlay setup
await "with its first step" is setup_step axes
xdotool key Escape
await "the set-up closes" is overlay ""
await "the session starts" is activity practice
contains calibration_warning "Probe face.*still to be made" || fail "no warning: $(value calibration_warning)"

echo "the mode setup begins with the set-up even where the calibration is complete"
kill "$trainer"
wait "$trainer" 2>/dev/null || true
start_trainer setup --tracker "replay:$work/pivot.igs.mha?loop=1" --calibration "$work/old.toml" --ct "$work/water.mha"
await "the set-up opens" is overlay setup
xdotool key Escape
await "it is left for practice" is activity practice
xdotool key F2
await "and opens again" is overlay setup

echo "the mode setup is left for the start page where the calibration is incomplete"
kill "$trainer"
wait "$trainer" 2>/dev/null || true
start_trainer setup --tracker "replay:$work/pivot.igs.mha?loop=1" --calibration "$work/new.toml" --ct "$work/water.mha"
await "the set-up opens" is overlay setup
xdotool key Escape
await "it is left for the start page" is start_task setup

echo "where no tracker with a sensor is used, another one can be chosen"
kill "$trainer"
wait "$trainer" 2>/dev/null || true
start_trainer --ct "$work/water.mha"
await "the session starts" is activity practice
xdotool key F2
await "F2 says that it leaves the scan" contains toast "F2 once more leaves the scan"
xdotool key F2
await "F2 leads to the trackers" is start_task setup
contains start_why_not "no sensor" || fail "the page does not say what is wrong"

kill -0 "$trainer" || fail "the trainer ended by itself"
echo "passed"
