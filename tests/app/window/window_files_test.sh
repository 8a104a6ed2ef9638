#!/usr/bin/env bash
# What a person drops on the trainer's window, drags in its 3D view, edits beside it, and closes too early.
#   window_files_test.sh PROGRAM ASSETS_FOLDER DESKTOP_PROGRAM SHADER_FOLDER
desktop=$3
shaders=$4
. "$(dirname "$0")/window_session.sh"

echo "a window closed while the patient is made does not wait for it"
XDG_CACHE_HOME="$work/cache" start_trainer
await "the patient is being made" is overlay loading
pointer_to 640 400
"$desktop" close || fail "there is no window to close"
wait "$trainer" || fail "the trainer ended with an error"
[ -z "$(find "$work/cache" -name case.toml 2>/dev/null)" ] || fail "the trainer waited until the patient was made"
[ ! -s "$work/log" ] || fail "the trainer complains: $(cat "$work/log")"

cp -r "$shaders" "$work/shaders"
start_trainer --shader-dir "$work/shaders"
await "the session starts" is activity exam

echo "files are dropped on the window"
drop_here() {
  pointer_to "$(middle_x ultrasound)" "$(middle_y ultrasound)"
  "$desktop" drop "$@" || fail "the window did not take: $*"
}
xdotool key Tab
await "the learner has the probe" is holder learner
drop_here "$INSONATE_ASSETS/logs/ruq_poor.igs.mha"
await "a recorded scan takes the probe" is holder tracker
drop_here "$INSONATE_ASSETS/scenarios/ruq_hepatorenal.toml"
await "a scenario is an exam of the learner's own" is holder learner
await "the exam is loaded" is overlay briefing
xdotool key Return
await "the exam begins" is overlay ""
is activity exam || fail "the scenario did not begin"
# 60 mm of water at 1 mm; its name needs escapes in a URI.
water="$work/Jürgen's CT 50%.mha"
{
  printf 'ObjectType = Image\nNDims = 3\nDimSize = 60 60 60\nElementSpacing = 1 1 1\n'
  printf 'ElementType = MET_SHORT\nElementDataFile = LOCAL\n'
  printf '\030\374'  # a voxel of air, because a CT of one value alone is refused
  head -c $((60 * 60 * 60 * 2 - 2)) /dev/zero
} >"$water"
drop_here "$water"
await "steps that are not finished are asked about" is overlay leave
xdotool key Return
await "a CT is the patient" is patient "Jürgen's CT 50%.mha"
is activity practice || fail "a CT of one's own has no exam"
: >"$work/picture.jpg"
drop_here "$work/picture.jpg"
await "a file that is not a patient brings a dialog" is overlay problem
grep -q '"problem": ".*picture.jpg' "$state" || fail "the dialog does not name the file"
import -window root "$work/refused.png"
xdotool key Escape
await "Escape acknowledges" is overlay ""
is patient "Jürgen's CT 50%.mha" || fail "the patient has changed"
drop_here "$work/picture.jpg" "$water"
await "two things at once bring one dialog" is overlay problem
xdotool key Return
await "one Return acknowledges it" is overlay ""
drop_here "$(dirname "$(find "${XDG_CACHE_HOME:-$HOME/.cache}/insonate/phantoms" -name case.toml | tail -n 1)")"
await "a case folder is the patient" is_not patient "Jürgen's CT 50%.mha"
await "the case is loaded" is overlay ""

echo "the probe is dragged over the skin in the 3D view"
await "the probe is seen" is_not probe_on_screen_x ""
remember_probe
from_x=$(value probe_on_screen_x) from_y=$(value probe_on_screen_y)
to_x=$((from_x + 30)) to_y=$((from_y + 24))
# It is taken beside its face, which must not jump to the pointer.
taken_x=$((from_x + 14)) taken_y=$((from_y - 14))
pointer_to "$taken_x" "$taken_y"
xdotool mousedown 1
for step in 1 2 3 4 5 6; do
  pointer_to $((taken_x + 5 * step)) $((taken_y + 4 * step))
  sleep 0.1
done
xdotool mouseup 1
await "the probe moves" far_enough
# Within a few pixels: its face is pressed a little into the skin.
dragged_there() { ! moved probe_on_screen_x "$to_x" 8 && ! moved probe_on_screen_y "$to_y" 8; }
await "the probe is where it was dragged to" dragged_there

echo "a shader is edited while the trainer runs"
builds() { grep -q '"shader_problem": ""' "$state"; }
does_not_build() { ! builds; }
await "the picture is drawn" at_rest
shot "$work/before.png" ultrasound 20
shot "$work/console.png" console
echo 'this is not GLSL' >>"$work/shaders/shared/grey.glsl"
await "a broken shader is reported" does_not_build
grep -q 'shared/grey.glsl' "$state" || fail "the broken shader is not named"
await "the picture is drawn" at_rest
shot "$work/broken.png" ultrasound 20
shot "$work/console_broken.png" console
pixels=$(different "$work/console.png" "$work/console_broken.png")
[ "$pixels" = 0 ] || fail "what is wrong with the shader is written over the console: $pixels pixels"
pixels=$(different "$work/before.png" "$work/broken.png")
[ "$pixels" = 0 ] || fail "a shader that does not build changed $pixels pixels"
import -window root "$work/broken_screen.png"
# At two thirds of the depth more pixels are smoothed over, which takes shaders that have not been built yet.
depth=$(value depth_mm)
xdotool key --repeat 10 --delay 30 bracketleft
await "the picture shows less depth" moved depth_mm "$depth" 49
await "the picture is drawn" at_rest
shot "$work/shallow.png" ultrasound 20
pixels=$(different "$work/before.png" "$work/shallow.png")
[ "$pixels" -gt 2000 ] || fail "the depth is not changed beside a shader that does not build: $pixels pixels"
xdotool key --repeat 10 --delay 30 bracketright
await "the depth is the one before" is depth_mm "$depth"
await "the picture is drawn" at_rest
shot "$work/back.png" ultrasound 20
pixels=$(different "$work/before.png" "$work/back.png")
[ "$pixels" = 0 ] || fail "$pixels pixels have changed at the same depth"
sed 's/vec3(mapped(echo))/vec3(1.0 - mapped(echo))/' "$shaders/shared/grey.glsl" >"$work/shaders/shared/grey.glsl"
! cmp -s "$shaders/shared/grey.glsl" "$work/shaders/shared/grey.glsl" || fail "shared/grey.glsl reads differently: edit it elsewhere"
await "a shader that builds is taken" builds
await "the picture is drawn" at_rest
shot "$work/after.png" ultrasound 20
pixels=$(different "$work/before.png" "$work/after.png")
[ "$pixels" -gt 20000 ] || fail "the edited shader turned only $pixels pixels from black to white"

kill -0 "$trainer" || fail "the trainer ended by itself"
echo "passed"
