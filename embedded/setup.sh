#!/usr/bin/env bash
# Fetches the tools of `cargo xtask embedded` and of the tests of exported C: compilers for bare machines, for Arm and for
# WebAssembly, linkers, QEMU, and Node.
#
# They are Debian's packages (of Debian 12, where `rustc-web` is), unpacked into a folder of this clone. Nothing is installed, nothing
# is removed, and root is not needed: the package lists are kept in that folder too. `cargo clean` removes all of it.
#
#   embedded/setup.sh [FOLDER]        FOLDER is target/embedded/tools unless told otherwise
set -euo pipefail
cd "$(dirname "$0")/.."

PACKAGES=(rustc-web cargo-web rust-web-src clang lld qemu-system-arm gcc-arm-none-eabi
    libnewlib-arm-none-eabi nodejs)
COMMANDS=(rustc cargo clang ld.lld wasm-ld qemu-system-arm arm-none-eabi-gcc arm-none-eabi-objdump node)
# Documentation, and libraries for chips of other kinds than a Cortex-M7.
OTHERS=({arm,thumb/{nofp,'v6*',v7,'v7[+-]*',v7e-m,v7e-m+fp,'v7ve*','v8*'}})
UNUSED=('./usr/share/doc/*' "${OTHERS[@]/#/./usr/lib/gcc/arm-none-eabi/*/}"
    "${OTHERS[@]/#/./usr/lib/arm-none-eabi/newlib/}")

tools=${1:-${CARGO_TARGET_DIR:-target}/embedded/tools}
mkdir -p "$tools"/{root,bin,lists/partial,archives/partial}
tools=$(cd "$tools" && pwd)
root=$tools/root

fail() { printf 'embedded/setup.sh: %s\n' "$*" >&2; exit 1; }
for command in apt-get dpkg-deb; do
    command -v "$command" >/dev/null || fail "$command is missing: this script needs Debian or one of its kin"
done

apt() {
    apt-get -qq -o Dir::State::Lists="$tools/lists" -o Dir::Cache::Archives="$tools/archives" \
        -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= -o APT::Sandbox::User="$(id -un)" -o Debug::NoLocking=1 "$@"
}

# What it would take to install them here. That apt might have to remove something for it does not matter: nothing is installed.
missing() {
    apt -s install --no-install-recommends "${PACKAGES[@]}" | awk '/^Inst /{print $2}'
}

unpack() {
    local package=$1
    [ -e "$tools/lists/.$package" ] && return
    rm -f "$tools"/archives/"${package%%:*}"_*.deb
    (cd "$tools/archives" && apt download "$package")
    dpkg-deb --fsys-tarfile "$tools"/archives/"${package%%:*}"_*.deb | tar -x -C "$root" "${UNUSED[@]/#/--exclude=}"
    rm -f "$tools"/archives/"${package%%:*}"_*.deb
    touch "$tools/lists/.$package"
}

# A launcher that finds the libraries beside the program, or the system's own program where it is installed already.
launcher() {
    local command=$1 program=$root/usr/bin/$1 options=''
    [ -e "$program" ] || program=$(PATH=/usr/bin:/bin command -v "$command") || fail "$command has not come with the packages"
    if [ "${program#"$root"}" != "$program" ]; then
        case $command in
        rustc) options="--sysroot '$root/usr'" ;;
        # Where Debian's gcc has newlib.
        arm-none-eabi-gcc) options="-idirafter '$root/usr/include/newlib' -B '$root/usr/lib/arm-none-eabi/newlib/'" ;;
        esac
    fi
    local multiarch; multiarch=$(dpkg --print-architecture | sed 's/amd64/x86_64/; s/arm64/aarch64/')-linux-gnu
    cat > "$tools/bin/$command" <<END
#!/bin/sh
LD_LIBRARY_PATH='$root/usr/lib/$multiarch:$root/lib/$multiarch:$root/usr/lib' exec '$program' $options "\$@"
END
    chmod +x "$tools/bin/$command"
}

apt update
packages=$(missing) || fail "apt does not know these packages: ${PACKAGES[*]}"
for package in $packages; do unpack "$package"; done
for command in "${COMMANDS[@]}"; do launcher "$command"; done
for command in "${COMMANDS[@]}"; do "$tools/bin/$command" --version >/dev/null || fail "$command does not start"; done
# Its presence says that the folder is whole.
printf '%s\n' "${PACKAGES[@]}" > "$tools/complete"
du -sh "$tools" | sed 's/^/tools: /'
