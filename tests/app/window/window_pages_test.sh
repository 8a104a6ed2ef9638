#!/usr/bin/env bash
# What a person finds on every page of a real window: help, settings that stay, full screen, sides of the patient,
# pictures and clips, and the way back from a knob or a move.
#   window_pages_test.sh PROGRAM ASSETS_FOLDER
screen_size=1440x900
. "$(dirname "$0")/window_session.sh"
settings="$work/config/insonate/settings.toml"
kept() { grep -qx "$1" "$settings" 2>/dev/null; }
help_and_back() {
  xdotool key F1
  await "F1 shows the help of $1" is overlay help
  xdotool key F1
  await "F1 closes it" is overlay "$2"
}

echo "settings that cannot be used are reported, and stay as they are"
mkdir -p "${settings%/*}"
printf 'format = 1\nmarker = "up"\n' >"$settings"
open_trainer
await "the problem is there" is overlay problem
contains problem "settings.toml" || fail "it names no file"
xdotool key Return
await "the page is there" is overlay ""
xdotool key F3
await "F3 shows the settings" is overlay settings
await "their buttons are there" is_not settings_depth_1_x ""
click_on settings_depth_1
await "the setting is taken" is depth_unit mm
kept 'marker = "up"' || fail "the damaged file was replaced"
end_trainer
rm "$settings"

echo "the start page has help and settings, and settings are kept"
open_trainer
await "the page is there" is start_task first_scan
help_and_back "the start page" ""
xdotool key F3
await "F3 shows the settings" is overlay settings
await "their buttons are there" is_not settings_marker_1_x ""
help_and_back "the settings" settings
for choice in settings_marker_1 settings_depth_1 settings_text_1 settings_tint_1 settings_quality_0; do click_on $choice; done
for line in 'marker = "right"' 'lengths = "mm"' 'text_size = "large"' 'tint = "warm"' 'quality = "fast"'; do
  await "$line is kept" kept "$line"
done

echo "the folder for files is looked for and chosen"
mkdir -p "$work/files"
click_on settings_out_choose
await "the dialog is open" is overlay open
help_and_back "the dialog" open
await "the field takes text" is typing true
xdotool key ctrl+a
xdotool type "$work/files"
xdotool key Return
sleep 0.5  # the folder is gone into
xdotool key Return
await "the settings are there again" is overlay settings
await "the folder is kept" kept "out = \"$work/files\""
xdotool key Escape
await "the page is there again" is overlay ""
end_trainer

echo "a later start has the settings: the marker is on the right"
rm -f "$state"
"$program" --tracker mouse: --state-file "$state" >"$work/log" 2>&1 &
trainer=$!
await "the briefing is read" is overlay briefing
help_and_back "the briefing" briefing
xdotool key Return
await "the scan is there" is_not face_x ""
awk -v o="$(value plane_origin_x)" -v t="$(value plane_at_10_10_mm_x)" 'BEGIN { exit !(t > o) }' ||
  fail "the marker's side is on the left"
xdotool key F3
await "F3 shows the settings" is overlay settings
await "their buttons are there" is_not settings_marker_0_x ""
click_on settings_marker_0
xdotool key Escape
await "the scan is there again" is overlay ""
left() { awk -v o="$(value plane_origin_x)" -v t="$(value plane_at_10_10_mm_x)" 'BEGIN { exit !(t < o) }'; }
await "the marker changes sides at once" left

end_trainer

echo "a picture is saved as it is seen, and a clip"
water "$work/water.mha"
rm -f "$state"
"$program" --ct "$work/water.mha" --tracker mouse: --state-file "$state" >"$work/log" 2>&1 &  # without a clock
trainer=$!
await "the scan is there" is_not face_x ""
await "the picture is there" at_rest
xdotool key p
await "the toast names it" contains toast "Saved .*\.png in $work/files/pictures"
pictures=("$work/files/pictures/"*.png)
shot "$work/seen.png" ultrasound
await "the toast offers the folder" is_not show_folder_x ""
sleep 6.5  # the toast goes
shot "$work/seen.png" ultrasound
[ "$(different "${pictures[0]}" "$work/seen.png")" -lt 2000 ] ||
  fail "the saved picture is another: $(different "${pictures[0]}" "$work/seen.png") pixels differ"
