# SPDX-License-Identifier: BSD-2-Clause
# make install gives what pkg-config and a C compiler need, and the example builds against it, shared and static.
. tests/cli/lib.bash
case $B in *asan*) skip "the sanitized build is not one to install" ;; esac

expect 0 make -s config="$(basename "$B")" install DESTDIR="$T/root" PREFIX=/usr MAKEFLAGS=
export PKG_CONFIG_SYSROOT_DIR="$T/root" PKG_CONFIG_LIBDIR="$T/root/usr/lib/pkgconfig"
# shellcheck disable=SC2046
expect 0 cc docs/examples/pose.c -o "$T/pose" $(pkg-config --define-prefix=no --cflags --libs libfap 2>/dev/null || pkg-config --cflags --libs libfap)
LD_LIBRARY_PATH="$T/root/usr/lib" expect 0 "$T/pose"
[ -s "$T/out" ] || fail "the example prints nothing"
expect 0 cc -I"$T/root/usr/include" docs/examples/pose.c "$T/root/usr/lib/libfap.a" -lm -o "$T/pose_static"
for page in fapenc fapplay fapbank; do
    [ -s "$T/root/usr/share/man/man1/$page.1" ] || fail "no manual page for $page"
done

# libfap needs libc and libm, nothing else.
nm -D --undefined-only "$T"/root/usr/lib/libfap.so | grep -vE '@GLIBC|__gmon_start__|_ITM_|__cxa_finalize' >"$T/out" || true
[ ! -s "$T/out" ] || fail "libfap.so wants $(cat "$T/out")"
# All it exports begins with fap_.
nm -D --defined-only "$T"/root/usr/lib/libfap.so | awk '{ print $3 }' | grep -v '^fap_' >"$T/out" || true
[ ! -s "$T/out" ] || fail "libfap.so exports $(cat "$T/out")"
# No mutable globals: constants with addresses in them are in .data.rel.ro, which is read only once loaded.
size -A "$T/root/usr/lib/libfap.a" | awk '/ex/ { object = $1 } ($1 ~ /^\.(data|bss)$/ || $1 ~ /^\.(data|bss)\.[^r]/) && $2 > 0 { print object, $1, $2 }' >"$T/out"
[ ! -s "$T/out" ] || fail "libfap has mutable globals: $(cat "$T/out")"
