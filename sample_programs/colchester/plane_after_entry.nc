%
O0002
G21 G40 G97 G98
T0101
M109
G28 H0
G0 X60. Z5.
G0 C0
G12.1
G18               (expect: plane-selected-in-polar)
G1 X40. F1500
C10. F200
X60.
G13.1
M110
G0 Z100.
M30
%
