#!/bin/bash
# Debian's libmath-clipper-perl 1.29 (Perl, Math::Clipper): area cuts coordinates to whole numbers: a square of 1.5 has an area of 1, one of 0.9 none; the round corners of an offset, which is right, count as 32 instead of 50.
set -eu
folder=$(mktemp -d); trap 'rm -rf "$folder"' EXIT; cd "$folder"
apt-get -qq download libmath-clipper-perl=1.29-2+b1 2> /dev/null
dpkg -x libmath-clipper-perl_*.deb unpacked
cat > run.pl <<'END'
use strict;
use warnings;
use Math::Clipper ":all";

sub crossed {
    my @points = @{ $_[0] };
    my $double = 0;
    $double += $points[ $_ - 1 ][0] * $points[$_][1] - $points[$_][0] * $points[ $_ - 1 ][1] for 0 .. $#points;
    return $double / 2;
}

sub square { my $side = shift; return [ [ 0, 0 ], [ $side, 0 ], [ $side, $side ], [ 0, $side ] ] }
my $rounded = offset( [ [ [ 0, 0 ], [ 100, 0 ], [ 100, 60 ], [ 0, 60 ] ] ], 4, 1e5, JT_ROUND )->[0];
print "Math::Clipper $Math::Clipper::VERSION: its area, that of the coordinates\n";
for ( [ "square of 2", square(2), 4 ], [ "of 1.5", square(1.5), 1 ], [ "of 0.9", square(0.9), 0 ], [ "100 by 60 with 4 around it", $rounded, 7312 ] ) {
    my ( $name, $polygon, $seen ) = @$_;
    my $area = area($polygon);
    printf "%s: %g, %.2f\n", $name, $area, crossed($polygon);
    die "changed" unless $area == $seen;
}
END
PERL5LIB=$(echo unpacked/usr/lib/x86_64-linux-gnu/perl5/*) perl run.pl
