#!/usr/bin/env bash
# deps.sh auto|manual GROUP... - checks what configs/packages.txt lists for the groups, names what is missing, and installs it
# with apt (as root, or through sudo). manual: only prints the command to run, and fails.
set -euo pipefail
mode=$1; shift
missing=() reasons=()
# shellcheck source=/dev/null
debian=$([ ! -e /etc/os-release ] || (. /etc/os-release && [ "$ID" = debian ] && echo "${VERSION_ID-}") || true)
while read -r group package probe since; do
    [[ $group != \#* && -n $group && " $* " == *" $group "* ]] || continue
    [ -z "$since" ] || [ "${debian:-0}" -ge "$since" ] || continue
    case $probe in
    command:*) PATH=$PATH:/usr/sbin command -v "${probe#*:}" >/dev/null && continue ;;
    pkg:*) pkg-config --exists "${probe#*:}" 2>/dev/null && continue ;;
    header:*) compgen -G "/usr/include/${probe#*:}" >/dev/null && continue ;;
    file:*) compgen -G "${probe#*:}" >/dev/null && continue ;;
    *) echo "configs/packages.txt: found the probe '$probe', wanted command:, pkg:, header: or file:." >&2; exit 2 ;;
    esac
    missing+=("$package") reasons+=("${probe#*:}")
done <configs/packages.txt
[ ${#missing[@]} -gt 0 ] || exit 0

echo "Missing: ${reasons[*]}" >&2
line="apt-get install -y --no-install-recommends ${missing[*]}"
root=
if [ "$(id -u)" != 0 ]; then root=sudo; fi
if [ "$mode" = manual ]; then
    echo "Run this, then try again:" >&2
    echo "  ${root:+$root }$line"
    exit 1
fi
if [ "$mode" != auto ]; then echo "DEPS=$mode is not one of: auto manual" >&2; exit 2; fi
if ! command -v apt-get >/dev/null; then
    echo "This machine has no apt-get. Install these Debian packages by other means: ${missing[*]}" >&2; exit 1
fi
if [ -n "$root" ] && ! command -v sudo >/dev/null; then
    echo "Installing needs root, and sudo is not installed. Run as root:" >&2
    echo "  $line" >&2; exit 1
fi
echo "Installing with apt: ${missing[*]} (DEPS=manual only prints the line)" >&2
export DEBIAN_FRONTEND=noninteractive
log=$(mktemp)
if ! { $root apt-get update -qq && $root env DEBIAN_FRONTEND=noninteractive $line -qq; } >"$log" 2>&1; then
    tail -n 15 "$log" >&2
    echo "apt could not install them; see its output above. Fix that and try again, or install them by hand:" >&2
    echo "  ${root:+$root }$line" >&2
    rm -f "$log"; exit 1
fi
rm -f "$log"
