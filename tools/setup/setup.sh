#!/bin/sh
# setup.sh GOAL: installs the distribution's packages that `make GOAL` needs and that are
# missing. GOAL: demo, test, lab, count, report, firmware, lint, prove or cross (the compilers that tests
# try when they are there). With SETUP=0 it only lists what is missing and exits with 2. Beside
# it only the lab's `vmlab.sh prepare` uses the network.
set -eu

# What each goal needs, by the names of Debian 12.
demo="gcc g++ libc6-dev pkg-config python3 libtinygltf-dev libhidapi-dev libgpiod-dev libpng-dev"
test="$demo libcmocka-dev assimp-testmodels libosmesa6-dev"
count="$demo valgrind gcc-arm-none-eabi gcc-riscv64-unknown-elf qemu-system-arm qemu-system-misc"
report="$count gnuplot-nox fonts-dejavu-core libcmocka-dev"
cross="gcc-arm-none-eabi gcc-riscv64-unknown-elf gcc-avr"
prove="gcc libc6-dev python3 libcmocka-dev frama-c-base z3"
lint="gcc libc6-dev cppcheck clang-tidy libcmocka-dev libosmesa6-dev"
firmware="$demo clang $cross avr-libc qemu-system-arm qemu-system-misc simavr"
lab="$demo libusb-1.0-0-dev gpiod qemu-system-x86 busybox-static cpio kmod xz-utils"

goal=${1:-}
case $goal in
demo) wanted=$demo ;;
test) wanted=$test ;;
lab) wanted=$lab goal=lab-test ;;
count) wanted=$count ;;
report) wanted=$report ;;
firmware) wanted=$firmware ;;
cross) wanted=$cross ;;
lint) wanted=$lint ;;
prove) wanted=$prove ;;
*)
    echo "usage: setup.sh demo|test|lab|count|report|firmware|cross|lint|prove   (SETUP=0: only list what is missing)" >&2
    exit 2
    ;;
esac

if ! command -v dpkg-query >/dev/null 2>&1; then
    echo "setup: this is not a Debian system; make $goal needs the equivalents of: $wanted" >&2
    exit 0
fi

missing=
for package in $wanted; do
    state=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$state" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

if [ "${SETUP:-1}" = 0 ]; then
    echo "setup: make $goal needs these packages, which are missing:$missing" >&2
    exit 2
fi
as_root=
if [ "$(id -u)" != 0 ]; then
    if ! command -v sudo >/dev/null 2>&1; then
        echo "setup: make $goal needs root or sudo to install:$missing" >&2
        exit 2
    fi
    as_root=sudo
fi
echo "setup: installing for make $goal:$missing"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# word splitting of $missing and an empty $as_root are meant
# shellcheck disable=SC2086
if ! { $as_root env DEBIAN_FRONTEND=noninteractive apt-get update &&
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing; } \
    </dev/null >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    echo "setup: could not install:$missing" >&2
    exit 2
fi
