#!/usr/bin/env bash
# The start page in a real window: what it begins by keys and clicks, and the ways back to it.
#   window_start_test.sh PROGRAM ASSETS_FOLDER
. "$(dirname "$0")/window_session.sh"
is_page() { is_not start_task "" && is overlay "${1:-}"; }

echo "a missing file is reported over the page"
open_trainer --ct "$work/nowhere.nii.gz"
await "the problem lies over the page" is_page problem
contains problem "nowhere.nii.gz" || fail "the problem names no file"
xdotool key Return
await "the page is there" is_page
end_trainer

echo "without arguments the page is there, and the demonstration says what it is"
open_trainer
await "the page is there" is_page
is start_task first_scan || fail "it begins with $(value start_task)"
xdotool key Down
await "Down goes to the next task" is start_task demonstration
xdotool key Return
await "it begins" is demonstration true
xdotool key F1
await "F1 shows help beside it" is overlay help
xdotool key Escape
await "Escape closes it" is overlay ""
await "the recorded scan ends" is_not percent ""
is overlay "" || fail "somebody else's score lies over the window"
xdotool key F1
await "F1 shows help after its end" is overlay help
xdotool key Escape
await "Escape closes it" is overlay ""
xdotool key Tab
await "Tab takes the probe after its end too" is holder learner
is activity exam || fail "there is nothing to try"
is overlay "" || fail "somebody else's score lies over the window"
xdotool key Tab
await "Tab says that it ends the steps" contains toast "once more"
is demonstration false || fail "the steps have ended at once"
xdotool key Tab
await "Tab gives it back, and the demonstration begins anew" is demonstration true
click_on own_try
await "the exam is one's own" is holder learner
is activity exam || fail "there is nothing to try"
is demonstration false || fail "one's own try is called a demonstration"

echo "Escape asks before it leaves steps that are not finished"
await "the time runs" is_not elapsed_s 0.0
xdotool key Escape
await "it asks" is overlay leave
xdotool key Escape
await "Escape stays" is overlay ""
is activity exam || fail "the steps were left"
xdotool key Escape
await "it asks" is overlay leave
xdotool key Return
await "Return leaves" is_page

echo "from free practice a button leads to the briefing of steps, and back"
click_on task_practice
await "the scenarios are there" is start_task practice
await "free practice is offered" is_not scenario_free_x ""
click_on scenario_free
click_on begin
await "practice begins" is activity practice
await "the button for steps is there" is_not steps_x ""
click_on steps
await "the steps are explained first" is overlay briefing
xdotool key Escape
await "Escape leads back" is overlay ""
is activity practice || fail "it leads to $(value activity)"
click_on steps
await "the steps are explained again" is overlay briefing
xdotool key Return
await "Return begins them" is activity exam
await "the time runs" is_not elapsed_s 0.0
click_on practice
await "the button for practice says that it ends them" contains toast "once more"
is activity exam || fail "the steps have ended at once"
click_on practice
await "a second click leaves them for practice" is activity practice
click_on steps
await "the steps are explained again" is overlay briefing
xdotool key Return
await "Return begins them" is activity exam
await "the time runs" is_not elapsed_s 0.0
xdotool key Escape
await "it asks" is overlay leave
xdotool key Return
await "Return leaves" is_page

echo "a learner is named, and only then an exam can begin"
click_on task_exam
await "the exams are there" is start_task exam
contains start_why_not "who is learning" || fail "the page does not say what is missing: $(value start_why_not)"
click_on learner_field
await "the field takes text" is typing true
xdotool type "L/07"
xdotool key Return
await "the id is refused" is overlay problem
xdotool key Return
await "the page says what to correct" contains start_why_not "'L/07' is not an id"
click_on learner_field
await "the field takes text" is typing true
xdotool type "L-07"
xdotool key Return
await "the learner is known" is start_learner L-07
contains start_why_not ': ""' || fail "$(value start_why_not)"

echo "an exam can be left before it begins, and once it runs it says why not"
click_on task_exam
xdotool key Return
await "the exam is explained first" is overlay briefing
xdotool key Escape
await "Escape leads back" is_page
is start_task exam || fail "it leads to $(value start_task)"
xdotool key Return
await "the exam is explained again" is overlay briefing
await "the briefing names the learner" is_not learner_x ""
xdotool key Return
await "it counts" is strict true
await "the exam is begun" is overlay ""
await "the steps name the learner" is_not learner_x ""
await "it runs" is_not elapsed_s 0.0
xdotool key Escape
await "Escape says why it stays" contains toast "This exam counts: go on to its end"
is overlay "" || fail "something lies over the exam"
xdotool key g
await "G says why there is no guide" contains toast "it has no guide"
over() { xdotool key Return; sleep 0.3; is_not percent ""; }
await "Return goes on to its end" over
await "the score is shown" is overlay score
await "the score names the learner" is_not learner_x ""
xdotool key Escape
await "Escape closes the score" is overlay ""
xdotool key Escape
await "and the next one leaves" is_page
is start_task exam || fail "it leads to $(value start_task)"

echo "F2 does not end steps, and without a sensor leads to the choice of a tracker"
click_on task_first_scan
await "the first scan is chosen" is start_task first_scan
click_on begin
await "it is explained first" is overlay briefing
xdotool key Return
await "the guide is on" is guided_to liver_subcostal
xdotool key F2
await "F2 says to leave the steps first" contains toast "Leave these steps first"
is guided_to liver_subcostal || fail "F2 has ended the steps"
xdotool key Escape
await "it asks" is overlay leave
xdotool key Return
await "Return leaves" is_page
xdotool key F2
await "F2 shows the page's trackers" is start_task setup
contains start_why_not "no sensor" || fail "$(value start_why_not)"

echo "a tracker on the network is set up, without a pose nothing can be marked, and the way back is the page"
click_on tracker_address
await "the field takes text" is typing true
xdotool type "127.0.0.1:1"
xdotool key Return
await "the tracker is chosen" is start_tracker "igtl://127.0.0.1:1"
click_on begin
await "the set-up opens" is overlay setup
xdotool key Escape
await "Escape leads back" is_page
is start_task setup || fail "it leads to $(value start_task)"
click_on tracker_mouse:
await "the mouse is chosen again" is start_tracker mouse:

echo "a folder is gone into, and what is in it is opened by clicks"
mkdir -p "$work/scans/of_water/deeper"
water "$work/scans/of_water/water.mha"
xdotool key ctrl+o
await "the dialog is there" is overlay open
xdotool type "$work/scans"
await "the folder that is typed is listed" is_not entry_of_water_x ""
pointer_to "$(middle_x entry_of_water)" "$(middle_y entry_of_water)"
sleep 0.5
xdotool click --repeat 2 --delay 60 1
await "a double click goes into it, and no deeper" is_not entry_water.mha_x ""
sleep 0.5
is_not entry_water.mha_x "" || fail "the second click has gone deeper"
click_on entry_water.mha
sleep 0.5
click_on open_path
await "the CT is the patient" is patient water.mha
click_on start_page
await "the button leads back" is_page

echo "keys choose in the list too: the folder, and the CT below it"
xdotool key ctrl+o
await "the dialog is there" is overlay open
await "it lists the folder of the last time" is_not entry_water.mha_x ""
for key in Down Down Return; do
  sleep 0.5
  xdotool key "$key"
done
await "the CT is scanned" is_not face_x ""
click_on start_page
await "the button leads back" is_page

kill -0 "$trainer" || fail "the trainer ended by itself"
echo "passed"
