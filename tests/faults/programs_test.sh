#!/usr/bin/env bash
# The programs on full disks, in folders that may not be written to, without memory or files to open, and with a clock
# that is set back. Each says what is wrong in one sentence and ends with the exit code for it; nothing that was
# committed is lost, and nothing half written looks whole.
#   programs_test.sh PROGRAMS_FOLDER TEST_PROGRAMS_FOLDER ASSETS_FOLDER
set -euo pipefail
# A name space of its own for mounts, where that is allowed.
if [ "${in_name_space:-}" != yes ] && unshare --mount true 2>/dev/null; then
  in_name_space=yes exec unshare --mount "$0" "$@"
fi
bin=$1 tests=$2
export INSONATE_ASSETS=$3
unset DISPLAY WAYLAND_DISPLAY
work=$(mktemp -d)
export XDG_CACHE_HOME=$work/cache XDG_DATA_HOME=$work/data MESA_SHADER_CACHE_DISABLE=true
started=""
trap '[ -z "$started" ] || kill -9 $started 2>/dev/null; umount "$work/disk" 2>/dev/null || true; chmod -R u+w "$work"; rm -rf "$work"' EXIT
fail() {
  echo "FAILED: $*" >&2
  exit 1
}

# `says CODE WORDS COMMAND...`: that exit code, and one line on standard error, with the words, besides progress and tracker.
says() {
  local expected=$1 words=$2 code=0 err
  shift 2
  err=$({ "$@" >/dev/null; } 2>&1) || code=$?
  err=$(grep -v ' %$\|^synthetic hand\|^OpenIGTLink from' <<<"$err" || true)
  [ "$code" = "$expected" ] || fail "exit code $code for: $* ($err)"
  [ "$(wc -l <<<"$err")" = 1 ] || fail "more than a sentence for: $* ($err)"
  grep -q -- "$words" <<<"$err" || fail "no '$words' in: $err"
}
limited() { prlimit --fsize="$1" "${@:2}"; }
no_temporaries() { [ -z "$(find "$1" -name '.*.partial*')" ] || fail "left behind: $(find "$1" -name '.*.partial*')"; }
# What is in a folder, besides what SQLite keeps beside a database and what belongs to the test itself.
sum_of() { (cd "$1" && find . -type f ! -name '*-wal' ! -name '*-shm' ! -name before ! -name now -print0 | sort -z | xargs -0 sha256sum); }
attempts() { "$bin/insonate-score" attempts "$1" | grep -c "Find the ball" || true; }

"$tests/kill_rounds" --make "$work/made"
exam=$work/made/exam.toml scan=$work/made/scan.igs.mha
score=("$bin/insonate-score" --log "$scan" --scenario "$exam")
"${score[@]}" --results "$work/lab.db" --learner L-1 --report "$work/report.html" >/dev/null
import=("$bin/insonate-case" import --ct "$work/made/scan/ct.nrrd" --labels "$work/made/scan/labels.nrrd" --label-table total)
"${import[@]}" --out "$work/patient" >/dev/null 2>&1
cat >"$work/ball.toml" <<'RECIPE'
name = "Ball"
grid = { from = [0, 0, 0], to = [24, 20, 16], voxel_mm = 1 }
labels = [{ name = "ball", tissue = "liver", hu = 60, texture_hu = 5 }]
shapes = [{ name = "ball", kind = "ellipsoid", centre = [12, 10, 8], radii = [7, 7, 6], label = "ball" }]
landmarks = [{ name = "middle", at = [12, 10, 8] }]
views = [{ name = "front", title = "From the front", probe = "curvilinear", aim = "middle", from = [9, 0, 7], marker = [1, 0, 0], press_mm = 1, landmarks = ["middle"], targets = ["ball"] }]
RECIPE
phantom=("$bin/insonate-case" phantom --recipe "$work/ball.toml")
printf '1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n' >"$work/pose.txt"
add_view=("$bin/insonate-case" add-view "$work/made/tiny" --name more --targets ball --pose "$work/pose.txt")
trainer=("$bin/insonate" --headless --scenario "$exam" --tracker "replay:$scan")

