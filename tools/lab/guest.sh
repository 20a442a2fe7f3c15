# Shared by the lab's test scripts, which run as root inside the guest.
# shellcheck shell=sh disable=SC2034,SC2154 # used by, and given by, the scripts
#
# Every check prints one line, `ok - NAME`, `not ok - NAME: WHY` or `skip - NAME: WHY`;
# run-tests.sh counts them. The environment gives EW_BIN and EW_SCENE.

work=$(mktemp -d) || exit 1
size=96x64
picture_bytes=12288 # 96 * 64 * 2

ok()   { echo "ok - $1"; }
bad()  { echo "not ok - $1: $2"; sed 's/^/#   /' "$work/err" "$work/out" 2>/dev/null; }
skip() { echo "skip - $1: $2"; }

now() { cut -d' ' -f1 /proc/uptime; }

# stream ARGUMENTS...: runs the program under test; $status, $seconds, $work/out, $work/err
stream() {
    began=$(now)
    timeout 100 "$EW_BIN/$program" "$@" >"$work/out" 2>"$work/err"
    status=$?
    seconds=$(echo "$began $(now)" | awk '{printf "%.1f", $2 - $1}')
}
total() { sed -n "s/^$1  *//p" "$work/out"; } # TOTAL'S NAME

# expect NAME STATUS LINES: of the last run, exit status and number of error lines
expect() {
    if [ "$status" != "$2" ]; then bad "$1" "exit status $status, not $2"; return 1; fi
    if [ "$(wc -l <"$work/err")" != "$3" ]; then bad "$1" "not $3 error lines"; return 1; fi
}
# expect_error NAME PATTERN: failed with one line that matches
expect_error() {
    expect "$1" 1 1 || return
    if grep -qE "$2" "$work/err"; then ok "$1"; else bad "$1" "the error line does not say $2"; fi
}
no_kernel_complaints() {
    if dmesg | grep -E 'BUG:|WARNING:' >"$work/err"; then bad "$1" "the kernel complains"; else ok "$1"; fi
}
