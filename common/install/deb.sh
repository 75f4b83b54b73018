#!/usr/bin/env bash
# deb.sh BUILD STAGES - packs an installation in /usr as out/remodel_VERSION_ARCHITECTURE.deb. The libraries that it needs are those
# of the Debian that it is made on.
set -euo pipefail
build=$1 stages=$2
version=$(sed -nE 's/.*REMODEL_VERSION "(.*)"/\1/p' common/base/version.h)
architecture=$(dpkg --print-architecture)
work=$(mktemp -d "${TMPDIR:-/tmp}/remodel-deb.XXXXXX")
trap 'rm -rf "$work"' EXIT
chmod 755 "$work"
common/install/install.sh "$build" /usr "$work/root" "$stages"
gzip -9n "$work"/root/usr/share/man/man1/*.1
mv "$work/root/usr/share/doc/remodel/LICENSE" "$work/root/usr/share/doc/remodel/copyright"
mkdir -p "$work/debian" "$work/root/DEBIAN"
printf 'Source: remodel\n\nPackage: remodel\nArchitecture: any\n' >"$work/debian/control"
libraries=$(cd "$work" && dpkg-shlibdeps -O root/usr/lib/remodel/build/bin/* 2>/dev/null | sed -n 's/^shlibs:Depends=//p')
[ -n "$libraries" ] || { echo "make deb: dpkg-shlibdeps names no libraries; run it by hand on $build/bin to see why." >&2; exit 1; }
# where HEIC and AVIF are read by plugins (Debian 13), photos of phones need them
! apt-cache show libheif-plugin-libde265 >/dev/null 2>&1 || libraries="$libraries, libheif-plugin-libde265, libheif-plugin-dav1d"
cat >"$work/root/DEBIAN/control" <<TEXT
Package: remodel
Version: $version
Architecture: $architecture
Maintainer: The remodel authors <remodel@localhost>
Installed-Size: $(du -sk "$work/root" | cut -f1)
Depends: $libraries, bash, make, util-linux, colmap, ffmpeg, opencv-data
Recommends: bash-completion
Suggests: slurm-client
Section: graphics
Priority: optional
Description: 3D pan & scan videos and editable models of rooms from photographs
 From a folder of photographs it makes a 3D pan & scan video of a scene, an
 editable image-based model of an interior whose walls and windows can be moved
 under photographic texture, and relit renders of the remodelled rooms.
TEXT
mkdir -p out
package=out/remodel_${version}_$architecture.deb
dpkg-deb --root-owner-group -Zxz --build "$work/root" "$work/made.deb" >/dev/null
mv "$work/made.deb" "$package"
echo "made $package ($(du -h "$package" | cut -f1)); install it with: apt-get install ./$package"
