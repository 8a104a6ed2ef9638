#!/usr/bin/env bash
# The trainer without a window, as a whole program: the bundled scans get the scores that insonate-score gives them, the
# good one passes, the poor one fails, and bad input ends in one sentence and exit code 2.
#   headless_test.sh INSONATE INSONATE_SCORE ASSETS_FOLDER INSONATE_DEVICES
set -euo pipefail
trainer=$1 score=$2 devices=$4
export INSONATE_ASSETS=$3
unset DISPLAY WAYLAND_DISPLAY
work=$(mktemp -d)
killed=""
trap '[ -z "$killed" ] || kill -9 "$killed" 2>/dev/null; rm -rf "$work"' EXIT
fail() {
  echo "FAILED: $*" >&2
  exit 1
}

scenario="$INSONATE_ASSETS/scenarios/ruq_hepatorenal.toml"
for scan in good poor; do
  log="$INSONATE_ASSETS/logs/ruq_$scan.igs.mha"
  "$score" --log "$log" --scenario "$scenario" >"$work/$scan.json" 2>"$work/log" || fail "$(cat "$work/log")"
  "$trainer" --headless --tracker "replay:$log" --scenario "$scenario" --out "$work/$scan" \
    --results "$work/results.db" --learner "L-$scan" --screenshot "$work/$scan.png" >"$work/$scan.txt" 2>&1 || fail "$(cat "$work/$scan.txt")"
  cmp "$work/$scan.json" "$work/$scan/score.json" || fail "the trainer's score of the $scan scan is another"
  for file in report.html ultrasound.png trainer.png score_sheet.png; do
    [ -s "$work/$scan/$file" ] || fail "$file is missing"
  done
done
"$score" rescore "$work/results.db" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
"$score" report "$work/results.db" --out "$work/reports" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
for file in report.html score.json score.csv xapi.json; do
  cmp "$work/good/$file" "$work/reports/attempt-1/$file" || fail "$file out of the database is another"
done
[ "$(grep -c '<img' "$work/good/report.html")" -gt 0 ] || fail "the report has no pictures"
grep -q '"passed": true' "$work/good.json" || fail "the good scan does not pass"
grep -q '"passed": false' "$work/poor.json" || fail "the poor scan passes"
grep -q 'not passed' "$work/poor.txt" || fail "the trainer does not say that the poor scan failed"
[ "$(identify -format '%wx%h' "$work/good.png")" = 1280x800 ] || fail "the screenshot has another size"

echo "a recorded run is scored as the run itself, and its pictures are a file of their own"
"$trainer" --headless --record "$work/run.igs.mha" --out "$work/recorded" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
"$score" --log "$work/run.igs.mha" --scenario "$scenario" >"$work/run.json" 2>"$work/log" || fail "$(cat "$work/log")"
without_log() { grep -v '"log' "$1"; }
cmp <(without_log "$work/good.json") <(without_log "$work/run.json") || fail "the recorded run has another score"
"$trainer" --headless --record "$work/seen.igs.mha" --record-images --seconds 1 --out "$work/recorded" >"$work/log" 2>&1 ||
  fail "$(cat "$work/log")"
grep -q "^wrote $work/seen-images.igs.mha\$" "$work/log" || fail "the pictures' file is not named"
head -c 1000 "$work/seen-images.igs.mha" | grep -aq '^DimSize = [1-9][0-9]* [1-9][0-9]* [1-9]' || fail "there are no pictures"
[ -z "$(find "$work" -name '*.recording*')" ] || fail "working files are left"

echo "a trainer that is killed has recorded all that it was seen to write"
"$trainer" --headless --tracker "synthetic:1?live=1" --seconds 3600 --record "$work/killed.igs.mha" --out "$work/killed" \
  >"$work/log" 2>&1 &
killed=$!
frames() {
  local count
  count=$(grep -c '^frame ' "$work/killed.igs.mha.recording" 2>/dev/null) || true
  echo "${count:-0}"
}
for _ in $(seq 1 600); do
  [ "$(frames)" -lt 200 ] || break
  sleep 0.2
done
written=$(frames)
kill -9 "$killed"
wait "$killed" 2>/dev/null || true
killed=""  # a trap that fails would be the script's own exit status
[ "$written" -ge 200 ] || fail "only $written frames were written ($(cat "$work/log"))"
[ ! -e "$work/killed.igs.mha" ] || fail "half a recording looks whole"
"$devices" recover "$work/killed.igs.mha" >"$work/log" || fail "$(cat "$work/log")"
recovered=$(sed -n 's/.* with \([0-9]*\) frames$/\1/p' "$work/log")
[ "$recovered" -ge "$written" ] || fail "of $written frames $recovered came back"
"$devices" check "$work/killed.igs.mha" >"$work/log" || [ $? = 1 ] || fail "$(cat "$work/log")"