# A dataset of two shards, begun without any, and a recording with images for a registration that searches hardly at all.
cat >"$work/study.toml" <<'STUDY'
format = 1
name = "small"
seed = 1
images = 2
shard_images = 1
settings = { image_width = 128, image_height = 96, samples = 64 }
case = [{ case = "made/tiny", licence = "CC0" }]
probe = [{ name = "curvilinear", lines = 32 }]
poses = [{ kind = "skin" }]
STUDY
dataset=("$bin/insonate-dataset") study=$work/study.toml
"${dataset[@]}" plan "$study" "$work/set" >/dev/null
"${trainer[@]}" --seconds 1 --record "$work/sweep.igs.mha" --record-images --out "$work/out" >/dev/null
register=("$bin/insonate-register" --case "$work/made/tiny" --probe curvilinear --search-mm 0 --search-deg 0 --slices 2
  "$work/sweep-images.igs.mha")
rm -r "$work/out"

# A small patient in the place of the built-in one, so that a cache is asked for it.
cp -r "$INSONATE_ASSETS" "$work/assets"
cat >"$work/assets/phantoms/abdomen.toml" <<'RECIPE'
name = "Trunk"
grid = { from = [-70, -60, -50], to = [70, 60, 50], voxel_mm = 2 }
labels = [{ name = "block", tissue = "soft_tissue", hu = 40 }, { name = "ball", tissue = "liver", hu = 60 }]
shapes = [
  { name = "block", kind = "box", centre = [0, 0, 0], half_sizes = [60, 40, 48], label = "block" },
  { name = "ball", kind = "ellipsoid", centre = [-10, 0, 4], radii = [14, 12, 20], label = "ball" }]
landmarks = [{ name = "middle", at = [-10, 0, 4] }]
views = [{ name = "ball", title = "From the front", probe = "curvilinear", aim = "middle", from = [-10, -60, 4], marker = [0, 0, 1], press_mm = 8, landmarks = ["middle"], targets = ["ball"] }]
RECIPE
sed 's/^case = .*/case = "abdomen"/' "$exam" >"$work/patient.toml"
patient=(env INSONATE_ASSETS="$work/assets" "$bin/insonate" --headless --scenario "$work/patient.toml" --tracker "replay:$scan")

echo "files that may not grow"
sum_of "$work" >"$work/before"
for bytes in 0 100 3000; do
  says 2 "report.html: it cannot be written" limited $bytes "${score[@]}" --report "$work/report.html"
  says 2 "it cannot be written\|disk does not read or write\|disk is full" limited $bytes "$bin/insonate-score" report "$work/lab.db" --out "$work/reports"
  says 2 "it cannot be written\|disk does not read or write\|disk is full" limited $bytes "$bin/insonate-score" export "$work/lab.db" --out "$work/tables"
  [ ! -e "$work/tables" ] || fail "a part of the tables is there, at $bytes bytes"
  says 2 "lab.db" limited $bytes "$bin/insonate-score" comment "$work/lab.db" --attempt 1 --text "Slow down"
  says 2 "cannot be written" limited $bytes "${phantom[@]}" --replace "$work/ball"
  says 2 "cannot be written" limited $bytes "${import[@]}" --out "$work/patient" --replace
  says 2 "case.toml: it cannot be written" limited $((bytes / 10)) "${add_view[@]}"
  says 2 "lab.db" limited $bytes "${score[@]}" --results "$work/lab.db"
  says 2 "lab2.db" limited $bytes "${score[@]}" --results "$work/lab2.db"
  says 2 "new/.*manifest.*: it cannot be written" limited $bytes "${dataset[@]}" plan "$study" "$work/new"
  says 2 "set/shards/00000.h5: it cannot be written" limited $bytes "${dataset[@]}" make "$study" "$work/set"
  says 2 "cannot be written" limited $bytes "${dataset[@]}" image "$study" 1 "$work/image"
  says 2 "cannot be written" limited $bytes "${register[@]}" "$work/registration"
  [ ! -e "$work/image" ] && [ ! -e "$work/registration" ] || fail "a part of a folder is there, at $bytes bytes"
  rm -rf "$work/reports" "$work/lab2.db"* "$work/new"
  no_temporaries "$work"
  sum_of "$work" >"$work/now"
  diff "$work/before" "$work/now" || fail "something else is there than before, at $bytes bytes"
