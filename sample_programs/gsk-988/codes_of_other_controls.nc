O0004 (RAPID TRAVERSE, AND G12.1 WITH COMPENSATION IN FORCE)
G98 G97 G40
T0202
G0 X150. C0 Z5.
G12.1
G42 G1 X80. F200
C40.
X-80.
C-40.
X80.
C0
G13.1             (expect: polar-switched-in-offset-mode)
G40 G0 Z100.
X150. C0
G12.1
G0 X120.          (expect: rapid-in-polar)
G1 C20.
G13.1
M30
