# What the tests have in common that drive the trainer in a real window: an X server of their own without a screen
# (Xvfb), real key and mouse events (xdotool), and the trainer's state file. To be sourced with the trainer's program
# and the assets' folder as the script's first two arguments; fails at the first thing that is not as it must be.
set -euo pipefail
program=$1
export INSONATE_ASSETS=$2
work=$(mktemp -d)
export XDG_DATA_HOME="$work/data" XDG_CONFIG_HOME="$work/config"  # not the user's own results and settings
state="$work/state.json"
server="" trainer="" helpers=()
finish() {
  [ -z "$trainer" ] || kill -CONT "$trainer" 2>/dev/null || true
  for started in "${helpers[@]}" "$trainer" "$server"; do
    [ -z "$started" ] || kill "$started" 2>/dev/null || true
  done
  # A program that still writes into the folder would fail its removal, and with that the test.
  for _ in $(seq 1 50); do [ -z "$(jobs -r)" ] && break; sleep 0.1; done
  rm -rf "$work"
}
trap finish EXIT

fail() {
  echo "FAILED: $*" >&2
  [ -f "$state" ] && cat "$state" >&2
  [ -f "$work/log" ] && cat "$work/log" >&2
  exit 1
}

# One value of the state file; empty when it is not there.
value() { sed -n "s/^ \"$1\": \"\{0,1\}\([^\",]*\)\"\{0,1\},\{0,1\}$/\1/p" "$state" 2>/dev/null; }

# Waits until a shell condition holds; the machine may be slow, so the limit is wide.
await() {
  local what=$1
  shift
  for _ in $(seq 1 600); do
    if "$@"; then return 0; fi
    kill -0 "$trainer" 2>/dev/null || fail "the trainer ended while waiting for: $what"
    sleep 0.2
  done
  fail "$what"
}
is() { [ "$(value "$1")" = "$2" ]; }
# Whether the line of a value holds a pattern, for values with commas.
contains() { grep "^ \"$1\": " "$state" 2>/dev/null | grep -q -- "$2"; }
is_not() { [ "$(value "$1")" != "$2" ]; }
# Whether a number of the state moved away from another by more than a distance.
moved() { awk -v a="$(value "$1")" -v b="$2" -v d="$3" 'BEGIN { exit !((a - b > d) || (b - a > d)) }'; }

# Whether every picture is drawn, in full, and none is under way. Frames have to go by meanwhile: a machine that has no
# time for the trainer draws nothing either, and it is one frame that ends a motion and the next that draws in full.
at_rest() {
  local drawn frames
  drawn=$(value pictures_drawn) frames=$(value frames)
  sleep 0.7
  is pictures_drawn "$drawn" && is quality 1.0 && [ "$(value frames)" -ge $((frames + 2)) ]
}

# Whether the screen stays as it is, without a frame being shown, though frames are laid out.
shows_nothing() {
  local shown frames
  shown=$(value frames_shown) frames=$(value frames)
  sleep 1.2
  is frames_shown "$shown" && [ "$(value frames)" -ge $((frames + 2)) ]
}

# What is on the screen, cut to a panel: `shot FILE PANEL [MARGIN]`.
shot() {
  local margin=${3:-0}
  import -display "$DISPLAY" -window root \
    -crop "$(($(value "$2_w") - 2 * margin))x$(($(value "$2_h") - 2 * margin))+$(($(value "$2_x") + margin))+$(($(value "$2_y") + margin))" \
    +repage "$1"
}
# Mean and standard deviation of a picture's brightness, 0 to 1.
brightness() { convert "$1" -colorspace Gray -format '%[fx:mean] %[fx:standard_deviation]' info:; }
# Pixels that differ between two pictures by more than 5 %.
different() { compare -metric AE -fuzz 5% "$1" "$2" null: 2>&1 || true; }

# Whether a panel shows the amber of warnings, on more than some pixels: `amber_in PANEL [PIXELS]`.
amber_in() {
  shot "$work/amber.png" "$1"
  [ "$(convert "$work/amber.png" -fill black +opaque 'rgb(236,172,62)' -fill white -opaque 'rgb(236,172,62)' \
    -format "%[fx:mean*w*h>${2:-200}]" info:)" = 1 ]
}
# A CT: a block of water, 160 mm wide, with a voxel of air, because a CT of one value alone is refused.
water() {
  {
    printf 'ObjectType = Image\nNDims = 3\nDimSize = 80 80 80\nElementSpacing = 2 2 2\nOffset = -80 -80 -80\n'
    printf 'ElementType = MET_SHORT\nElementDataFile = LOCAL\n'
    printf '\030\374'  # -1000 HU
    head -c 1023998 /dev/zero
  } >"$1"
}

pointer_to() { xdotool mousemove "$1" "$2"; }
middle_x() { echo $(($(value "$1_x") + $(value "$1_w") / 2)); }
middle_y() { echo $(($(value "$1_y") + $(value "$1_h") / 2)); }

click() {
  pointer_to "$1" "$2"
  xdotool click 1
}
click_on() { click "$(middle_x "$1")" "$(middle_y "$1")"; }
# Where a point of the imaging plane is on the screen, to the nearest pixel.
plane_x() { awk -v o="$(value plane_origin_x)" -v t="$(value plane_at_10_10_mm_x)" -v mm="$1" 'BEGIN { printf "%.0f", o + (t - o) * mm / 10 }'; }
plane_y() { awk -v o="$(value plane_origin_y)" -v t="$(value plane_at_10_10_mm_y)" -v mm="$1" 'BEGIN { printf "%.0f", o + (t - o) * mm / 10 }'; }
click_plane() { click "$(plane_x "$1")" "$(plane_y "$2")"; }
# All events of a command fall into one frame: the trainer stands still meanwhile.
in_one_frame() {
  kill -STOP "$trainer"
  "$@"
  kill -CONT "$trainer"
}

# Freeze is the first of the console's right-hand block of buttons, Help the one below it.
freeze_x() { echo $(($(value console_x) + $(value console_w) - 16 - 276 + 43)); }
freeze_y() { echo $(($(middle_y console) - 26)); }
# Whether the probe has moved by more than 3 mm from where remember_probe saw it.
remember_probe() { x=$(value face_x) y=$(value face_y) z=$(value face_z); }
far_enough() { moved face_x "$x" 3 || moved face_y "$y" 3 || moved face_z "$z" 3; }

# -displayfd lets the server pick a display that is free; -r: no key repeats because a machine is slow to let it go.
exec 3>"$work/display"
Xvfb -displayfd 3 -r -screen 0 "${screen_size:-1280x800}x24" -nolisten tcp >"$work/xvfb.log" 2>&1 &
server=$!
for _ in $(seq 1 100); do [ -s "$work/display" ] && break; sleep 0.1; done
[ -s "$work/display" ] || fail "the X server did not start: $(cat "$work/xvfb.log")"
DISPLAY=:$(cat "$work/display")
export DISPLAY

# Starts the trainer with the given arguments.
start_trainer() {
  rm -f "$state"
  "$program" "$@" --seconds 500 --out "$work/out" --state-file "$state" >"$work/log" 2>&1 &
  trainer=$!
}
# The same as a person starts it: for as long as they like, and with the start page if nothing is named.
open_trainer() {
  rm -f "$state"
  "$program" "$@" --out "$work/out" --state-file "$state" >"$work/log" 2>&1 &
  trainer=$!
}
end_trainer() {
  kill "$trainer"
  wait "$trainer" 2>/dev/null || true
}