echo "an exam that counts is begun once, also when the program is killed in the middle"
sit() {
  "$trainer" exam --headless --scenario "$scenario" --seed 3 --tracker "synthetic:1?live=1&rate=60" \
    --results "$work/sitting.db" --learner "$1" --seconds 3600 --out "$work/sitting" >"$work/log" 2>&1
}
for learner in L-07 L-08; do
  sit "$learner" &
  killed=$!
  for _ in $(seq 1 600); do
    "$score" attempts "$work/sitting.db" 2>/dev/null | grep -q "of $learner" && break
    sleep 0.2
  done
  sleep 3
  pkill -9 -P "$killed" || true
  kill -9 "$killed" 2>/dev/null || true
  wait "$killed" 2>/dev/null || true
  killed=""
done
"$score" hand-in "$work/sitting.db" --sitting 2 >"$work/handed.txt" || fail "hand-in ended with $?"
grep -q 'under way, or broken off only just' "$work/handed.txt" || fail "$(cat "$work/handed.txt")"
sit L-08 && fail "an exam was begun twice"
grep -q "the exam was begun at" "$work/log" || fail "$(cat "$work/log")"

echo "how long a live tracker's reports take to the picture is reported"
"$trainer" --headless --tracker "synthetic:1?live=1" --seconds 2 --latency "$work/latency.csv" --out "$work/live" \
  >"$work/log" 2>&1 || fail "$(cat "$work/log")"
grep -q '^from_ms,report_to_frame,report_to_picture$' "$work/latency.csv" || fail "$(cat "$work/latency.csv")"
grep -q '^report to picture: median' "$work/log" || fail "$(cat "$work/log")"

echo "a replay shows an attempt as it shows its log, and keeps nothing"
log="$INSONATE_ASSETS/logs/ruq_good.igs.mha"
"$score" attempts "$work/results.db" >"$work/before.txt"
"$trainer" replay "$log" --headless --scenario "$scenario" --seconds 20 --out "$work/replayed" \
  --screenshot "$work/replay.png" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
"$trainer" replay --headless --results "$work/results.db" --attempt 1 --seconds 20 --out "$work/replayed" \
  --screenshot "$work/attempt.png" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
convert "$work/replay.png" -crop 700x330+40+110 +repage "$work/replay_picture.png"
convert "$work/attempt.png" -crop 700x330+40+110 +repage "$work/attempt_picture.png"
[ "$(compare -metric AE "$work/replay_picture.png" "$work/attempt_picture.png" null: 2>&1 || true)" = 0 ] ||
  fail "the attempt shows another picture than its log"
[ "$(convert "$work/replay_picture.png" -colorspace Gray -format '%[fx:standard_deviation>0.05]' info:)" = 1 ] ||
  fail "the replay shows no picture"
"$score" attempts "$work/results.db" >"$work/after.txt"
cmp "$work/before.txt" "$work/after.txt" || fail "a replay was kept as an attempt"
[ ! -e "$work/replayed" ] || fail "a replay left results: $(ls "$work/replayed")"

