N100 (MILL TWO FLATS, METHOD A: EACH FLAT BY ITSELF)
G40
G13.1
T0101
M5
M35
G28 H0
G97 S1000 M33
G0 Z.1 C0
X1.8
G12.1
G1 G98 C0.4153 F20. (expect: feed-outside-recommended-range)
G1 G41 X1.0 F5.
Z-.375 (DEPTH OF CUT)
C-0.4153
G40 X1.8 F20. (expect: feed-outside-recommended-range)
G13.1
G0 Z0.1
G0 C180.
G12.1
G1 G98 C0.4153 F20. (expect: feed-outside-recommended-range)
G1 G41 X1.0 F5.
Z-.375 (DEPTH OF CUT)
C-0.4153
G40 X1.8 F20. (expect: feed-outside-recommended-range)
G13.1
G0 Z0.1
G0 X5. Z5. M35
M1
