#!/bin/bash
# vmlab.sh - runs a command as root under the distribution's own kernel in QEMU, with
# this machine's root file system (read-only, a scratch layer over it), so that
# programs built here run there unchanged, but with vhci-hcd, gpio-sim and so on.
#
#   vmlab.sh check              say whether the lab can run here
#   vmlab.sh prepare            fetch the kernel, build gpio-sim, make the initramfs
#   vmlab.sh run -- COMMAND...  boot, run COMMAND, print its output, return its status
#   vmlab.sh clean              remove the cache
#
# Only `prepare` uses the network. Exit status of `run`: COMMAND's own; 77 the lab
# cannot run here (the reason on stderr); 124 past the time limit; 125 the guest broke.
#
# Environment (defaults in brackets):
#   VMLAB_CACHE    downloads and results of `prepare` [build/lab of this project]
#   VMLAB_KERNEL   package of the kernel image [what linux-image-amd64 depends on]
#   VMLAB_DEBDIR   folder that already holds the .deb files: then no network []
#   VMLAB_APT_OPTS more options for apt-get []
#   VMLAB_ACCEL    auto, kvm or tcg [auto: kvm only after a probe boot succeeded]
#   VMLAB_MEM      guest memory in MiB [768]
#   VMLAB_CPUS     guest processors [1]
#   VMLAB_ROOT     root file system of the guest [/]
#   VMLAB_TIMEOUT  seconds for boot and COMMAND [120]
#   VMLAB_MODULES  modules loaded before COMMAND [see below]
#   VMLAB_GPIO_SIM yes, no or auto: build gpio-sim where the kernel lacks it [auto]
#   VMLAB_QEMU     qemu program [qemu-system-x86_64]
#   VMLAB_MACHINE  machine options [-M q35 -cpu max]
#   VMLAB_CMDLINE  more of the kernel's command line []
#   VMLAB_OUT      folder that receives what COMMAND leaves in /run/vmlab/out []
#   VMLAB_VERBOSE  1: times, 2: the guest's console too []
#   VMLAB_KEEP     yes: keep the .deb files after `prepare` [no]
set -u -o pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
: "${VMLAB_CACHE:=$here/../../build/lab}"
: "${VMLAB_ACCEL:=auto}" "${VMLAB_MEM:=768}" "${VMLAB_CPUS:=1}" "${VMLAB_ROOT:=/}"
: "${VMLAB_TIMEOUT:=120}" "${VMLAB_GPIO_SIM:=auto}" "${VMLAB_QEMU:=qemu-system-x86_64}"
: "${VMLAB_MACHINE:=-M q35 -cpu max}" "${VMLAB_APT_OPTS:=}" "${VMLAB_DEBDIR:=}" "${VMLAB_KERNEL:=}"
: "${VMLAB_OUT:=}" "${VMLAB_KEEP:=no}" "${VMLAB_VERBOSE:=}" "${VMLAB_CMDLINE:=}"
: "${VMLAB_MODULES:=hid-generic usbhid vhci-hcd configfs gpio-sim}"
BOOT_MODULES="virtio_pci virtio_mmio 9p 9pnet_virtio overlay"
export DEBIAN_FRONTEND=noninteractive

say()  { echo "vmlab: $*" >&2; }
die()  { say "$*"; exit 125; }
skip() { say "SKIP: $*"; exit 77; }
have() { command -v "$1" >/dev/null 2>&1 || [ -x "/sbin/$1" ]; }
quote() { local a; for a; do printf "'%s' " "${a//\'/\'\\\'\'}"; done; } # for a plain sh
read_or() { cat "$1" 2>/dev/null || echo "$2"; }

check_tools() {
    local t
    [ "$(uname -m)" = x86_64 ] || skip "the lab is written for x86_64, this is $(uname -m)"
    have "$VMLAB_QEMU" || skip "$VMLAB_QEMU is not installed (Debian: qemu-system-x86)"
    for t in busybox cpio gzip xz modprobe depmod; do
        have $t || skip "'$t' is not installed (Debian: busybox-static cpio gzip xz-utils kmod)"
    done
    if ldd "$(command -v busybox)" >/dev/null 2>&1; then
        skip "busybox here is not static (Debian: busybox-static)"
    fi
}

