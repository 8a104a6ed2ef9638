#!/usr/bin/env bash
# The trainer in a real window, driven by real key and mouse events, its screenshots looked at.
#   window_test.sh PROGRAM ASSETS_FOLDER
. "$(dirname "$0")/window_session.sh"
start_trainer --tracker "replay:$INSONATE_ASSETS/logs/ruq_good.igs.mha" --scenario "$INSONATE_ASSETS/scenarios/ruq_hepatorenal.toml"

echo "a bundled scan is replayed and seen"
await "the session starts" is activity exam
await "poses arrive" is_not face_x ""
remember_probe
await "the tracker moves the probe" far_enough
await "the scan comes to the view that is asked for" is_not hold_share 0.0
shot "$work/first.png" ultrasound 20
shot "$work/space.png" space 4

echo "Tab takes the probe, arrow keys slide it, the picture follows"
xdotool key Tab  # before the pictures are looked at: where that takes long, the scan would end meanwhile
await "the learner has the probe" is holder learner
read -r mean deviation <<<"$(brightness "$work/first.png")"
awk -v m="$mean" -v d="$deviation" 'BEGIN { exit !(m > 0.03 && m < 0.8 && d > 0.05) }' ||
  fail "the ultrasound is black or uniform: mean $mean, deviation $deviation"
read -r mean deviation <<<"$(brightness "$work/space.png")"
awk -v d="$deviation" 'BEGIN { exit !(d > 0.03) }' || fail "the 3D view is uniform: deviation $deviation"
is activity practice || fail "what the tracker found counts for the learner"
sleep 1
shot "$work/before.png" ultrasound 20
remember_probe
for _ in $(seq 1 8); do
  xdotool keydown Left
  sleep 0.3
  xdotool keyup Left
done
await "the left arrow slides the probe" far_enough
sleep 0.5
shot "$work/after.png" ultrasound 20
pixels=$(different "$work/before.png" "$work/after.png")
awk -v n="$pixels" 'BEGIN { exit !(n > 2000) }' || fail "the picture did not follow the probe: $pixels pixels changed"

echo "where nothing changes nothing is computed, and no frame is shown"
await "the simulator rests where nothing changes" at_rest
await "the screen is left as it is" shows_nothing

echo "what was shown part by part looks as a window that is shown whole"
import -window root "$work/parts.png"
shown=$(value frames_shown)
window=$(xdotool search --onlyvisible --name '^Insonate' | head -n 1)
xdotool windowunmap --sync "$window" windowmap --sync "$window"
await "the window is shown again" is_not frames_shown "$shown"
await "the screen is left as it is again" shows_nothing
import -window root "$work/whole.png"
pixels=$(different "$work/parts.png" "$work/whole.png")
[ "$pixels" = 0 ] || fail "$pixels pixels were not as they should be"

echo "keys turn the probe and the console's knobs"
beam=$(value beam_y)
xdotool keydown d
await "D tilts the probe" moved beam_y "$beam" 0.02
xdotool keyup d
depth=$(value depth_mm)
xdotool key bracketright
await "the bracket changes the depth" is_not depth_mm "$depth"
xdotool key m
await "M marks the moment" is marks 1
xdotool key space
await "space freezes" is frozen true
xdotool key space
await "space lets go" is frozen false

echo "R records, a click ends it, and the file can be read"
xdotool key r
await "R records" is_not recording ""
sleep 0.5
recording=$(value recording)
click "$(middle_x record)" "$(middle_y record)"
await "a click ends the recording" is recording ""
written() { [ -s "$recording" ]; }
await "the file is made" written

echo "the console's buttons are clicked"
click "$(freeze_x)" "$(freeze_y)"
await "a click on Freeze freezes" is frozen true
click "$(freeze_x)" "$(freeze_y)"
await "a click on Live lets go" is frozen false
click "$(freeze_x)" $(($(freeze_y) + 52))
await "a click on Help shows the keys" is overlay help
xdotool key Escape
await "Escape closes them" is overlay ""

echo "dragging on the ultrasound moves the probe, dragging beside the patient turns the view"
remember_probe
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

echo "help opens and closes, a bad file brings a dialog and the trainer goes on"
xdotool key F1
await "F1 shows the keys" is overlay help
xdotool key Escape
await "Escape closes them" is overlay ""
xdotool key ctrl+o
await "Ctrl O asks for a path" is overlay open
xdotool type "/nowhere.toml"
xdotool key Return
await "a missing file brings a dialog" is overlay problem
value problem | grep -q "no such file" || fail "the dialog does not say what is wrong: $(value problem)"
import -window root "$work/dialog.png"
xdotool key Return
await "the dialog can be acknowledged" is overlay ""

echo "giving the probe back starts the bundled scan over"
xdotool key Tab
await "the tracker has the probe" is holder tracker
is activity exam || fail "the exam did not start over"
remember_probe
await "the tracker moves it" far_enough

echo "the exam ends with a score sheet and a report"
await "the score sheet appears" is overlay score
await "its report has a name" is_not report ""
report=$(value report)
[[ $report == "$work/out/attempts/"*_ruq_hepatorenal/report.html && -s $report ]] || fail "there is no report: $report"
grep -q '"passed": true' "$(dirname "$report")/score.json" || fail "the bundled good scan did not pass"
import -window root "$work/sheet.png"
sheet=$(convert "$work/sheet.png" -crop 600x1+340+400 -colorspace Gray -format '%[fx:mean]' info:)
awk -v m="$sheet" 'BEGIN { exit !(m < 0.5) }' || fail "the sheet is not where it should be"

kill -0 "$trainer" || fail "the trainer ended by itself"
echo "passed"