done
[ "$(attempts "$work/lab.db")" = 1 ] || fail "the attempt is lost"
"${dataset[@]}" make "$study" "$work/set" >/dev/null
"${dataset[@]}" check "$work/set" >"$work/log" || fail "the dataset is not finished by the next run: $(cat "$work/log")"
says 2 "cannot be written" limited 3000 "${trainer[@]}" --out "$work/out"
rm -rf "$work/out"

echo "a recording that may not grow ends in a sentence, and keeps what it has"
watch=("$bin/insonate-devices" watch "synthetic:1?rate=200" --seconds 2)
for bytes in 3000 20000 100000; do
  says 2 "insonate-devices recover $work/run.igs.mha" limited $bytes "${watch[@]}" --record "$work/run.igs.mha"
  [ ! -e "$work/run.igs.mha" ] || fail "half a recording looks whole"
  "$bin/insonate-devices" recover "$work/run.igs.mha" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
  "$bin/insonate-devices" check "$work/run.igs.mha" >"$work/log" 2>&1 || [ $? = 1 ] || fail "$(cat "$work/log")"
  rm "$work/run.igs.mha"
done
says 2 "run.*.igs.mha" limited 100000 "${trainer[@]}" --record "$work/run.igs.mha" --record-images --out "$work/out"
rm -rf "$work/run"* "$work/out"
"$tests/pose_server" 0 >"$work/port" &
started=$!
for _ in $(seq 1 100); do [ -s "$work/port" ] || sleep 0.1; done
raw=("$bin/insonate-devices" watch "igtl://127.0.0.1:$(cat "$work/port")/Probe" --seconds 4)
says 2 "run.raw: it cannot be written on" limited 3000 "${raw[@]}" --record-raw "$work/run.raw"
[ "$(tail -c 1 "$work/run.raw" | od -An -c | tr -d ' ')" = '\n' ] || fail "half a line is left"
"$bin/insonate-devices" check "$work/run.raw" >"$work/log" 2>&1 || [ $? = 1 ] || fail "$(cat "$work/log")"
kill $started && wait $started 2>/dev/null || true
started=""

echo "what is printed and does not arrive"
to_full() { "$@" >/dev/full; }
for command in "${score[*]}" "$bin/insonate-score attempts $work/lab.db" "$bin/insonate-case inspect $work/patient" \
  "$bin/insonate-devices check $scan" "${score[0]} check $exam" "$bin/insonate --version" "$bin/insonate-case --help" \
  "${dataset[0]} status $work/set" "${register[*]} $work/registration"; do
  # shellcheck disable=SC2086
  says 2 "standard output: it cannot be written" to_full $command
done

