#!/bin/sh
# hid-tests.sh BACKEND: ew-stream through the kernel's own USB HID to a virtual display.
# shellcheck disable=SC1091,SC2034,SC2154 # guest.sh gives and takes these
backend=$1
cd "$(dirname "$0")" || exit 1
. ./guest.sh
case $backend in hidraw) program=ew-stream ;; *) program=ew-stream-$backend ;; esac
id=16c0:05df

present() { grep -qs 05df /sys/bus/usb/devices/*/idProduct; }
usable() { # the HID driver has bound, and a node is there
    present && ls /dev/hidraw* >/dev/null 2>&1
}
gone() { ! present; }
wait_until() { # CONDITION
    tries=0
    until $1; do
        tries=$((tries + 1))
        if [ $tries = 200 ]; then return 1; fi
        sleep 0.05
    done
}

plug() { # OPTIONS...: a display; ended by unplug
    rm -f "$work/shown"
    "$EW_BIN/usbip_display" --size "$size" --idle 30000 --pictures "$work/shown" "$@" >"$work/device" 2>&1 &
    device=$!
    wait_until usable || echo "# the display does not appear"
}
unplug() {
    kill $device 2>/dev/null
    wait $device
    wait_until gone
    sed 's/^/# /' "$work/device"
}

# all_equal NAME: every picture shown is the one drawn, in order, none missing
all_equal() {
    if cmp "$work/shown" "$work/drawn" >>"$work/err" 2>&1; then ok "$1"; else bad "$1" "pictures differ"; fi
}
last_equal() {
    tail -c "$picture_bytes" "$work/shown" >"$work/last-shown"
    tail -c "$picture_bytes" "$work/drawn" >"$work/last-drawn"
    if cmp "$work/last-shown" "$work/last-drawn" >>"$work/err" 2>&1; then ok "$1"; else bad "$1" "last picture differs"; fi
}

stream "$EW_SCENE" --device "sim:$size" --frames 24 --fps 0 --compare --dump-drawn "$work/simulated"
expect "$backend: reference on the simulated display" 0 0 && ok "$backend: reference on the simulated display"

plug
stream --list
if grep -q "$id:LAB0001 .*edgewalk lab display" "$work/out"; then ok "$backend: list"; else bad "$backend: list" "not listed"; fi
for profile in buffered direct; do
    unplug
    plug --profile $profile
    name="$backend: every picture of the demo, $profile"
    stream "$EW_SCENE" --device $id --frames 24 --fps 0 --compare --dump-drawn "$work/drawn" --record "$work/record"
    expect "$name" 0 0 && all_equal "$name"
    sed 's/^/# /' "$work/out"
    name="$backend: as on the simulated display, $profile"
    if cmp -s "$work/drawn" "$work/simulated"; then ok "$name"; else bad "$name" "not drawn alike"; fi
done
name="$backend: by serial number"
stream "$EW_SCENE" --device $id:LAB0001 --frames 2 --fps 0
expect "$name" 0 0 && ok "$name"
stream "$EW_SCENE" --device $id:OTHER --frames 2
expect_error "$backend: another serial number" 'no such display'
if [ "$backend" = hidraw ]; then
    name="$backend: by path"
    stream "$EW_SCENE" --device "$("$EW_BIN/$program" --list | sed -n 's/^16c0:05df:LAB0001  \([^ ]*\)  .*/\1/p')" \
        --frames 2 --fps 0
    expect "$name" 0 0 && ok "$name"
fi
stream "$EW_SCENE" --device /dev/null --frames 2
expect_error "$backend: a path that is no display" '/dev/null: open: not a HID device'

name="$backend: interrupted"
timeout -s INT 4 "$EW_BIN/$program" "$EW_SCENE" --device $id --frames 0 --fps 5 --dump-drawn "$work/drawn" \
    >"$work/out" 2>"$work/err"
status=$?
if grep -q '^frames sent' "$work/out" && [ ! -s "$work/err" ]; then last_equal "$name"; else bad "$name" "no totals"; fi

name="$backend: no permission"
chmod go-rwx /dev/bus/usb/*/*
[ "$backend" = libusb ] || chmod go-rwx /dev/hidraw*
chroot --userspec=65534:65534 / "$EW_BIN/$program" "$EW_SCENE" --device $id --frames 2 >"$work/out" 2>"$work/err"
status=$?
expect_error "$name" 'udev rule.*05df'
unplug

name="$backend: slow display, newest frame wins"
plug --slow 4000
stream "$EW_SCENE" --device $id --frames 40 --fps 30 --dump-drawn "$work/drawn"
if expect "$name" 0 0; then
    if [ "$(total 'frames dropped')" -gt 0 ]; then last_equal "$name"; else bad "$name" "nothing was dropped"; fi
fi
unplug

plug --unplug-after 150 --no-replug
stream "$EW_SCENE" --device $id --frames 60 --fps 0
expect_error "$backend: unplugged" "$id: (write|read): the display was unplugged"
unplug

name="$backend: unplugged and plugged in again"
plug --unplug-after 150 --away 700
stream "$EW_SCENE" --device $id --frames 60 --fps 0 --reconnect 20 --dump-drawn "$work/drawn"
if expect "$name" 0 0; then
    if [ "$(total reconnects)" = 1 ]; then last_equal "$name"; else bad "$name" "no reconnect"; fi
fi
unplug

plug --unplug-after 150 --no-replug
stream "$EW_SCENE" --device $id --frames 60 --fps 0 --reconnect 2
expect_error "$backend: unplugged and never back" 'looked for it again for 2000 ms'
unplug

plug --stall-after 100
stream "$EW_SCENE" --device $id --frames 60 --fps 0
expect_error "$backend: a stalled endpoint" "$id: write: "
unplug

plug --hang-after 100
stream "$EW_SCENE" --device $id --frames 60 --fps 0 --timeout 1500
expect_error "$backend: a display that takes nothing more" "$id: write: "
if [ "${seconds%.*}" -lt 20 ]; then
    ok "$backend: ... ends in bounded time ($seconds s)"
else
    bad "$backend: ... ends in bounded time" "took $seconds s"
fi
unplug

plug --plain
stream "$EW_SCENE" --device $id --frames 2
expect_error "$backend: a display without feature report 6" 'not a display that takes streamed frames'
unplug

stream "$EW_SCENE" --device $id --frames 2
expect_error "$backend: no such display" "$id: open: no such display"
no_kernel_complaints "$backend: kernel log"