# ---- packages ----

# shellcheck disable=SC2086 # VMLAB_APT_OPTS is a list
apt_get() { apt-get $VMLAB_APT_OPTS "$@"; }

# Package lists may be missing or older than the archive: at most once, fetch them.
update_lists() {
    [ ! -f "$VMLAB_CACHE/lists-updated" ] || return 1
    : >"$VMLAB_CACHE/lists-updated" # a file: callers run in subshells
    say "updating package lists"
    apt_get update >"$VMLAB_CACHE/apt.log" 2>&1
}

find_deb() { # PACKAGE, FOLDER: path of its .deb
    find "$2" -maxdepth 1 -name "$1_*.deb" 2>/dev/null | head -n 1 | grep .
}

download() {
    (cd "$VMLAB_CACHE/debs" && apt_get download "$1" >"$VMLAB_CACHE/apt.log" 2>&1)
}

fetch_deb() { # PACKAGE: path of its .deb
    if [ -n "$VMLAB_DEBDIR" ]; then find_deb "$1" "$VMLAB_DEBDIR"; return; fi
    mkdir -p "$VMLAB_CACHE/debs"
    find_deb "$1" "$VMLAB_CACHE/debs" && return
    have apt-get || return 1
    download "$1" || { update_lists && download "$1"; } || return 1
    find_deb "$1" "$VMLAB_CACHE/debs"
}

newest_kernel() {
    # shellcheck disable=SC2086
    apt-cache $VMLAB_APT_OPTS depends linux-image-amd64 2>/dev/null |
        sed -nE 's/.*Depends: (linux-image-[0-9].*)/\1/p' | head -n 1
}

kernel_package() {
    local name
    if [ -n "$VMLAB_KERNEL" ]; then echo "$VMLAB_KERNEL"; return; fi
    if [ -n "$VMLAB_DEBDIR" ]; then
        find "$VMLAB_DEBDIR" -name 'linux-image-[0-9]*_*.deb' | head -n 1 | sed 's/.*\///; s/_.*//'
        return
    fi
    have apt-cache || return
    name=$(newest_kernel)
    [ -n "$name" ] || { update_lists && name=$(newest_kernel); }
    echo "$name"
}

# ---- prepare ----

# The ELF image inside the kernel image boots through its PVH entry: under emulation
# that saves the seconds the guest would need to decompress itself.
extract_vmlinux() { # IMAGE, OUTPUT
    local image=$1 out=$2 kind magic tool off
    for kind in '\xfd\x37\x7a\x58\x5a\x00 xz' '\x1f\x8b\x08 gzip' '\x28\xb5\x2f\xfd zstd'; do
        magic=${kind% *} tool=${kind#* }
        have "$tool" || continue
        for off in $(LC_ALL=C grep -aboP "$magic" "$image" | cut -d: -f1 | head -n 4); do
            tail -c +$((off + 1)) "$image" | "$tool" -dc 2>/dev/null >"$out"
            if [ "$(head -c 4 "$out" | tail -c 3)" = ELF ]; then return 0; fi
        done
    done
    rm -f "$out"
    return 1
}

# The header packages hold absolute links and paths: let them point into our copy.
relocate_headers() { # COPY, HEADER FOLDER
    local copy=$1 dir=$2 kbuild link target
    kbuild=$(find "$copy/usr/lib" -maxdepth 1 -name 'linux-kbuild-*' | head -n 1)
    find "$copy/usr/src" "$kbuild" -type l | while read -r link; do
        target=$(readlink "$link")
        case $target in
            /usr/*) ln -sfn "$copy$target" "$link" ;;
            */lib/linux-kbuild-*) ln -sfn "$kbuild/${target#*/lib/linux-kbuild-*/}" "$link" ;;
        esac
    done
    sed -i "s#/usr/src/#$copy/usr/src/#g" "$dir/Makefile" "$dir/.kernelvariables" 2>/dev/null
}

