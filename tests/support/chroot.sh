# Sourced by tests/compat/run and tests/package/run: Debian releases in a chroot.
# shellcheck shell=bash

say() { printf '%s\n' "$*" >&2; }

# chroot_needs: root and debootstrap, or an end with a message.
chroot_needs() {
    [ "$EUID" -eq 0 ] || {
        say "A chroot needs root: run this as root."
        exit 1
    }
    command -v debootstrap >/dev/null || {
        say "debootstrap is missing: apt-get install debootstrap"
        exit 1
    }
}

# chroot_make RELEASE PLACE: the release's smallest system, unless it is there already.
chroot_make() {
    local release=$1 place=$2 scripts=/usr/share/debootstrap/scripts script=() log
    [ ! -e "$place/.complete" ] || return 0
    say "Making Debian $release in $place"
    mkdir -p "$place"
    [ -e "$scripts/$release" ] || script=("" "$scripts/sid") # a release newer than debootstrap
    log=$(mktemp)
    debootstrap --variant=minbase "$release" "$place" "${script[@]}" >"$log" 2>&1 || {
        tail -n 20 "$log" >&2
        say "debootstrap failed; the log is $log"
        return 1
    }
    rm -f "$log"
    # A mirror of testing that stands still for some weeks is good enough to test on.
    echo 'Acquire::Check-Valid-Until "false";' >"$place/etc/apt/apt.conf.d/99-old-mirror"
    touch "$place/.complete"
}

# chroot_enter PLACE: mounts what programs expect, and beside the place the packages that apt has fetched, which all
# systems there share; chroot_leave PLACE takes it back.
chroot_enter() {
    local place=$1
    chroot_leave "$place"
    mount -t proc proc "$place/proc"
    mount --bind /dev "$place/dev"
    mount --make-private "$place/dev"
    mount --bind /dev/shm "$place/dev/shm" # FreeCAD's start page needs it, for users other than root
    mount --bind /dev/pts "$place/dev/pts"
    local packages
    packages=$(dirname "$place")/archives
    mkdir -p "$packages/partial" "$place/var/cache/apt/archives"
    mount --bind "$packages" "$place/var/cache/apt/archives"
    cp -f /etc/resolv.conf "$place/etc/resolv.conf"
}

chroot_leave() {
    local place=$1 path
    for path in var/cache/apt/archives work/shared dev/shm dev/pts dev proc; do
        ! mountpoint -q "$place/$path" || umount "$place/$path" 2>/dev/null || umount -l "$place/$path"
    done
}

# inside PLACE COMMAND...: runs it there as root, with an environment of its own.
inside() {
    local place=$1
    shift
    chroot "$place" env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        HOME=/root LANG=C.UTF-8 TERM=dumb DEBIAN_FRONTEND=noninteractive \
        BELTGRINDING_SHARED=/work/shared BELTGRINDING_STRICT="${BELTGRINDING_STRICT:-}" "$@"
}
