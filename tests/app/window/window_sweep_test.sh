#!/usr/bin/env bash
# A sweep in a real window becomes a volume: begun and ended by key and button, shown in three planes, saved.
#   window_sweep_test.sh PROGRAM ASSETS_FOLDER DESKTOP_PROGRAM
desktop=$3
. "$(dirname "$0")/window_session.sh"
water "$work/water.mha"
start_trainer --ct "$work/water.mha"
at_least() { awk -v a="$(value "$1")" -v b="$2" 'BEGIN { exit !(a >= b) }'; }

echo "without a sweep there is nothing to see"
await "the session is shown" is activity practice
await "a pose is there" is_not face_x ""
xdotool key u
await "a sentence says how a volume is made" contains toast "Sweep a volume first"
[ -z "$(value overlay)" ] || fail "a page is open: $(value overlay)"

echo "T begins a sweep, the probe slides, the button ends it"
remember_probe
xdotool key t
await "the sweep runs" is sweeping true
xdotool keydown Up
await "the probe slides" far_enough
sleep 1
xdotool keyup Up
await "pictures are taken" at_least sweep_pictures 3
click_on sweep
await "the sweep ends" is sweeping false
await "the volume is made" at_least swept_pictures 3

echo "the button shows the volume, and planes follow the mouse"
await "the button is there" is_not volume_x ""
click_on volume
await "the page is open" is overlay volume
await "nothing says any more that it can be opened" is toast ""
await "its planes are there" is_not plane_imaging_x ""
await "nothing changes any more" shows_nothing
px=$(value planes_x) py=$(value planes_y) pz=$(value planes_z)
shot "$work/face.png" plane_face 4
click "$(($(middle_x plane_imaging) + 20))" "$(($(middle_y plane_imaging) + 30))"
plane_moved() { moved planes_x "$px" 0.5 || moved planes_y "$py" 0.5 || moved planes_z "$pz" 0.5; }
await "the point follows a click" plane_moved
await "nothing changes any more" shows_nothing
shot "$work/face_moved.png" plane_face 4
pixels=$(different "$work/face.png" "$work/face_moved.png")
[ "$pixels" -gt 200 ] || fail "the plane parallel to the face is the same: $pixels pixels changed"
pointer_to "$(($(middle_x plane_imaging) + 120))" "$(($(middle_y plane_imaging) + 30))"
sleep 0.3
xdotool mousedown 3
sleep 0.3
pointer_to "$(($(middle_x plane_imaging) + 110))" "$(($(middle_y plane_imaging) + 80))"
sleep 0.3
xdotool mouseup 3
await "a drag with the right button turns the planes" at_least planes_turned_deg 5

echo "the volume itself turns by dragging, and its threshold moves"
await "nothing changes any more" shows_nothing
shot "$work/volume.png" swept_volume 4
drag() {  # PLACE BY_X BY_Y, from the middle of the place
  pointer_to "$(middle_x "$1")" "$(middle_y "$1")"
  sleep 0.3
  xdotool mousedown 1
  sleep 0.3
  pointer_to "$(($(middle_x "$1") + $2))" "$(($(middle_y "$1") + $3))"
  sleep 0.3
  xdotool mouseup 1
}
drag swept_volume 120 20
await "nothing changes any more" shows_nothing
shot "$work/volume_turned.png" swept_volume 4
pixels=$(different "$work/volume.png" "$work/volume_turned.png")
[ "$pixels" -gt 200 ] || fail "the volume has not turned: $pixels pixels changed"
drag swept_threshold -100 0
await "nothing changes any more" shows_nothing
shot "$work/volume_fuller.png" swept_volume 4
pixels=$(different "$work/volume_turned.png" "$work/volume_fuller.png")
[ "$pixels" -gt 1000 ] || fail "a lower threshold shows no more: $pixels pixels changed"

echo "the patient is shown in its place, cut at the probe's plane"
click_on show_patient
await "nothing changes any more" shows_nothing
shot "$work/patient.png" swept_volume 4
pixels=$(different "$work/volume_fuller.png" "$work/patient.png")
[ "$pixels" -gt 1000 ] || fail "the patient is not shown: $pixels pixels changed"
click_on show_volume

xdotool key Home
await "Home turns them back" is planes_turned_deg 0.0
is planes_x "$px" || fail "the point is elsewhere: $px, $(value planes_x)"

echo "a volume that is not saved is asked for before it is lost"
xdotool key Escape
await "the page is closed" is overlay ""
xdotool key Escape
await "it asks" is overlay leave
xdotool key Escape
await "Escape stays" is overlay ""
xdotool key F2
await "F2 asks too" contains toast "lose the sweep"
is activity practice || fail "the set-up has begun"
xdotool key ctrl+q
await "Ctrl Q asks" is overlay leave
xdotool key Escape
await "Escape stays" is overlay ""
pointer_to "$(middle_x ultrasound)" "$(middle_y ultrasound)"
"$desktop" close || fail "there is no window to close"
await "the button in the frame asks" is overlay leave
xdotool key Escape
await "Escape stays" is overlay ""
"$desktop" drop "$INSONATE_ASSETS/logs/ruq_poor.igs.mha" || fail "the window did not take the recorded scan"
await "what is opened asks" is overlay leave
xdotool key Escape
await "Escape stays" is overlay ""
is holder learner || fail "the recorded scan was opened"
xdotool key u
await "the volume is still there" is overlay volume

echo "S saves the volume, Escape goes back to the scan"
xdotool key s
await "a message names the file" contains toast "Saved"
saved() { [ "$(find "$work/out/volumes" -name "*.nrrd" 2>/dev/null | wc -l)" = 2 ]; }
await "the files are there" saved
grep -aq "space directions" "$work"/out/volumes/*Z.nrrd || fail "the volume has no directions"
xdotool key Escape
await "the page is closed" is overlay ""
is activity practice || fail "the session was left"
xdotool key u
await "U opens it again" is overlay volume
xdotool key u
await "and closes it" is overlay ""
xdotool key Escape
await "a saved volume needs no question" is_not start_task ""
xdotool key ctrl+q
wait "$trainer" || fail "the trainer ended with an error"
echo "passed"
