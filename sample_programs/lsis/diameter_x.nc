O0002
G40 G97 G98
T0101
G0 X120. C0 Z5.
G112              (expect: diameter-radius-mixed)
G1 X40. C10. F100
G3 X20. C20. I-10. J0
G1 X-20.
G3 X-40. C10. I0 J-10.
G1 C0
G113
G0 Z100.
M30
