#!/usr/bin/env bash
# An exam done in the window by clicks and keys: a question, a measurement, a point and a number, with a hint and
# something taken back on the way. What was recorded of it scores as the exam did, to the byte.
#   window_exam_test.sh PROGRAM ASSETS_FOLDER SCORE_PROGRAM
score=$3
. "$(dirname "$0")/window_session.sh"

cat >"$work/exam.toml" <<'EOF'
format = 2
title = "Tools"
briefing = "Try each of the tools."
case = "abdomen"
pass_mark_percent = 50
time_limit_s = 900

[[step]]
kind = "question"
title = "Judgement"
instruction = "Is this a test?"
choices = ["yes", "no"]
right = "yes"

[[step.hint]]
text = "It is."
cost = 0.25

[[step.criterion]]
metric = "answer_right_percent"
full = 100
zero = 0

[[step]]
kind = "measure"
title = "Length"
instruction = "Freeze and measure."
view = "pelvis"
tool = "distance"
walls = "inner to inner"

[[step.target]]
structures = ["bladder"]

[[step.criterion]]
metric = "measurement_error_mm"
full = 5
zero = 1000

[[step]]
kind = "mark_point"
title = "Point"
instruction = "Point at the bladder."
structures = ["bladder"]

[[step.criterion]]
metric = "point_error_mm"
full = 5
zero = 1000

[[step]]
kind = "question"
title = "Number"
instruction = "How long was it?"
answer = "number"
right_number = 41.5
within = 1
unit = "mm"

[[step.criterion]]
metric = "answer_right_percent"
full = 100
zero = 0
EOF


start_trainer --scenario "$work/exam.toml" --tracker mouse: --record "$work/run.igs.mha"

echo "the briefing is read before the time runs"
await "the briefing is shown" is overlay briefing
sleep 2
awk -v t="$(value elapsed_s)" 'BEGIN { exit t > 0 }' || fail "the time runs while the briefing is read"
xdotool key Tab
click_on start
await "the briefing is over" is overlay ""
await "the exam starts" is activity exam
await "the probe is seen" is_not face_x ""

echo "a hint is taken by its button, an answer chosen by a click and given by Enter"
await "the hint's button is there" is_not hint_x ""
click_on hint
await "the hint is taken" is hints 1
click_on choice_2
await "a choice is drafted" is draft no
xdotool key 1
await "a key chooses another" is draft yes
xdotool key Return
await "the answer ends the step" is step 1

echo "G leads to the view that the step asks for, and ends that"
is guided_to "" || fail "there is a guide that nobody asked for"
xdotool key g
await "the guide leads there" is guided_to pelvis
xdotool key g
await "the guide is off" is guided_to ""

echo "no time passes while the help covers the screen"
xdotool key F1
await "the help is shown" is overlay help
stands() { local at; at=$(value elapsed_s); sleep 1; [ "$(value elapsed_s)" = "$at" ]; }
await "the time stands still" stands
xdotool key Escape
await "the help is closed" is overlay ""
! stands || fail "the time does not go on"

echo "calipers are placed in the frozen picture, dragged, taken back and placed again"
is can_measure false || fail "a running picture is measured in"
remember_probe
xdotool key space
await "the picture is frozen" is can_measure true
depth=$(value depth_mm)
click_plane -20 60
click_plane 20 60
placed() { [ -n "$(value placed)" ]; }
await "two clicks place a caliper" placed
awk -v p="$(value placed)" 'BEGIN { split(p, a, " "); exit !(a[1] == 1 && a[2] > 39 && a[2] < 41) }' ||
  fail "40 mm were measured as: $(value placed)"
# From the end towards the marker 1.5 mm on.
pointer_to "$(plane_x 20)" "$(plane_y 60)"
xdotool mousedown 1
pointer_to "$(plane_x 30)" "$(plane_y 60)"
xdotool mouseup 1
longer() { awk -v p="$(value placed)" 'BEGIN { split(p, a, " "); exit !(a[2] > 49 && a[2] < 51) }'; }
await "an end is dragged" longer
! far_enough || fail "the probe moved while its picture was measured in"
xdotool key BackSpace
shorter() { awk -v p="$(value placed)" 'BEGIN { split(p, a, " "); exit !(a[2] > 39 && a[2] < 41) }'; }
await "Backspace takes it back" shorter
xdotool key Delete
await "Delete takes all back" is placed ""
xdotool key bracketright
await "the depth of a frozen picture stays, with a word why" contains toast "press Space to scan on, then change the depth"
click "$(middle_x probe_linear)" "$(middle_y probe_linear)"
await "frames go by, in which a click on another probe does nothing" at_rest
xdotool key space
await "the picture runs" is frozen false
is depth_mm "$depth" && is probe curvilinear || fail "a frozen picture was acquired anew"
xdotool key bracketright bracketright
await "the picture is drawn deeper" is_not depth_mm "$depth"
xdotool key space
await "the picture is frozen again" is can_measure true
sleep 1
click_plane -20.75 70
click_plane 20.75 70
measured() { awk -v p="$(value placed)" 'BEGIN { split(p, a, " "); exit !(a[2] > 41 && a[2] < 42) }'; }
await "41.5 mm are 41.5 mm at another scale too" measured
import -window root "$work/measured.png"
shown=$(value placed)
click_on go_on
await "the button goes on" is step 2

