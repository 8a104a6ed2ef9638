#!/usr/bin/env bash
# The check of a scenario in a real window: its problems, again whenever an editor saves it, and practice of it.
#   window_check_test.sh PROGRAM ASSETS_FOLDER INSONATE_SCORE
. "$(dirname "$0")/window_session.sh"
score=$3
scenario="$work/exam.toml"
# The bundled exam on a patient that is made in a second.
right() { sed 's/^free_fluid = true$/&\nvoxel_mm = 4/' "$INSONATE_ASSETS/scenarios/ruq_hepatorenal.toml"; }
right | sed 's/^pass_mark_percent/pass_mark/; s/view = "hepatorenal"/view = "hepatorenl"/' >"$scenario"

echo "the command line names a scenario, and the window shows what insonate-score check reports"
open_trainer check "$scenario"
await "the check is done" is check_state wrong
problems=$("$score" check "$scenario" 2>&1 | grep -c "line ") || true
is check_problems "$problems" || fail "$(value check_problems) problems are shown, $problems reported"
line=$(grep -n "^pass_mark" "$scenario" | cut -d: -f1)
is check_line "$line" || fail "line $(value check_line) is shown first, not $line"
await "its line is marked" is_not "line_${line}_x" ""
amber_in "line_$line" 50 || fail "the mark is not to be seen"
xdotool key Down
line=$(grep -n "hepatorenl" "$scenario" | cut -d: -f1)
await "Down goes to the next problem" is check_line "$line"
await "and its line comes into view" is_not "line_${line}_x" ""
click_on problem_0
await "a click goes back" is_not check_line "$line"
xdotool key F1
await "F1 shows help" is overlay help
xdotool key F1
await "F1 closes it" is overlay ""
xdotool key Return
sleep 0.5
is check_state wrong || fail "a scenario with problems is practised"

echo "it is checked again when an editor saves it, and can be practised once it is right"
right >"$work/saved"
mv "$work/saved" "$scenario"
await "nothing is wrong" is check_state right
is check_problems 0 || fail "there are problems left"
checks=$(value checks)
await "a file that stays is not checked again" shows_nothing
is checks "$checks" || fail "it was checked again"
xdotool key Return
await "it is practised, briefing first" is overlay briefing
xdotool key Return
await "the scan is there" is_not face_x ""
is activity exam || fail "the steps are not there"
xdotool key Escape
await "steps that are not finished are asked about" is overlay leave
xdotool key Return
await "the way back is the check" is check_file "$scenario"

echo "a file that goes is missed, and one that is dropped or chosen is checked"
rm "$scenario"
await "it is missed" is check_state wrong
contains check_failure "exam.toml" || fail "no sentence says what is missing: $(value check_failure)"
right >"$scenario"
await "it is there again" is check_state right
xdotool key Escape
await "Escape leads to the start page" is_not start_task ""
click_on task_practice
await "the scenarios are there" is start_task practice
await "and the way to check one" is_not check_x ""
click_on check
await "the dialog is there" is overlay open
xdotool type "$scenario"
xdotool key Return
await "what was typed is checked" is check_file "$scenario"
await "and right" is check_state right
kill -0 "$trainer" || fail "the trainer ended by itself"
echo "passed"