disk=$work/disk
mkdir "$disk"
if mount -t tmpfs -o size=600k none "$disk" 2>/dev/null; then
  echo "a disk that is full"
  cp "$work/lab.db" "$disk/lab.db"
  "${phantom[@]}" "$disk/ball" >/dev/null 2>&1
  "${dataset[@]}" plan "$study" "$disk/set" >/dev/null
  dd if=/dev/zero of="$disk/filler" bs=1k 2>/dev/null || true
  sum_of "$disk" >"$work/before"
  says 2 "No space left on device" "${score[@]}" --report "$disk/report.html"
  says 2 "lab.db: the disk is full" "${score[@]}" --results "$disk/lab.db"
  says 2 "cannot be written" "${phantom[@]}" --replace "$disk/ball"
  says 2 "cannot be written" "${import[@]}" --out "$disk/patient"
  says 2 "set/shards/00000.h5: it cannot be written" "${dataset[@]}" make "$study" "$disk/set"
  says 2 "cannot be written" "${dataset[@]}" image "$study" 1 "$disk/image"
  says 2 "cannot be written" "${register[@]}" "$disk/registration"
  says 2 "run.igs.mha" "${watch[@]}" --record "$disk/run.igs.mha"
  rm -f "$disk/run"*
  says 2 "cannot be written" "${trainer[@]}" --out "$disk/out"
  rm -rf "$disk/out"
  no_temporaries "$disk"
  sum_of "$disk" >"$work/now"
  diff "$work/before" "$work/now" || fail "something else is there than before the disk was full"
  # SQLite needs room for its shared memory even to read.
  truncate -s -64k "$disk/filler"
  [ "$(attempts "$disk/lab.db")" = 1 ] || fail "the attempt is lost"
  echo "a cache without room, and one that may not be written to: the trainer works all the same"
  XDG_CACHE_HOME=$disk/cache "${patient[@]}" --out "$work/out" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
  [ -s "$work/out/score.json" ] || fail "there is no score"
  rm -r "$work/out" "$disk/filler"
  "${dataset[@]}" make "$study" "$disk/set" >/dev/null
  "${dataset[@]}" check "$disk/set" >"$work/log" || fail "the dataset is not finished by the next run: $(cat "$work/log")"
  mount -o remount,ro "$disk"
  XDG_CACHE_HOME=$disk/cache "${patient[@]}" --out "$work/out" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
  says 2 "report.html: it cannot be written" "${score[@]}" --report "$disk/report.html"
  says 2 "the database cannot be opened for writing" "${score[@]}" --results "$disk/lab.db"
  says 2 "Read-only file system" "${watch[@]}" --record "$disk/run.igs.mha"
  says 2 "Read-only file system" "${dataset[@]}" plan "$study" "$disk/new"
  says 2 "Read-only file system" "${register[@]}" "$disk/registration"
  umount "$disk"
else
  echo "mounts are not allowed here: no disk is filled"
fi

echo "folders that may not be written to"
closed=$work/closed
mkdir "$closed"
cp "$work/lab.db" "$closed/lab.db"
chmod 555 "$closed"
plain=()
[ "$(id -u)" != 0 ] || plain=(setpriv --bounding-set=-dac_override,-dac_read_search)
says 2 "report.html: it cannot be written" "${plain[@]}" "${score[@]}" --report "$closed/report.html"
says 2 "lab.db: the database cannot be opened for writing" "${plain[@]}" "${score[@]}" --results "$closed/lab.db"
says 2 "new.db: the database cannot be opened for writing" "${plain[@]}" "${score[@]}" --results "$closed/new.db"
says 2 "the folder cannot be made (Permission denied)" "${plain[@]}" "${phantom[@]}" "$closed/ball"
says 2 "the folder cannot be made (Permission denied)" "${plain[@]}" "${import[@]}" --out "$closed/patient"
says 2 "the folder cannot be written (Permission denied)" "${plain[@]}" "${dataset[@]}" plan "$study" "$closed/set"
says 2 "the folder cannot be written (Permission denied)" "${plain[@]}" "${register[@]}" "$closed/registration"
says 2 "it cannot be written (Permission denied)" "${plain[@]}" "${watch[@]}" --record "$closed/run.igs.mha"
says 2 "it cannot be written (Permission denied)" "${plain[@]}" "${raw[@]}" --record-raw "$closed/run.raw"
says 2 "the folder cannot be written (Permission denied)" "${plain[@]}" "${trainer[@]}" --out "$closed/out"
XDG_CACHE_HOME=$closed/cache "${plain[@]}" "${patient[@]}" --out "$work/out" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
[ "$(ls -A "$closed")" = lab.db ] || fail "something was written: $(ls -A "$closed")"

echo "too few files that may be open, and too little memory: a sentence or the work, and nothing else"
# `copes COMMAND...`: exit code 0, 2 or 3, one sentence at most. 127 is the loader's, before the program begins.
copes() {
  local code=0 err
  err=$({ "$@" >/dev/null; } 2>&1) || code=$?
  case $code in 0 | 2 | 3 | 127) ;; *) fail "exit code $code for: $* ($err)" ;; esac
  [ "$(wc -l <<<"$err")" -le 1 ] || fail "more than a sentence for: $* ($err)"
  codes+=" $code"
}
codes=""
for files in 3 4 5 6 7 8 10 12; do
  copes prlimit --nofile=$files "${score[@]}"
  copes prlimit --nofile=$files "${score[@]}" --results "$work/lab.db"
  copes prlimit --nofile=$files "$bin/insonate-devices" check "$scan"
  copes prlimit --nofile=$files "$bin/insonate-case" inspect "$work/patient"
