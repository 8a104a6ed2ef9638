#!/usr/bin/env bash
# Views are made of a case in a real window: frozen, named, said what they must show, and kept in its folder.
#   window_author_test.sh PROGRAM ASSETS_FOLDER
screen_size=1152x720  # smaller than the window as it begins elsewhere
. "$(dirname "$0")/window_session.sh"
block="$work/block"
mkdir "$block"
water "$block/ct.mha"
{
  sed '/^ElementDataFile/q; s/MET_SHORT/MET_UCHAR/' "$block/ct.mha"
  head -c 512000 /dev/zero | tr '\0' '\1'
} >"$block/labels.mha" 2>/dev/null
cat >"$block/case.toml" <<'EOF'
format = 1
name = "Block"  # of water
ct = "ct.mha"
labels = "labels.mha"

[[label]]
value = 1
name = "water"
tissue = "liver"

[[landmark]]
name = "middle"
position = [0, 0, 0]
EOF

echo "without a case there is nothing to make views of"
status=0
"$program" author >"$work/refused" 2>&1 || status=$?
[ $status = 2 ] && grep -q -- "--case is required" "$work/refused" || fail "$(cat "$work/refused")"

views() { grep -c '^\[\[view\]\]' "$block/case.toml" || true; }
start_trainer author --case "$block"
await "the probe is seen" is_not face_x ""
is text_field_x "" || fail "a view is made of a picture that runs"
[ $(($(value start_page_y) + $(value start_page_h))) -le 720 ] || fail "the window's lower end is off the screen"

echo "a frozen picture gets a title, and what it must show"
remember_probe
xdotool key space
await "the picture is frozen, and its parts are there" is_not part_water_x ""
xdotool key Return
await "Return opens the field" is typing true
type_title() {
  xdotool type "All wet"
  xdotool key Return
}
in_one_frame type_title
await "it is typed" is view_title "All wet"
is kept_view "" || fail "a view is kept that shows nothing"
click_on part_water
await "a click wants the structure" is wanted "water; "
xdotool key 2
await "a key wants the landmark" is wanted "water; middle; "
! far_enough || fail "the probe moved"

echo "it is kept at once, and the file keeps what else is in it"
xdotool key Return
await "Return keeps it" contains kept_view "all_wet"
[ "$(views)" = 1 ] || fail "the file has $(views) views"
for line in 'name = "all_wet"' 'title = "All wet"' 'targets = \["water"\]' 'landmarks = \["middle"\]' '# of water'; do
  grep -q "$line" "$block/case.toml" || fail "the file does not say $line"
done
await "the next begins with nothing" is wanted ""
echo "the way to it is shown at once"
xdotool key g
await "the guide leads to it" is guided_to all_wet
is advice "" || fail "the way to where the probe is: $(value advice)"
xdotool key g
await "there is no other" is guided_to ""

echo "a second of this name is refused, and nothing is lost"
click_on text_field
type_title
click_on part_water
await "it is wanted" is wanted "water; "
click_on keep_view
await "it is refused" is overlay problem
value problem | grep -q "the case has a view of this name" || fail "$(value problem)"
xdotool key Return
await "Return acknowledges" is overlay ""
is view_title "All wet" && is wanted "water; " || fail "what was chosen is lost"
[ "$(views)" = 1 ] || fail "the file has $(views) views"

echo "the case is as good as before"
kill "$trainer"
start_trainer --case "$block"
await "it is opened" is patient Block
echo "passed"
