#!/bin/bash
# LinuxCNC 2.9.0~pre1, rs274: a name that is set for the first time in the same block reads as 0 there, not as its value; a name that is not set at all is an error.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_rs274"
seen() { paths "G20\n$1" | tail -1 | sed 's/\.0000,.*//'; }
echo "rs274 of linuxcnc-uspace 2.9.0~pre1"
expect "#<a>=7 G0 X#<a>" "$(seen '#<a>=7 G0 X#<a>')" "STRAIGHT_TRAVERSE(0"
expect "#<a>=7, then G0 X#<a>" "$(seen '#<a>=7\nG0 X#<a>')" "STRAIGHT_TRAVERSE(7"
paths 'G0 X#<a>' > /dev/null
expect "G0 X#<a>" "$(unpacked/usr/bin/rs274 -g -t tools.tbl program.ngc < /dev/null 2>&1 | grep Named)" "Named parameter #<a> not defined"