echo "a step that is not done is left at the second asking only; a point is placed by a click"
xdotool key Return
sleep 1
is step 2 || fail "one Return left a step that was not done"
click_plane 0 70
await "a click places the point" is placed "point; "
xdotool key Return
await "Return goes on" is step 3

echo "a number is typed into its field; keys that are typed do not move the probe"
xdotool key space
await "the picture runs" is frozen false
remember_probe
xdotool key Return
await "Return opens the field" is typing true
xdotool type "ad41.7"
xdotool key Home Delete Delete
await "it is typed" is draft 41.7
! far_enough || fail "what was typed moved the probe"
xdotool key Return
await "the exam ends" is overlay score
is toast "" || fail "the sheet comes with words of the step before: $(value toast)"
kill -0 "$trainer" || fail "the trainer ended by itself"

echo "a sheet that was closed is shown again by its key and by its button"
xdotool key Escape
await "Escape closes the sheet" is overlay ""
xdotool key F4
await "F4 shows it again" is overlay score
xdotool key F4
await "F4 closes it" is overlay ""
await "there is a button" is_not score_sheet_x ""
click_on score_sheet
await "the button shows it" is overlay score
xdotool key Escape
await "Escape closes it again" is overlay ""
xdotool key r
await "the recording ends" is recording ""
written() { [ -s "$work/run.igs.mha" ]; }
await "the file is made" written
await "the screen names it" contains toast "run.igs.mha in $work"

echo "the recording scores as the exam did"
made=$(dirname "$(value report)")/score.json
[ -s "$made" ] || fail "there is no score"
"$score" --log "$work/run.igs.mha" --scenario "$work/exam.toml" >"$work/again.json" 2>"$work/score.log" || fail "$(cat "$work/score.log")"
without_origin() { grep -v -e '"log' -e '"mode"' "$1"; }
cmp <(without_origin "$made") <(without_origin "$work/again.json") || fail "the recording has another score"
grep -q '"mode": "practice"' "$made" || fail "the attempt does not say that it is practice"
grep -q '"mode": "recording"' "$work/again.json" || fail "the recording does not say that it is one"
for what in '"guide_times": 1' '"answer"' '"yes"' '"measured"' '"41.7"' '"point_error_mm"'; do
  grep -q -- "$what" "$work/again.json" || fail "the score does not say $what"
done
grep -q -- "$(echo "$shown" | sed 's/^1 \(.*\); $/\1/')" "$work/again.json" || fail "what was shown, '$shown', was not scored"
grep -q '"passed": true' "$work/again.json" || fail "the exam was not passed"

echo "an exam that cannot be taken says why, and then the program ends"
kill "$trainer"
start_trainer exam --scenario "$work/exam.toml" --tracker "replay:$work/run.igs.mha" --learner L-07 --results "$work/lab.db"
await "it is refused" contains problem "a recorded scan is nobody's exam"
is overlay problem || fail "the refusal is not shown"
xdotool key Return
wait "$trainer" || fail "it ended with $?"

echo "an exam that has not begun can be left, and nothing is kept of it"
start_trainer exam --scenario "$work/exam.toml" --tracker mouse: --learner L-09 --results "$work/lab.db"
await "the briefing is shown" is overlay briefing
xdotool key ctrl+q
wait "$trainer" || fail "it ended with $?"

echo "an exam that counts is handed in by leaving twice, and not by leaving once"
start_trainer exam --scenario "$work/exam.toml" --tracker mouse: --learner L-08 --results "$work/lab.db"
await "the briefing is shown" is overlay briefing
xdotool key Return
await "the exam begins" is overlay ""
xdotool key ctrl+q
await "the screen says what a second time does" contains toast "once more"
kill -0 "$trainer" || fail "one key ended an exam that counts"
xdotool key ctrl+q
wait "$trainer" || fail "it ended with $?"
"$score" attempts "$work/lab.db" >"$work/attempts.txt" 2>&1 || fail "$(cat "$work/attempts.txt")"
! grep -q "L-09" "$work/attempts.txt" || fail "an exam that had not begun was handed in"
grep -q "L-08.*exam" "$work/attempts.txt" || fail "the exam was not handed in: $(cat "$work/attempts.txt")"
echo "passed"
