#!/usr/bin/env bash
# A run is looked at again in a real window: played, paused, dragged along its time line, stepped sample by sample.
# Whatever way a time is come to, the screen shows the same.
#   window_replay_test.sh PROGRAM ASSETS_FOLDER
. "$(dirname "$0")/window_session.sh"
logs="$INSONATE_ASSETS/logs"
start_trainer replay "$logs/ruq_poor.igs.mha" --beside "$logs/ruq_good.igs.mha"

# The x of a share of the time line, in per cent.
along() { echo $(($(value timeline_x) + $(value timeline_w) * $1 / 100)); }
drag_to() {
  pointer_to "$(along 3)" "$(middle_y timeline)"
  sleep 0.3
  xdotool mousedown 1
  for share in 10 $((($1 + 10) / 2)) "$1"; do
    pointer_to "$(along "$share")" "$(middle_y timeline)"
    sleep 0.2
  done
  xdotool mouseup 1
}
# Whether the time is within half a per cent of that share of the run.
at_share() {
  awk -v t="$(value replay_s)" -v d="$(value replay_duration_s)" -v s="$1" 'BEGIN { exit !((t/d - s/100)^2 < 0.005^2) }'
}
later_than() { awk -v t="$(value replay_s)" -v a="$1" 'BEGIN { exit !(t > a) }'; }
press_button() { click "$(middle_x "$1")" "$(middle_y "$1")"; }

echo "the run stands at its beginning, and is nobody's exam"
await "the run is shown" is replay_s 0.0
await "poses are there" is_not face_x ""
[ -z "$(value activity)" ] || fail "there is a session beside the replay"

echo "a click plays it, another pauses it"
press_button replay_play
await "it plays" is replay_playing true
await "the time runs" later_than 0.5
press_button replay_play
await "it pauses" is replay_playing false
stands=$(value replay_s)
sleep 1
is replay_s "$stands" || fail "it goes on while it is paused: $stands, $(value replay_s)"

echo "the time line is dragged, and the same time shows the same screen"
drag_to 60
await "the time follows the pointer" at_share 60
await "the picture is drawn in full" at_rest
sixty=$(value replay_s) face=$(value face_x)
shot "$work/first.png" ultrasound 20
shot "$work/first_timeline.png" timeline
remember_probe
drag_to 30
await "the time follows the pointer back" at_share 30
await "the probe goes with it" far_enough
xdotool key End
at_end() { is replay_s "$(value replay_duration_s)"; }
await "End goes to the end" at_end
drag_to 60
await "the time is the one before" is replay_s "$sixty"
is face_x "$face" || fail "the probe is elsewhere at the same time: $face, $(value face_x)"
await "the picture is drawn in full" at_rest
shot "$work/again.png" ultrasound 20
pixels=$(different "$work/first.png" "$work/again.png")
[ "$pixels" = 0 ] || fail "$pixels pixels of the ultrasound differ at the same time"
shot "$work/again_timeline.png" timeline
pixels=$(different "$work/first_timeline.png" "$work/again_timeline.png")
[ "$pixels" = 0 ] || fail "$pixels pixels of the time line differ at the same time"
drag_to 61
await "the time follows the pointer on" at_share 61
await "the picture is drawn in full" at_rest
shot "$work/other.png" ultrasound 20
pixels=$(different "$work/first.png" "$work/other.png")
[ "$pixels" -gt 500 ] || fail "the picture does not follow the time: $pixels pixels changed"

echo "keys step by samples and change the speed"
before=$(value replay_s)
xdotool key Right
await "the right arrow goes on by a sample" is_not replay_s "$before"
awk -v a="$before" -v b="$(value replay_s)" 'BEGIN { exit !(b > a && b - a < 0.1) }' || fail "it went on by more than a sample"
xdotool key Home
await "Home goes to the beginning" is replay_s 0.0
xdotool key Up
await "up is faster" is replay_speed 2.0
press_button replay_speed_5
await "a click chooses a speed" is replay_speed 8.0
xdotool key space
await "it plays to its end by itself" at_end
await "and pauses there" is replay_playing false

echo "nothing of it is scored or kept"
[ ! -e "$work/out" ] || fail "there are results: $(ls "$work/out")"
[ ! -e "$work/data" ] || fail "something was kept: $(find "$work/data")"

echo "a scenario that is opened ends the replay and begins a session"
xdotool key ctrl+o
await "Ctrl O asks for a path" is overlay open
xdotool type "$INSONATE_ASSETS/scenarios/ruq_hepatorenal.toml"
xdotool key Return
await "the session begins" is activity exam
[ -z "$(value replay_s)" ] || fail "the replay is still there"
kill -0 "$trainer" || fail "the trainer ended by itself"

echo "what was measured lies over the frozen picture from when it was placed"
kill "$trainer"
measured=("$logs/aorta_good.igs.mha" --scenario "$INSONATE_ASSETS/scenarios/aorta.toml")
# Makes this variant's patient, which may take longer than a window is waited for.
"$program" replay --headless "${measured[@]}" --seconds 0.1 --out "$work/once" >"$work/log" 2>&1 || fail "no patient for the run"
start_trainer replay "${measured[@]}"
await "the run is shown" is replay_s 0.0
drag_to 33
await "the picture is frozen, and nothing is placed yet" is frozen true
await "the picture is drawn in full" at_rest
is placed "" || fail "it is placed before its time: $(value placed)"
shot "$work/bare.png" ultrasound 20
drag_to 38
await "the caliper is there" is placed "1 21.6 mm; "
await "the picture is drawn in full" at_rest
shot "$work/measured.png" ultrasound 20
pixels=$(different "$work/bare.png" "$work/measured.png")
[ "$pixels" -gt 300 ] || fail "the caliper is not drawn: $pixels pixels changed"
drag_to 44
await "it goes with its picture" is placed ""
echo "passed"

echo "a recording's own images lie beside the simulated picture, each tissue at the same place of both"
kill "$trainer"
"$program" --headless --seconds 3 --record "$work/scan.igs.mha" --record-images --out "$work/once" >"$work/log" 2>&1 \
  || fail "no recording with images"
start_trainer replay "$work/scan-images.igs.mha"
await "the run is shown" is replay_s 0.0
drag_to 70
await "the time follows the pointer" at_share 70
await "the picture is drawn in full" at_rest
# Without what is written around both pictures.
shot "$work/simulated.png" ultrasound 110
shot "$work/recorded.png" recorded 110
# Speckle is another between two samples of the tracker; tissue is not.
for picture in simulated recorded; do convert "$work/$picture.png" -blur 0x4 "$work/$picture.png"; done
alike() { compare -metric NCC "$1" "$2" null: 2>&1 || true; }
likeness=$(alike "$work/simulated.png" "$work/recorded.png")
awk -v l="$likeness" 'BEGIN { exit !(l > 0.9) }' || fail "the recorded image is another: correlation $likeness"
# At no place beside it is the recorded image as much alike: 3 pixels aside it is less, so that it is off by less than 2,
# and 8 pixels aside it is half as unlike again.
for shift in +3 -3 +8 -8; do
  convert "$work/recorded.png" -roll "${shift}+0" "$work/elsewhere.png"
  shifted=$(alike "$work/simulated.png" "$work/elsewhere.png")
  echo "likeness $likeness, $shift pixels beside it $shifted"
  awk -v l="$likeness" -v s="$shifted" -v by="$shift" \
    'BEGIN { exit !(1 - s > (by * by > 9 ? 1.5 : 1) * (1 - l)) }' || fail "a shift by $shift pixels does not show"
done
