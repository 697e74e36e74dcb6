#!/bin/bash
# Debian's octave-matgeom 1.2.3: enclosingCircle, "the minimum circle enclosing a set of points", leaves points out: of (0, 0), (10, 0) and (5, 1) it encloses two; of a square it is right.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
. "$here/unpack_debian"
unpack_debian octave=7.3.0-2
apt-get -qq download octave-matgeom=1.2.3-3 2> /dev/null
dpkg -x octave-matgeom_*.deb unpacked
libraries="$PWD/unpacked/usr/lib/x86_64-linux-gnu"
cat > run.m <<'END'
warning("off", "all");
for folder = {"geom2d", "polygons2d", "utils"}
  addpath(["unpacked/usr/share/octave/packages/matgeom-1.2.3/" folder{1}]);
end
cases = {[0 0; 10 0; 10 10; 0 10], [5 5 7.07]; [0 0; 10 0; 5 1], [7.5 0.5 2.55]; [0 0; 10 0; 5 1; 5 -1], [7.4 0 2.6]};
disp("octave-matgeom 1.2.3: points, centre and radius, distance of the farthest point from the centre");
for n = 1:3
  points = cases{n, 1};
  circle = enclosingCircle(points);
  printf("%s: %s, %.2f\n", mat2str(points, 3), mat2str(circle, 3), max(hypot(points(:, 1) - circle(1), points(:, 2) - circle(2))));
  assert(circle, cases{n, 2}, 0.005);
end
disp("as seen");
END
export HOME="$PWD" OCTAVE_HOME="$PWD/unpacked/usr" OCTAVE_EXEC_HOME="$PWD/unpacked/usr"
LD_LIBRARY_PATH="$libraries/octave/7.3.0:$libraries:$libraries/blas:$libraries/lapack:$PWD/unpacked/usr/lib:$PWD/unpacked/lib/x86_64-linux-gnu" unpacked/usr/bin/octave-cli -qf run.m 2> messages | tee seen
tail -1 seen | grep -q "as seen" || { cat messages; exit 1; }
