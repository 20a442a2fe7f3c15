#!/bin/sh
# PID 1 of the lab's guest (busybox): mounts the host's root read-only with a scratch
# layer over it, loads modules, runs /run/vmlab/cmd in it, reports, powers off.
B=/bin/busybox
fail() {
    echo "guest-init: $*" >/dev/console
    $B reboot -f
}
load() { # LIST
    while read -r m; do
        $B insmod "/mods/$m" || echo "guest-init: cannot load $m"
    done <"$1"
}

$B mount -t proc proc /proc
$B mount -t sysfs sys /sys
$B mount -t devtmpfs dev /dev
load /mods/boot
share=trans=virtio,version=9p2000.L,msize=512000
$B mount -t 9p -o $share,ro,cache=loose host /lower || fail "no share of the host's root"
$B mount -t tmpfs rw /rw
$B mkdir /rw/up /rw/work
$B mount -t overlay -o lowerdir=/lower,upperdir=/rw/up,workdir=/rw/work root /new || fail "no overlay"
load /mods/late
for d in proc sys dev run tmp; do
    $B mkdir -p /new/$d
done
for d in proc sys dev; do
    $B mount --move /$d /new/$d
done
$B mount -t tmpfs run /new/run
$B mkdir -p /new/run/vmlab /new/dev/pts /new/dev/shm
$B mount -t devpts pts /new/dev/pts
$B mount -t tmpfs shm /new/dev/shm
$B mount -t 9p -o $share,cache=none out /new/run/vmlab || fail "no share for the output"
$B mount -t configfs cfg /new/sys/kernel/config
$B cp /mods/missing /new/run/vmlab-missing-modules
read -r up _ </new/proc/uptime
echo "$up" >/new/run/vmlab/started
export PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root TERM=dumb VMLAB=1
$B chroot /new /bin/sh /run/vmlab/cmd </new/dev/null >/new/run/vmlab/stdout 2>/new/run/vmlab/stderr
echo $? >/new/run/vmlab/rc.new
$B mv /new/run/vmlab/rc.new /new/run/vmlab/rc
$B poweroff -f
