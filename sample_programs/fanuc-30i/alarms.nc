O0002 (PS0146)
G98 G40 G97
T0101
G0 X120. C0 Z5.
G1 G41 X119. F200
G12.1             (expect: polar-switched-in-offset-mode)
G40 G1 X60.
G0 C10.           (expect: rapid-in-polar)
G1 C0
G54               (expect: origin-shifted-in-polar)
G28 U0            (expect: code-not-allowed-in-polar)
G13.1
M30
