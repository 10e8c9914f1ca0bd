#!/bin/busybox sh
# The first process of the virtual machine: modules, the test, power off.
/bin/busybox --install -s /bin
mount -t proc proc /proc
mount -t sysfs sysfs /sys
mount -t devtmpfs devtmpfs /dev
for module in $(cat /modules/order); do
    insmod "/modules/$module" || echo "no module $module"
done
mount -t configfs configfs /sys/kernel/config
# One argument a line: a name of a test has spaces.
set --
while read -r argument; do
    set -- "$@" "$argument"
done </arguments
/bin/spidar_hid_vm "$@"
echo "RESULT rc=$?"
poweroff -f
