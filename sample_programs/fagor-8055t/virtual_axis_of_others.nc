%FACE OF THE PART,MX,
G71 G90 G18
T1 D1 M6
G94
M51
G15
G16 XC
G0 X40. C0
G0 Z5.
G1 X20. F300
Y10.              ;(expect: wrong-axis-address-in-polar)
X40.
G0 Z50.
G18
M50
M30
