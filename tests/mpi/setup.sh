#!/usr/bin/env bash
# Fetches Open MPI, and the libclang that its bindings are made with: Debian's packages, unpacked into a folder of this
# clone. Nothing is installed and root is not needed. Where all of them are installed, nothing is fetched.
#
#   eval "$(tests/mpi/setup.sh)"      fetches what is missing; prints what a shell has to know to build and to run
set -euo pipefail
cd "$(dirname "$0")/../.."

# What is read or run from this clone's folder. All of it is fetched unless all of it is installed: files of one package
# refer to those of another by relative paths.
PACKAGES=(libopenmpi-dev libopenmpi3 openmpi-bin openmpi-common libpmix2)
PACKAGES+=(libclang-14-dev libclang1-14 libclang-common-14-dev)
tools=${CARGO_TARGET_DIR:-target}/mpi/tools
mkdir -p "$tools"/{root,bin,lists/partial,archives/partial}
tools=$(cd "$tools" && pwd)
root=$tools/root

fail() { printf 'tests/mpi/setup.sh: %s\n' "$*" >&2; exit 1; }
for command in apt-get dpkg-deb; do
    command -v "$command" >/dev/null || fail "$command is missing: this script needs Debian or one of its kin"
done

apt() {
    apt-get -qq -o Dir::State::Lists="$tools/lists" -o Dir::Cache::Archives="$tools/archives" \
        -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= -o APT::Sandbox::User="$(id -un)" -o Debug::NoLocking=1 "$@" >&2
}

if [ ! -e "$tools/complete" ]; then
    installed=$(dpkg-query --show --showformat='${db:Status-Status}\n' "${PACKAGES[@]}" 2> "$tools/missing" |
        grep --count --line-regexp installed || true)
    # Nothing is to be printed, then: shells find all of it.
    [ "$installed" -lt ${#PACKAGES[@]} ] || exit 0
    apt update
    # What it would take to install them here, but for compilers of Fortran and scripts.
    packages=$(apt -s install --reinstall --no-install-recommends "${PACKAGES[@]}" 2>&1 | awk '/^Inst /{print $2}' |
        grep -vE '^(auto|m4|libgfortran|gfortran|libjs)' || true)
    (cd "$tools/archives" && apt download $packages)
    for archive in "$tools"/archives/*.deb; do
        dpkg-deb --fsys-tarfile "$archive" | tar -x -C "$root" --exclude='./usr/share/doc/*'
        rm "$archive"
    done
fi

multiarch=$(dpkg --print-architecture | sed 's/amd64/x86_64/; s/arm64/aarch64/')-linux-gnu
libraries=$root/usr/lib/$multiarch
mpi=$libraries/openmpi
paths=$mpi/lib:$libraries:$root/lib/$multiarch:$libraries/libpsm1

# The packages' own compiler knows only where they would be installed.
cat > "$tools/bin/mpicc" <<END
#!/bin/sh
flags='-I$mpi/include -L$mpi/lib -lmpi'
case \$1 in -show*) echo "cc \$flags" ;; *) exec cc "\$@" \$flags ;; esac
END
cat > "$tools/bin/mpirun" <<END
#!/bin/sh
export OPAL_PREFIX='$root/usr' OPAL_LIBDIR='$mpi/lib' OPAL_PKGLIBDIR='$mpi/lib/openmpi3' OPAL_DATADIR='$root/usr/share' \\
    OPAL_PKGDATADIR='$root/usr/share/openmpi' OPAL_SYSCONFDIR='$root/etc/openmpi' PMIX_INSTALL_PREFIX='$libraries/pmix2' \\
    LD_LIBRARY_PATH='$paths' PMIX_MCA_pcompress_base_silence_warning=1 \\
    OMPI_MCA_mca_base_component_show_load_errors=0
exec '$root/usr/bin/orterun' "\$@"
END
chmod +x "$tools/bin"/*
for file in "$mpi/lib/libmpi.so" "$root/usr/bin/orterun" "$libraries/libclang-14.so"; do
    [ -e "$file" ] || fail "$file has not come with the packages"
done
touch "$tools/complete"

headers=$(printf '%s\n' "$root"/usr/lib/clang/*/include | head -n 1)
printf 'export PATH=%q:"$PATH" MPICC=%q LIBCLANG_PATH=%q BINDGEN_EXTRA_CLANG_ARGS=%q LD_LIBRARY_PATH=%q\n' \
    "$tools/bin" "$tools/bin/mpicc" "$libraries" "-I$headers" "$paths"
