#!/usr/bin/env bash
# The page of learners in a real window: it is found, shows whom and what is clicked, keeps comments, writes a report and
# tables, and leads to a review and back.
#   window_learners_test.sh PROGRAM ASSETS_FOLDER SCORE_PROGRAM
. "$(dirname "$0")/window_session.sh"
score=$3
lab="$work/lab.db"
for run in "L-01 aorta poor aorta" "L-01 aorta good aorta" "L-02 kidneys poor kidneys" "L-02 aorta good aorta"; do
  read -r learner log hand scenario <<<"$run"
  "$score" --log "$INSONATE_ASSETS/logs/${log}_$hand.igs.mha" --scenario "$INSONATE_ASSETS/scenarios/$scenario.toml" \
    --results "$lab" --learner "$learner" >/dev/null
done
before=$("$score" attempts "$lab")

echo "the page of learners is the last task where there is a database"
"$program" --results "$lab" --out "$work/out" --state-file "$state" >"$work/log" 2>&1 &
trainer=$!
await "the task is there" is_not task_learners_x ""
click_on task_learners
await "it is chosen" is start_task learners
click_on begin
await "the learners are there" is learners 2
await "the attempts of all are listed" is learners_attempts 4
await "the criteria are read" is_not learners_criteria 0

echo "a learner, a scenario and an attempt are chosen by clicks and keys"
click_on learner_L-01
await "the learner is chosen" is learners_learner L-01
is learners_attempts 2 || fail "$(value learners_attempts) attempts"
is learners_attempt 2 || fail "the newest attempt is not chosen: $(value learners_attempt)"
click_on attempt_1
await "another attempt is chosen" is learners_attempt 1
xdotool key Down
await "Down goes to the next learner" is learners_learner L-02
is learners_scenario Aorta || fail "the trend is of $(value learners_scenario)"
click_on scenario_after
await "another scenario is shown" is learners_scenario Kidneys
click_on learner_L-01
await "the learner is chosen again" is learners_learner L-01
click_on attempt_1
await "and the attempt" is learners_attempt 1

echo "comments are typed, kept, forgotten and removed"
click_on author_field
await "the field takes text" is typing true
xdotool type "T-02"
xdotool key Return
await "the author is known" is learners_author T-02
click_on comment_field
await "the field takes text" is typing true
xdotool type "Slow down"
xdotool key Return
await "the comment is kept" is learners_comment "Slow down"
click_on comment_field
await "the field takes text" is typing true
xdotool type "Not this"
xdotool key Escape
await "Escape closes the field" is typing false
is learners_comments 1 || fail "what was given up is kept"
click_on comment_field
await "the field takes text" is typing true
xdotool type "Well held"
click_on add_comment
await "the button keeps a comment" is learners_comments 2
"$score" attempts "$lab" | grep -q "comment 1 on attempt 1 by T-02, .*: Slow down$" || fail "no comment is stored"
await "it can be removed" is_not remove_comment_2_x ""
click_on remove_comment_2
sleep 0.5
is learners_comments 2 || fail "one click removes a comment"
click_on remove_comment_2
await "the second click removes it" is learners_comments 1

echo "a name in place of an id is refused, and no comment is stored without it"
click_on comment_field
await "the field takes text" is typing true
xdotool type "By whom"
click_on author_field
sleep 0.5
xdotool key ctrl+a
xdotool type "Dr Jones"
click_on add_comment
await "a message says why" is overlay problem
xdotool key Escape
sleep 0.5
is overlay problem && xdotool key Escape
await "the message goes" is overlay ""
click_on add_comment
await "it comes again with another try" is overlay problem
xdotool key Escape
await "the message goes" is overlay ""
is learners_comments 1 || fail "the comment is stored without its author"
click_on author_field
await "the field takes text" is typing true
xdotool key ctrl+a
xdotool type "T-02"
xdotool key Return
click_on add_comment
await "it is stored with the id" is learners_comments 2
click_on remove_comment_3
sleep 0.5
click_on remove_comment_3
await "it is removed" is learners_comments 1

echo "a report and the tables are written, and nothing of an attempt changes"
click_on write_report
await "the toast names the report" contains toast "report.html"
grep -q "Slow down" "$work"/out/attempts/*/report.html || fail "the report lacks the comment"
click_on write_tables
await "the toast names the folder" contains toast "out/tables/"
grep -q '"Slow down"' "$work"/out/tables/*/comments.csv || fail "the tables lack the comment"
[ "$("$score" attempts "$lab" | grep -v "^comment")" = "$before" ] || fail "the attempts have changed"

echo "a review leads back to the page, and Escape to the start page"
click_on review
await "the attempt is replayed" is replay_s 0.0
xdotool key Escape
await "Escape leads back to the learners" is learners 2
is learners_learner L-01 || fail "another learner is shown: $(value learners_learner)"
is learners_attempt 1 || fail "another attempt is shown: $(value learners_attempt)"
is learners_author T-02 || fail "the author is forgotten"
xdotool key Return
await "Return reviews it too" is replay_s 0.0
await "the way back is there" is_not start_page_x ""
click_on start_page
await "the button leads back too" is learners 2
xdotool key Escape
await "Escape leads to the start page" is_not start_task ""
xdotool key Up
sleep 0.5
kill -0 "$trainer" || fail "the trainer ended by itself"
echo "passed"
