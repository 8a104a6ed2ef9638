#!/usr/bin/env bash
# The views beside the ultrasound in a real window: layouts by key, double click and button, the CT's grey scale by
# dragging, and how the patient looks in 3D.
#   window_views_test.sh PROGRAM ASSETS_FOLDER
. "$(dirname "$0")/window_session.sh"
export XDG_CONFIG_HOME="$work/config"
water "$work/water.mha"
start_trainer --ct "$work/water.mha"

await "the session is shown" is activity practice
await "a pose is there" is_not face_x ""

echo "F6 shows the slices, F5 the usual views"
await "the CT's slice is there" is_not slice_x ""
is axial_x "" || fail "an axial slice is there already"
xdotool key F6
await "the axial slice comes" is_not axial_x ""
await "the slice in the plane goes" is slice_x ""
xdotool key F5
await "the slice in the plane comes back" is_not slice_x ""
is axial_x "" || fail "the axial slice stays"

echo "Escape closes the menu of the CT's grey levels, and nothing else"
click_on grey_slice
await "the menu is open" is_not ct_menu_x ""
xdotool key Escape
await "the menu is closed" is ct_menu_x ""
is activity practice || fail "Escape has left the scan"

echo "a double click makes a view large, and another one takes it back"
xdotool mousemove "$(middle_x slice)" "$(middle_y slice)" click --repeat 2 --delay 80 1
await "the other views go" is space_x ""
xdotool mousemove "$(middle_x slice)" "$(middle_y slice)" click --repeat 2 --delay 80 1
await "the other views come back" is_not space_x ""

echo "K opens the panel of looks in place of the CT's views, and a look is shown at once"
xdotool key k
await "the panel is there" is_not look_panel_x ""
is slice_x "" || fail "the CT's slice lies below the panel"
await "nothing changes any more" shows_nothing
shot "$work/labels.png" space 4
click_on look5
await "nothing changes any more" shows_nothing
shot "$work/bones.png" space 4
pixels=$(different "$work/labels.png" "$work/bones.png")
[ "$pixels" -gt 200 ] || fail "the patient looks the same: $pixels pixels changed"

echo "a point is dragged, and the look is saved and offered"
await "a point is there" is_not look_point1_x ""
is look7_x "" || fail "a saved look is offered already"
pointer_to "$(middle_x look_point1)" "$(middle_y look_point1)"
sleep 0.3
xdotool mousedown 1
sleep 0.3
pointer_to "$(($(middle_x look_point1) - 6))" "$(($(middle_y look_point1) - 10))"
sleep 0.3
xdotool mouseup 1
click_on look_save
await "a message names the file" contains toast "Saved"
ls "$XDG_CONFIG_HOME"/insonate/transfer_functions/Bones__edited_-*.toml >/dev/null || fail "there is no file of the look"
await "the saved look is offered" is_not look7_x ""
echo "a large view hides the panel, and its button leads back to it"
xdotool mousemove "$(middle_x space)" "$(middle_y space)" click --repeat 2 --delay 80 1
await "the panel goes" is look_panel_x ""
click_on look
await "the panel comes back" is_not look_panel_x ""
click_on look_close
await "the CT's views come back" is_not slice_x ""

echo "F8 opens the panel of effects there, and a switch changes the picture, until all is as usual again"
xdotool key F8
await "the panel is there" is_not effects_panel_x ""
is slice_x "" || fail "the CT's slice lies below the panel"
await "nothing changes any more" shows_nothing
drawn=$(value pictures_drawn)
click_on effect_waves
await "the picture is drawn anew" is_not pictures_drawn "$drawn"
await "nothing changes any more" shows_nothing
drawn=$(value pictures_drawn)
click_on effects_usual
await "the picture is drawn anew" is_not pictures_drawn "$drawn"
xdotool key Escape
await "Escape closes the panel, and not the scan" is_not slice_x ""
is activity practice || fail "the scan was left"

echo "passed"
