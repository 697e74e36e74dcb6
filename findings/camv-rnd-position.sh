#!/bin/bash
# camv-rnd 1.1.0, its reading of G-code: G91 counts the position twice, so that the next move begins at X20 where the tool is at X10; G20 takes the position times 25.4.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
apt-get -qq download camv-rnd-core=1.1.0-3 camv-rnd-import=1.1.0-3 camv-rnd-export-vector=1.1.0-3 librnd3=3.2.2-1 libfungw1 libfreetype6 libpng16-16 libbrotli1 2> /dev/null
for package in *.deb; do dpkg -x "$package" unpacked; done
ln -s unpacked/usr/lib/camv-rnd/plugins plugins
export HOME="$folder" LD_LIBRARY_PATH="$folder/unpacked/usr/lib:$folder/unpacked/usr/lib/x86_64-linux-gnu"

# Prints where the moves of a program begin and end, and fails unless it is what the finding says.
expect_moves() {
    printf "$2\nM30\n" > program.gcode
    seen=$(timeout 60 unpacked/usr/bin/camv-rnd -x svg program.gcode < /dev/null 2> /dev/null | sed -nE 's/(TRAVEL|LINEAR) ([-0-9.]+);.* -> ([-0-9.]+);.*/\2 to \3/p')
    printf '%s:\n%s\n' "$1" "$seen"
    test "$seen" = "$3"
}
echo "camv-rnd 1.1.0, X of the moves"
expect_moves "G0 X10, G91, G1 X5, X5" 'G21 G90\nG0 X10 Y0\nG91\nG1 X5 Y5\nG1 X5 Y0' "0.000000 to 10.000000
20.000000 to 25.000000
25.000000 to 30.000000"
expect_moves "G0 X25.4, G20, G1 X2" 'G21 G90\nG0 X25.4 Y0\nG20\nG1 X2' "0.000000 to 25.400000
645.160000 to 50.800000"