# `refuses WORDS ARGUMENTS...`: exit code 2 and one message with the words, whose further lines are a list.
refuses() {
  local words=$1 code=0
  shift
  "$trainer" "$@" --out "$work/none" >"$work/refused.txt" 2>&1 || code=$?
  [ "$code" = 2 ] || fail "exit code $code for: $* ($(cat "$work/refused.txt"))"
  [ "$(grep -vc '^  ' "$work/refused.txt")" = 1 ] || fail "more than a message for: $* ($(cat "$work/refused.txt"))"
  grep -q -- "$words" "$work/refused.txt" || fail "no '$words' in: $(cat "$work/refused.txt")"
  [ ! -e "$work/none" ] || fail "results were written for: $*"
}
printf 'format = 1\ntitel = "x"\n' >"$work/typo.toml"
: >"$work/empty.nii.gz"
head -c 2000 "$INSONATE_ASSETS/logs/ruq_good.igs.mha" >"$work/cut.igs.mha"
refuses missing.toml --headless --scenario "$work/missing.toml"
refuses titel --headless --scenario "$work/typo.toml"
refuses empty.nii.gz --headless --ct "$work/empty.nii.gz"
refuses cut.igs.mha --headless --tracker "replay:$work/cut.igs.mha"
refuses missing --headless --case "$work/missing"
refuses "leave loop=1 out" --headless --tracker "replay:$INSONATE_ASSETS/logs/ruq_good.igs.mha?loop=1"
refuses mouse --headless --tracker mousse:
refuses "--case excludes --ct" --headless --case a --ct b
refuses width --headless --width 3
refuses "--calibration requires --tracker" --headless --calibration a.toml
refuses "has no sensor" --headless --tracker mouse: --calibration a.toml
printf '[tracker]\nkind = "hydra"\n' >"$work/begun.toml"
refuses "the step 'face' has not been made" --headless --tracker synthetic: --calibration "$work/begun.toml"
refuses "such a file already" --headless --record "$work/run.igs.mha"
refuses "igs.mha" --headless --record "$work/run.txt"
refuses "no file to record to" --headless --record-images
refuses "no device that sends bytes" --headless --tracker synthetic: --record-raw "$work/run.raw"
refuses "no device that sends bytes" --headless --tracker "replay:$INSONATE_ASSETS/logs/ruq_good.igs.mha" --record-raw "$work/run.raw"
refuses "no tracker is named" --headless --record-raw "$work/run.raw"
refuses missing.igs.mha replay "$work/missing.igs.mha" --headless
refuses cut.igs.mha replay "$log" --headless --beside "$work/cut.igs.mha"
refuses "no run is named" replay --headless --beside "$log"
refuses "--attempt requires --results" replay --headless --attempt 1
refuses "no attempt" replay --headless --results "$work/results.db" --attempt 99
refuses "a replay stores nothing" replay "$log" --headless --results "$work/none.db"
refuses "LOG excludes --attempt" replay "$log" --headless --results "$work/results.db" --attempt 1
refuses "not expected: .*--tracker" replay "$log" --headless --tracker mouse:
refuses "excludes --scenario" replay --headless --results "$work/results.db" --attempt 1 --scenario "$scenario"
refuses "stands before 'replay'" --headless replay "$log"
refuses "stands before 'exam'" --tracker mouse: exam --learner L-01 --results "$work/results.db"
[ ! -e "$work/none.db" ] || fail "a database was made for a replay"
refuses shader-dir --headless --shader-dir "$work/missing"
exam=(exam --headless --learner L-01 --results "$work/results.db" --tracker mouse:)
refuses "not expected: .*--igtl-server" "${exam[@]}" --igtl-server 18944
refuses "not expected: .*--shader-dir" "${exam[@]}" --shader-dir "$work"
refuses "--headless requires --results" exam --headless --learner L-01 --tracker mouse:
refuses "--learner is required" exam --results "$work/results.db" --tracker mouse:
refuses "--tracker is required" exam --learner L-01 --results "$work/results.db"
refuses "can be anybody" exam --headless --learner anonymous --results "$work/results.db" --tracker mouse:
refuses "this mode needs a window" setup --tracker hydra:

echo "what there is of a sitting that was broken off is handed in, or removed so that it can be taken again"
# `hand_in ARGUMENT...`: hands in, once the sitting has been broken off for long enough.
hand_in() {
  for _ in $(seq 1 100); do
    "$score" hand-in "$work/sitting.db" "$@" >"$work/handed.txt" || fail "hand-in ended with $?"
    grep -q 'only just' "$work/handed.txt" || return 0
    sleep 0.5
  done
}
hand_in --sitting 1
grep -q '^sitting 1, L-07, begun .*: attempt 1, ' "$work/handed.txt" || fail "$(cat "$work/handed.txt")"
"$score" rescore "$work/sitting.db" >"$work/log" || fail "$(cat "$work/log")"
"$score" report "$work/sitting.db" --out "$work/reports-sitting" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
grep -q '"seed": 3,' "$work/reports-sitting/attempt-1/score.json" || fail "the seed was not kept"
grep -q '"mode": "exam"' "$work/reports-sitting/attempt-1/score.json" || fail "it does not say that it was an exam"
sit L-07 && fail "an exam that was handed in was begun again"
grep -q "as attempt 1" "$work/log" || fail "$(cat "$work/log")"
hand_in --sitting 2 --discard
grep -q '^sitting 2, L-08, begun .*: removed$' "$work/handed.txt" || fail "$(cat "$work/handed.txt")"
[ "$("$score" hand-in "$work/sitting.db")" = "no exam was begun and not handed in" ] || fail "sittings are left"
echo "passed"