# Debian's kernels come without gpio-sim. It is built here from the kernel's own
# source, together with irq_sim, in which one function that modules cannot reach is
# reached another way. The compiler has to be of the kernel's generation.
build_gpio_sim() { # KERNEL VERSION, MODULE FOLDER
    local version=$1 modules=$2 base release work h deb dir
    base=$(echo "$version" | sed -E 's/^([0-9]+\.[0-9]+).*/\1/')
    release=${version%-[a-z0-9]*}
    work=$VMLAB_CACHE/gpio-sim
    rm -rf "$work"
    mkdir -p "$work/headers" "$work/module"
    for h in "linux-headers-$version" "linux-headers-$release-common" "linux-kbuild-$base"; do
        # newer releases name kbuild after the whole version
        deb=$(fetch_deb "$h") || deb=$(fetch_deb "linux-kbuild-$release") || continue
        dpkg-deb -x "$deb" "$work/headers"
    done
    dir=$work/headers/usr/src/linux-headers-$version
    [ -d "$dir" ] || { say "gpio-sim: no headers for $version"; return 1; }
    relocate_headers "$work/headers" "$dir"
    deb=$(fetch_deb "linux-source-$base") || { say "gpio-sim: no package linux-source-$base"; return 1; }
    dpkg-deb --fsys-tarfile "$deb" | tar -xO "./usr/src/linux-source-$base.tar.xz" |
        tar -xJ -C "$work" --strip-components=1 --wildcards '*/drivers/gpio/gpio-sim.c' \
            '*/drivers/gpio/gpiolib.h' '*/drivers/gpio/dev-sync-probe.[ch]' '*/kernel/irq/irq_sim.c' 2>/dev/null
    [ -f "$work/drivers/gpio/gpio-sim.c" ] || { say "gpio-sim: its source was not found"; return 1; }
    cp "$work"/drivers/gpio/*.h "$work/module/"
    cp "$work/drivers/gpio/gpio-sim.c" "$work/module/gpio_sim_core.c"
    sed 's/irq_to_desc(irqnum)/irq_data_to_desc(irq_get_irq_data(irqnum))/' \
        "$work/kernel/irq/irq_sim.c" >"$work/module/irq_sim_core.c"
    printf 'obj-m := gpio-sim.o\ngpio-sim-y := gpio_sim_core.o irq_sim_core.o\n' >"$work/module/Kbuild"
    if [ -f "$work/drivers/gpio/dev-sync-probe.c" ]; then
        cp "$work/drivers/gpio/dev-sync-probe.c" "$work/module/"
        echo 'gpio-sim-y += dev-sync-probe.o' >>"$work/module/Kbuild"
    fi
    make -C "$dir" M="$work/module" modules >"$VMLAB_CACHE/gpio-sim.log" 2>&1 ||
        { say "gpio-sim: does not build"; tail -n 5 "$VMLAB_CACHE/gpio-sim.log" >&2; return 1; }
    mkdir -p "$modules/extra" && cp "$work/module/gpio-sim.ko" "$modules/extra/"
    rm -rf "$work"
}

# The modules wanted and what they need, in order; absent ones are noted.
collect_modules() { # MODULE ROOT, KERNEL VERSION, INITRAMFS FOLDER
    local root=$1 version=$2 ird=$3 m how file list seen=" "
    : >"$ird/mods/boot"
    : >"$ird/mods/late"
    : >"$ird/mods/missing"
    for m in $BOOT_MODULES $VMLAB_MODULES; do
        case " $BOOT_MODULES " in *" $m "*) list=boot ;; *) list=late ;; esac
        if ! PATH=$PATH:/sbin modprobe -d "$root" -S "$version" --show-depends "$m" >"$VMLAB_CACHE/deps" 2>/dev/null; then
            echo "$m" >>"$ird/mods/missing"
            continue
        fi
        while read -r how file _; do
            [ "$how" = insmod ] || continue
            case $seen in *" $file "*) continue ;; esac
            seen="$seen$file "
            cp "$file" "$ird/mods/"
            basename "$file" >>"$ird/mods/$list"
        done <"$VMLAB_CACHE/deps"
    done
    rm -f "$VMLAB_CACHE/deps"
}

make_initramfs() { # MODULE ROOT, KERNEL VERSION
    local ird=$VMLAB_CACHE/initramfs
    rm -rf "$ird"
    mkdir -p "$ird"/{bin,dev,proc,sys,lower,rw,new,mods}
    cp "$(command -v busybox)" "$ird/bin/busybox"
    ln -s busybox "$ird/bin/sh"
    collect_modules "$1" "$2" "$ird"
    cp "$here/guest-init.sh" "$ird/init"
    chmod 755 "$ird/init"
    (cd "$ird" && find . | cpio -o -H newc --quiet) | gzip -1 >"$VMLAB_CACHE/initramfs.gz" || die "initramfs failed"
    cp "$ird/mods/missing" "$VMLAB_CACHE/missing"
    rm -rf "$ird"
}

# Everything that the result depends on, to see whether it is still good.
recipe() { echo "$1|$VMLAB_MODULES|$(cat "$here/guest-init.sh" "$here/vmlab.sh" | cksum)"; }

cmd_prepare() {
    local package deb root version modules
    check_tools
    mkdir -p "$VMLAB_CACHE" || die "cannot write $VMLAB_CACHE"
    VMLAB_CACHE=$(cd "$VMLAB_CACHE" && pwd)
    exec 9>"$VMLAB_CACHE/lock"
    have flock && flock 9 # one preparation at a time
    package=$(kernel_package)
    [ -n "$package" ] || skip "no kernel package known (no apt, or its lists cannot be fetched)"
    [ "$(read_or "$VMLAB_CACHE/ready" none)" != "$(recipe "$package")" ] || return 0
    rm -f "$VMLAB_CACHE/ready" "$VMLAB_CACHE/lists-updated"
    deb=$(fetch_deb "$package") || skip "kernel package $package cannot be fetched"
    root=$VMLAB_CACHE/kernel
    rm -rf "$root"
    mkdir -p "$root"
    dpkg-deb -x "$deb" "$root" || die "cannot unpack $deb"
    [ ! -d "$root/usr/lib/modules" ] || [ -d "$root/lib" ] || ln -s usr/lib "$root/lib"
    version=$(basename "$(find "$root/lib/modules/" -mindepth 1 -maxdepth 1 | head -n 1)")
    modules=$root/lib/modules/$version
    find "$modules" -name '*.ko.xz' -exec xz -d {} +
    [ -f "$root/boot/vmlinuz-$version" ] || die "no kernel image in $package"
    extract_vmlinux "$root/boot/vmlinuz-$version" "$VMLAB_CACHE/vmlinux" ||
        cp "$root/boot/vmlinuz-$version" "$VMLAB_CACHE/vmlinux"
    if [ "$VMLAB_GPIO_SIM" != no ] && ! find "$modules" -name gpio-sim.ko | grep -q .; then
        build_gpio_sim "$version" "$modules" || [ "$VMLAB_GPIO_SIM" = auto ] || die "gpio-sim was asked for"
    fi
    PATH=$PATH:/sbin depmod -b "$root" "$version" 2>/dev/null
    make_initramfs "$root" "$version"
    rm -rf "$root" "$VMLAB_CACHE/accel" # 400 MB not needed again
    [ "$VMLAB_KEEP" = yes ] || rm -rf "$VMLAB_CACHE/debs"
    [ ! -s "$VMLAB_CACHE/missing" ] || say "not available with $package: $(tr '\n' ' ' <"$VMLAB_CACHE/missing")"
    echo "$version" >"$VMLAB_CACHE/kver"
    recipe "$package" >"$VMLAB_CACHE/ready"
    exec 9>&-
    say "prepared $version, $(du -sh "$VMLAB_CACHE" | cut -f1) in the cache"
}

# ---- run ----

# A /dev/kvm node proves nothing: a host may offer a KVM that runs only special
# guests. So boot once with a limit, and remember.
pick_accel() {
    [ "$VMLAB_ACCEL" = auto ] || { echo "$VMLAB_ACCEL"; return; }
    if [ ! -f "$VMLAB_CACHE/accel" ]; then
        echo tcg >"$VMLAB_CACHE/accel"
        if [ -r /dev/kvm ] && [ -w /dev/kvm ] &&
            VMLAB_ACCEL=kvm VMLAB_TIMEOUT=15 "$here/vmlab.sh" run -- true >/dev/null 2>&1; then
            echo kvm >"$VMLAB_CACHE/accel"
        fi
        say "accelerator chosen by a probe boot: $(cat "$VMLAB_CACHE/accel")"
    fi
    cat "$VMLAB_CACHE/accel"
}

boot() { # RUN FOLDER, ACCELERATOR
    local append="console=ttyS0 panic=-1 mitigations=off nokaslr quiet reboot=t tsc=reliable $VMLAB_CMDLINE"
    # shellcheck disable=SC2086 # VMLAB_MACHINE is a list
    timeout -k 2 "$VMLAB_TIMEOUT" "$VMLAB_QEMU" $VMLAB_MACHINE -accel "$2" -smp "$VMLAB_CPUS" -m "$VMLAB_MEM" \
        -nodefaults -nographic -no-reboot -serial "file:$1/console" -nic none \
        -kernel "$VMLAB_CACHE/vmlinux" -initrd "$VMLAB_CACHE/initramfs.gz" -append "$append" \
        -virtfs "local,path=$VMLAB_ROOT,mount_tag=host,security_model=none,readonly=on,multidevs=remap" \
        -virtfs "local,path=$1/share,mount_tag=out,security_model=none" </dev/null 2>"$1/qemu.err"
}

cmd_run() {
    local accel out status began tail_pid
    check_tools
    [ "${1:-}" != -- ] || shift
    [ $# -gt 0 ] || die "no command"
    [ -f "$VMLAB_CACHE/ready" ] || skip "not prepared: run vmlab.sh prepare first"
    VMLAB_CACHE=$(cd "$VMLAB_CACHE" && pwd)
    export VMLAB_CACHE
    accel=$(pick_accel)
    [ "$accel" != tcg ] || accel=tcg,thread=multi
    out=$(mktemp -d "$VMLAB_CACHE/run.XXXXXX") || die "no temporary folder"
    # shellcheck disable=SC2064 # the folder of now
    trap "rm -rf '$out'" EXIT
    mkdir -p "$out/share/out"
    printf 'cd %s 2>/dev/null || cd /\nexec %s\n' "$(quote "$PWD")" "$(quote "$@")" >"$out/share/cmd"
    : >"$out/share/stdout"
    : >"$out/share/stderr"
    tail -f -n +1 --pid=$$ "$out/share/stdout" &
    tail_pid=$!
    began=$(date +%s.%N)
    boot "$out" "$accel"
    status=$?
    sleep 0.1
    kill $tail_pid 2>/dev/null
    wait $tail_pid 2>/dev/null
    cat "$out/share/stderr" >&2
    if [ -n "$VMLAB_OUT" ]; then mkdir -p "$VMLAB_OUT" && cp -r "$out/share/out/." "$VMLAB_OUT/"; fi
    if [ -n "$VMLAB_VERBOSE" ]; then
        say "$accel $(cat "$VMLAB_CACHE/kver"): $(echo "$(date +%s.%N) $began" | awk '{printf "%.1f", $1 - $2}') s," \
            "guest up $(read_or "$out/share/started" '?') s when the command began"
    fi
    [ "$VMLAB_VERBOSE" != 2 ] || cat "$out/console" >&2
    if [ -f "$out/share/rc" ]; then exit "$(cat "$out/share/rc")"; fi
    say "no exit status from the guest (qemu ended with $status); its console:"
    tail -n 20 "$out/console" "$out/qemu.err" >&2
    if [ $status = 124 ] || [ $status = 137 ]; then exit 124; fi
    exit 125
}

cmd_check() {
    check_tools
    [ -f "$VMLAB_CACHE/ready" ] || [ -n "$VMLAB_DEBDIR" ] || have apt-get || skip "no way to fetch a kernel package"
    say "the lab can run here"
}

case ${1:-} in
    check) cmd_check ;;
    prepare) cmd_prepare ;;
    run) shift; cmd_run "$@" ;;
    clean) rm -rf "$VMLAB_CACHE" ;;
    *) sed -n '2,/^set -u/{/^set -u/d;s/^# \{0,1\}//;p}' "$0"; exit 2 ;;
esac
