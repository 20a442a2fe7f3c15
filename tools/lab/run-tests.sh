#!/bin/bash
# Runs ew-stream against the kernel's own USB HID and GPIO in a QEMU guest. The last
# line is `N passed, N failed, N skipped`; the exit status is 0 only without failures.
#
#   EW_BIN        folder of ew-stream, ew-stream-libusb, usbip_display [build/release/bin]
#   EW_SCENE      a baked scene whose camera moves
#   LAB_REQUIRE=1 a skip counts as a failure
set -u
here=$(cd "$(dirname "$0")" && pwd)
: "${EW_BIN:=$here/../../build/release/bin}" "${EW_SCENE:?a baked scene}" "${LAB_REQUIRE:=}"
EW_BIN=$(cd "$EW_BIN" && pwd) || exit 1
EW_SCENE=$(realpath -e "$EW_SCENE") || exit 1
passed=0 failed=0 skipped=0

count() { # FILE of result lines
    local line
    while read -r line; do
        case $line in
            'ok - '*) passed=$((passed + 1)) ;;
            'not ok - '*) failed=$((failed + 1)) ;;
            'skip - '*) if [ -n "$LAB_REQUIRE" ]; then failed=$((failed + 1)); else skipped=$((skipped + 1)); fi ;;
        esac
    done <"$1"
}
skip_all() { # REASON
    local test
    for test in "${tests[@]}"; do
        echo "skip - $test: $1"
    done
}

log=$(mktemp) || exit 1
trap 'rm -f "$log"' EXIT
tests=("hid-tests.sh hidraw" "hid-tests.sh libusb" gpio-tests.sh)
"$here/vmlab.sh" prepare 2>"$log"
status=$?
sed 's/^/# /' "$log"
if [ $status != 0 ]; then
    reason=$(tail -n 1 "$log")
    skip_all "${reason#vmlab: SKIP: }" | tee "$log"
    count "$log"
    [ $status = 77 ] || failed=$((failed + 1))
else
    for test in "${tests[@]}"; do
        # shellcheck disable=SC2086 # script and argument
        VMLAB_TIMEOUT=${VMLAB_TIMEOUT:-300} "$here/vmlab.sh" run -- \
            env EW_BIN="$EW_BIN" EW_SCENE="$EW_SCENE" sh "$here/"$test 2>&1 | tee "$log"
        status=${PIPESTATUS[0]}
        if [ "$status" = 77 ]; then # prepared, but cannot run: say why, once
            reason=$(sed -n 's/^vmlab: SKIP: //p' "$log" | tail -n 1)
            echo "skip - $test: $reason" | tee "$log"
        elif [ "$status" -ge 124 ]; then
            echo "not ok - $test: the guest ended with status $status" | tee -a "$log"
        fi
        count "$log"
    done
fi
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed = 0 ]
