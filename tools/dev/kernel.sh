# The kernel of the virtual machine behind ./dev test-hid.

# Debian's own kernel, unpacked under the user's cache, never installed: sets kernel to the folder that holds vmlinuz
# and the modules of its HID and USB gadget drivers.
find_kernel() {
    is_debian || die "the virtual machine's kernel comes from Debian packages; this is no Debian"
    [[ $(dpkg --print-architecture) == amd64 ]] || die "the virtual machine is an x86-64 one"
    local package
    package=$(apt-cache depends linux-image-amd64 2>/dev/null |
        sed -nE 's/^ *Depends: (linux-image-[0-9].*)$/\1/p' | head -n 1)
    if [[ -z $package ]] && ((EUID == 0)); then
        apt-get update -qq
        package=$(apt-cache depends linux-image-amd64 |
            sed -nE 's/^ *Depends: (linux-image-[0-9].*)$/\1/p' | head -n 1)
    fi
    [[ -n $package ]] || die "apt knows no kernel: run apt-get update as root"
    kernel=$cache/kernel/$package
    fetch_once "$kernel/vmlinuz" "$package" fetch_kernel "$package"
}

fetch_kernel() { # fetch_kernel PACKAGE: into $kernel
    local work=$cache/kernel.part
    rm -rf "$work"
    mkdir -p "$work/files" "$cache/kernel"
    (cd "$work" && apt-get -qq -o APT::Sandbox::User= download "$1")
    dpkg-deb --fsys-tarfile "$work"/*.deb | tar -x -C "$work/files" --wildcards \
        --no-anchored --transform='s,.*/,,' 'boot/vmlinuz-*' {usb-common,usbcore,hid}.ko \
        {hid-generic,usbhid,uhid,udc-core,configfs,libcomposite,usb_f_hid,dummy_hcd}.ko
    mv "$work"/files/vmlinuz-* "$work/files/vmlinuz"
    mv "$work/files" "$kernel"
    rm -rf "$work"
}