xdotool key l
await "the clip is made" is clip true
xdotool keydown Left
sleep 1.5
xdotool keyup Left
xdotool key l
await "it is saved" contains toast ".webm"
[ "$(head -c 4 "$work/files/pictures/"*.webm | od -An -tx1 | tr -d ' ')" = 1a45dfa3 ] || fail "it is not a WebM"

echo "a frozen picture is saved without its buttons, and what is placed in it goes back first"
xdotool key space
await "the buttons are there" is_not tool_clear_x ""
click_plane -10 20
click_plane 10 20
await "a length is measured" is_not placed ""
button_of() { convert "$1" -crop "$(value tool_clear_w)x$(value tool_clear_h)+$2+$3" +repage "$4"; }
import -window root "$work/screen.png"
sleep 6.5  # the clip's toast goes
xdotool key p
two_pictures() { [ "$(find "$work/files/pictures" -name '*.png' | wc -l)" -ge 2 ]; }
await "it is saved" two_pictures
saved=$(find "$work/files/pictures" -name '*.png' | sort | tail -1)
button_of "$work/screen.png" "$(value tool_clear_x)" "$(value tool_clear_y)" "$work/button.png"
button_of "$saved" $(($(value tool_clear_x) - $(value ultrasound_x))) $(($(value tool_clear_y) - $(value ultrasound_y))) \
  "$work/without.png"
[ "$(different "$work/button.png" "$work/without.png")" -gt 300 ] || fail "the saved picture has a button"
gain=$(value gain_db)
xdotool key plus
await "the gain changes" is_not gain_db "$gain"
sleep 0.8
xdotool key ctrl+z
await "the gain is back" is gain_db "$gain"
is_not placed "" || fail "the length went before the gain that was changed after it"
sleep 0.8
xdotool key ctrl+z
await "the length is gone" is placed ""
xdotool key space
await "the picture runs" is frozen false

echo "a knob and a move go back, and forward again"
depth=$(value depth_mm)
xdotool key bracketleft
await "the depth changes" is_not depth_mm "$depth"
shallow=$(value depth_mm)
sleep 0.8
remember_probe
xdotool keydown Right
await "the probe moves" far_enough
xdotool keyup Right
sleep 0.8
xdotool key ctrl+z
back() { ! far_enough; }
await "the probe is back" back
is depth_mm "$shallow" || fail "the depth went with it"
sleep 0.8
xdotool key ctrl+z
await "the depth is back" is depth_mm "$depth"
sleep 0.8
xdotool key ctrl+y
await "and forward again" is depth_mm "$shallow"

echo "the patient is seen from the sides, and as at first"
yaw=$(value camera_yaw_deg)
xdotool key v
await "from the front" is camera_yaw_deg 0.0
xdotool key v
await "from the left" is camera_yaw_deg 90.0
click_on view_feet
await "from the feet" is camera_pitch_deg -89.0
xdotool key Home
await "as at first" is_not camera_pitch_deg -89.0
moved camera_yaw_deg "$yaw" 20 && fail "the first view is another: $(value camera_yaw_deg), not $yaw"

echo "F11 fills the screen, and gives the window back"
width=$(value ultrasound_w)
xdotool key F11
await "the ultrasound grows" moved ultrasound_w "$width" 50
xdotool key F11
await "the window is as before" is ultrasound_w "$width"

echo "a clip ends when the scan is left"
clips() { find "$work/files/pictures" -name '*.webm' | wc -l; }
xdotool key l
await "the clip is made" is clip true
xdotool keydown Left
sleep 1
xdotool keyup Left
xdotool key Escape
await "the page is there" is_not start_task ""
await "the clip has ended" is clip false
two() { [ "$(clips)" = 2 ]; }
await "it is saved" two
end_trainer

echo "a replay has help too"
open_trainer replay "$INSONATE_ASSETS/logs/ruq_good.igs.mha"
await "the replay is there" is_not replay_s ""
help_and_back "the replay" ""
end_trainer
