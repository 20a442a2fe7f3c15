#!/bin/sh
# Reset and tearing-effect lines through libgpiod, against the kernel's gpio-sim.
# shellcheck disable=SC1091,SC2034,SC2154 # guest.sh gives and takes these
cd "$(dirname "$0")" || exit 1
. ./guest.sh
program=ew-stream
config=/sys/kernel/config/gpio-sim

if [ ! -d $config ]; then
    for name in 'reset pulse' 'reset line is let go' 'TE pacing' 'dead TE line' 'wrong lines'; do
        skip "gpio: $name" "this kernel has no gpio-sim"
    done
    exit 0
fi
mkdir $config/lab $config/lab/bank0 && echo 8 >$config/lab/bank0/num_lines
for line in 0:RESET 3:TE; do
    mkdir "$config/lab/bank0/line${line%:*}" && echo "${line#*:}" >"$config/lab/bank0/line${line%:*}/name"
done
echo 1 >$config/lab/live
chip=$(cat $config/lab/bank0/chip_name)
lines=/sys/devices/platform/$(cat $config/lab/dev_name)/$chip

edges() { # 20 a second
    while :; do
        echo pull-up >"$lines/sim_gpio3/pull"
        sleep 0.025
        echo pull-down >"$lines/sim_gpio3/pull"
        sleep 0.025
    done
}

# The kernel itself writes down when the line was set, and when the program ended: whoever
# looks at the line from outside can sleep through a pulse on a busy machine.
trace=/sys/kernel/tracing
[ -d $trace/events ] || mount -t tracefs tracefs $trace
echo mono >$trace/trace_clock
echo 'comm == "ew-stream"' >$trace/events/sched/sched_process_exit/filter
echo 1 >$trace/events/sched/sched_process_exit/enable
echo 1 >$trace/events/gpio/gpio_value/enable
stream "$EW_SCENE" --device "sim:$size" --frames 1 --compare --gpio-reset "$chip:0"
echo 0 >$trace/events/enable
grep -v '^#' $trace/trace | tee "$work/reset" | sed 's/^/# /'
name="gpio: reset pulse"
if expect "$name" 0 0; then
    # high as it is opened, low for 10 ms, high for 120 ms and more, until a thread ends
    if awk '{ at[NR] = $4 + 0; event = event (/gpio_value/ ? $NF : "e") }
        END { exit !(event ~ /^101e/ && at[3] - at[2] >= 0.010 && at[4] - at[3] >= 0.120) }' "$work/reset"; then
        ok "$name"
    else
        bad "$name" "the line did not go low for 10 ms and then high for 120 ms"
    fi
    name="gpio: reset line is let go"
    if [ "$(cat "$lines/sim_gpio0/value")" = 0 ]; then ok "$name"; else bad "$name" "it is still driven high"; fi
fi

edges &
source=$!
name="gpio: TE pacing"
stream "$EW_SCENE" --device "sim:$size" --frames 40 --compare --gpio-te "/dev/$chip:TE" --te-timeout 1000
kill $source
sed 's/^/# /' "$work/out"
echo "# $seconds s"
if expect "$name" 0 0; then
    # 40 edges lie at least 39 * 50 ms apart
    if [ "$(total 'TE edges')" = 40 ] && [ "$(total 'TE misses')" = 0 ] &&
        echo "$seconds" | awk '{exit !($1 >= 1.9)}'; then
        ok "$name"
    else
        bad "$name" "not 40 edges in 1.9 s or more"
    fi
fi

name="gpio: dead TE line"
stream "$EW_SCENE" --device "sim:$size" --frames 5 --compare --gpio-te "${chip#gpiochip}:3" --te-timeout 50
if expect "$name" 0 0; then
    if [ "$(total 'TE misses')" = 5 ] && [ "$(total 'frames accepted')" = 5 ]; then ok "$name"; else bad "$name" "not 5 misses"; fi
fi

stream "$EW_SCENE" --device "sim:$size" --gpio-reset gpiochip99:0
expect_error "gpio: wrong chip" 'gpiochip99:0: open chip gpiochip99: No such file'
stream "$EW_SCENE" --device "sim:$size" --gpio-te "$chip:99"
expect_error "gpio: wrong line number" "$chip:99: request line 99: "
stream "$EW_SCENE" --device "sim:$size" --gpio-te "$chip:NAME"
expect_error "gpio: wrong line name" "$chip:NAME: request line NAME: "
gpiomon "$chip" 3 >/dev/null 2>&1 &
holder=$!
sleep 0.5
stream "$EW_SCENE" --device "sim:$size" --gpio-te "$chip:3"
kill $holder
expect_error "gpio: a line in use" "$chip:3: request line 3: Device or resource busy"
no_kernel_complaints "gpio: kernel log"
