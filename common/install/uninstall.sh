#!/usr/bin/env bash
# uninstall.sh PREFIX DESTDIR - removes what install.sh installed there.
set -euo pipefail
to=$2${1%/}
[ -e "$to/lib/remodel/common/make/installed" ] || { echo "make uninstall: remodel is not installed in $to. Give the PREFIX and DESTDIR that it was installed with." >&2; exit 2; }
rm -rf "$to/lib/remodel" "$to/share/doc/remodel" "$to/bin/remodel" "$to/share/bash-completion/completions/remodel"
rm -f "$to/share/man/man1/remodel.1" "$to"/share/man/man1/remodel-*.1
