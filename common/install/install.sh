#!/usr/bin/env bash
# install.sh BUILD PREFIX DESTDIR STAGES - installs what runs scenes.
#
#   PREFIX/bin/remodel         the command (common/install/remodel.sh)
#   PREFIX/lib/remodel         Makefile, scripts, parameters and programs; a project's folder has links to it
#   PREFIX/share/man/man1      remodel.1, and remodel-STAGE.1 of every stage
#   PREFIX/share/bash-completion/completions/remodel
#   PREFIX/share/doc/remodel   README.md, CHANGELOG.md, LICENSE, docs
set -euo pipefail
build=$1 prefix=$2 destdir=$3 stages=$4
[[ $prefix = /* ]] || { echo "make install: PREFIX=$prefix is not a path from the root. Give one, such as PREFIX=$PWD/$prefix." >&2; exit 2; }
prefix=${prefix%/}
version=$(sed -nE 's/.*REMODEL_VERSION "(.*)"/\1/p' common/base/version.h)
lib=$destdir$prefix/lib/remodel
here=common/install
fill() { sed -e "s|@LIB@|$prefix/lib/remodel|g" -e "s|@VERSION@|$version|g" "$@"; }

mkdir -p "$destdir$prefix" 2>/dev/null && [ -w "$destdir$prefix" ] ||
    { echo "make install: $destdir$prefix cannot be written to. Run it as root, or give another PREFIX, such as PREFIX=$HOME/.local." >&2; exit 1; }
rm -rf "$lib"
mkdir -p "$lib/build/bin" "$lib/build/code" "$lib/common/make" "$lib/common/run" "$lib/configs"
for s in $stages print_graph; do strip -o "$lib/build/bin/$s" "$build/bin/$s"; done
for s in $stages; do cp "$build/code/$s" "$lib/build/code/"; done
if [ -e "$build/wasm/build_model.wasm" ]; then mkdir -p "$lib/build/wasm"; cp "$build/wasm/build_model.wasm" "$lib/build/wasm/"; fi
cp Makefile "$lib/"
cp common/make/{stages,top,graph}.mk "$lib/common/make/"
echo "$version" >"$lib/common/make/installed"
cp common/run/* "$lib/common/run/"
cp configs/* "$lib/configs/"
# of the stages what make and the shell read
for s in $stages; do
    mkdir -p "$lib/stages/$s"
    cp "stages/$s"/*.mk "$lib/stages/$s/"
    # a page's sources, and the code that it runs if it was built
    [ ! -d "stages/$s/page" ] || cp -r "stages/$s/page" "$lib/stages/$s/"
    for f in "stages/$s"/*.sh; do [ ! -e "$f" ] || cp "$f" "$lib/stages/$s/"; done
    [ ! -d "stages/$s/page" ] || cp -r "stages/$s/page" "$lib/stages/$s/"
done

mkdir -p "$destdir$prefix/bin" "$destdir$prefix/share/bash-completion/completions"
fill $here/remodel.sh >"$destdir$prefix/bin/remodel"
chmod 755 "$destdir$prefix/bin/remodel"
man=$destdir$prefix/share/man/man1
mkdir -p "$man"
fill $here/remodel.1 >"$man/remodel.1"
for s in $stages; do sed "1s/^\.TH [^ ]*/.TH REMODEL-${s^^}/" "docs/man/$s.1" >"$man/remodel-$s.1"; done
words=$(common/run/help.sh Makefile common/make/top.mk $(printf 'stages/%s/stage.mk ' $stages))
goals=$(sed -n '/^targets/,/^variables/s/^  \([a-z][a-z-]*\) .*/\1/p' <<<"$words" | tr '\n' ' ')
variables=$(sed -n '/^variables/,/^scenes/s/^  \([A-Z_]*\)=.*/\1=/p' <<<"$words" | tr '\n' ' ')
fill -e "s|@GOALS@|$goals|; s|@VARIABLES@|$variables|; s|@STAGES@|$stages|" $here/completion.bash \
    >"$destdir$prefix/share/bash-completion/completions/remodel"
doc=$destdir$prefix/share/doc/remodel
rm -rf "$doc"; mkdir -p "$doc"
cp -r README.md CHANGELOG.md LICENSE docs "$doc/"
rm -rf "$doc/docs/man"
[ -n "$destdir" ] || echo "installed remodel $version in $prefix; begin with: remodel SCENE=NAME PHOTOS=DIR"