done
[[ $codes == *" 2"* && $codes == *" 0"* ]] || fail "no limit of files was met: $codes"
if ! grep -qa __asan_init "$bin/insonate-score"; then  # whose shadow takes all there is
  codes=""
  # From what the program needs before its first own line, which depends on the libraries.
  # In units of 256 KiB: a small exam needs less than 1 MiB more than that.
  least=80
  starts() { (prlimit --as=$(($1 << 18)) "$bin/insonate-score" --version; exit $?) >/dev/null 2>&1; }
  until starts "$least"; do least=$((least + 1)); done
  for quarters in $(seq $((least + 1)) 1 $((least + 24))) $(seq $((least + 64)) 80 1600); do
    copes prlimit --as=$((quarters << 18)) "${score[@]}"
  done
  [[ $codes == *" 3"* || $codes == *" 2"* ]] || fail "no limit of memory was met: $codes"
fi

fake=$(find /usr/lib -name libfaketime.so.1 2>/dev/null | head -1)
[ -n "$fake" ] || fail "there is no libfaketime"
echo "+0" >"$work/clock"
export ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}verify_asan_link_order=0"
clocked() { LD_PRELOAD=$fake FAKETIME_TIMESTAMP_FILE=$work/clock FAKETIME_NO_CACHE=1 FAKETIME_DONT_FAKE_MONOTONIC=1 "$@"; }
clocked env date +%s >"$work/a"
echo "-3600" >"$work/clock"
[ $(($(clocked env date +%s) - $(cat "$work/a"))) -lt -3000 ] || fail "the clock cannot be set back"

echo "a clock that is set back: a recording's times rise"
echo "+0" >"$work/clock"
clocked "$bin/insonate-devices" watch "synthetic:1?live=1&rate=100" --seconds 3 --record "$work/run.igs.mha" >/dev/null 2>&1 &
started=$!
sleep 1.5
echo "-3600" >"$work/clock"
wait $started || fail "the recording ended with $?"
started=""
times() { grep -a '^Seq_Frame[0-9]*_Timestamp' "$work/run.igs.mha" | sed 's/.*= //'; }
[ "$(times | wc -l)" -gt 100 ] || fail "only $(times | wc -l) samples were recorded"
times | awk 'NR > 1 && $1 - last <= 0 { exit 1 } { last = $1 }' || fail "its times do not rise"
times | awk 'NR > 1 && $1 - last > 2 { exit 1 } { last = $1 }' || fail "its times jump"

echo "and attempts keep their order, and an exam under way is nobody else's to hand in"
clocked "${score[@]}" --results "$work/lab.db" --learner L-2 >/dev/null
"$bin/insonate-score" attempts "$work/lab.db" >"$work/list"
[ "$(grep -o 'L-[0-9]' "$work/list" | tr -d '\n')" = L-1L-2 ] || fail "the order is another: $(cat "$work/list")"
echo "+0" >"$work/clock"
clocked "$bin/insonate" exam --headless --scenario "$exam" --tracker "synthetic:1?live=1&rate=60" \
  --results "$work/sitting.db" --learner L-3 --out "$work/sitting" >"$work/log" 2>&1 &
started=$!
for _ in $(seq 1 300); do
  "$bin/insonate-score" attempts "$work/sitting.db" 2>/dev/null | grep -q "of L-3" && break
  sleep 0.1
done
echo "-3600" >"$work/clock"
sleep 3
kill -0 $started || fail "the exam is over too soon: $(cat "$work/log")"
clocked "$bin/insonate-score" hand-in "$work/sitting.db" >"$work/handed" 2>&1 || fail "$(cat "$work/handed")"
grep -q "under way" "$work/handed" || fail "an exam under way was handed in: $(cat "$work/handed")"
wait $started || fail "the exam ended with $?: $(cat "$work/log")"
started=""
[ "$(attempts "$work/sitting.db")" = 1 ] || fail "the exam is lost"
echo passed
