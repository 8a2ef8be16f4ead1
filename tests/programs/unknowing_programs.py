"""Programs whose motions depend on what stands before them: values, frames, speeds, modes, flow."""

POSITION = (
    "P[{n}]{{\n   GP1:\n\tUF : {f}, UT : 1,\t\tCONFIG : 'N U T, 0, 0, 0',\n\tX = {x} mm, Y = {y} mm, Z = {z} mm,\n"
    "\tW = 180 deg, P = 0 deg, R = 30 deg\n}};\n"
)


def fanuc(statements):
    rows = [f"{k:4}:  {text} ;" for k, text in enumerate(statements, 1)]
    points = "".join(
        POSITION.format(n=n, x=10.5 * n, y=[6, 11, 9, 4][n - 1], z=7 + n, f="F")
        for n in range(1, 5)
    )
    points += (
        POSITION.format(n=5, x=1.5, y=2.5, z=3.5, f="F").replace("180", "0").replace("30", "0")
    )
    return "\n".join(["/PROG P", "/MN", *rows, "/POS", points + "/END", ""])


PROGRAMS = {
    "values.mod": """MODULE M
  CONST robtarget p0 := [[100,0,50],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PERS robtarget p1 := [[110,5,50],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  PERS tooldata tBelt := [FALSE,[[900,0,700],[1,0,0,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];
  TASK PERS wobjdata wPart := [TRUE,TRUE,"",[[0,0,100],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];
  VAR speeddata vG := [35,100,0,0];
  VAR num steps{3} := [1,2,4];
  VAR num k := 2;
  FUNC num twice(num x)
    RETURN 2 * x;
  ENDFUNC
  PROC shift(INOUT robtarget p, num d)
    p.trans.z := p.trans.z + d;
  ENDPROC
  PROC main()
    VAR robtarget q;
    VAR num k := 1;
    q := p0;
    q.trans.x := 120;
    MoveL q, vG, fine, tBelt\\WObj:=wPart;
    shift q, 4;
    MoveL q, v100, z10, tBelt\\WObj:=wPart;
    p1.trans.y := twice(steps{2}) + p1.trans.y;
    MoveL p1, v100\\V:=50, fine, tBelt\\WObj:=wPart;
    vG.v_tcp := 20;
    MoveL RelTool(p1, 0, 0, 3), vG, fine, tBelt\\WObj:=wPart;
    wPart.oframe.trans := [0, 10, 0];
    MoveL Offs(p1, k, 0, 0), vG, fine, tBelt\\WObj:=wPart;
    q := p1;
    WHILE k < 3 DO
      q.trans.x := q.trans.x + 10 * k;
      MoveL q, vG, fine, tBelt\\WObj:=wPart;
      Incr k;
    ENDWHILE
    VelSet 50, 200;
    PDispSet [[0, 0, 5], [1, 0, 0, 0]];
    MoveL p0, v100, fine, tBelt\\WObj:=wPart;
    PDispOff;
    VelSet 100, 5000;
    TEST k
    CASE 3:
      MoveL p0, v50, fine, tBelt\\WObj:=wPart;
    DEFAULT:
      MoveL p1, v50, fine, tBelt\\WObj:=wPart;
    ENDTEST
    MoveAbsJ [[0,10,20,30,40,50],[9E9,9E9,9E9,9E9,9E9,9E9]], v100, fine, tBelt;
    IF k = 3 AND twice(k) > 5 MoveL p0, v50, fine, tBelt\\WObj:=wPart;
    FOR n FROM 1 TO 3 STEP 2 DO
      MoveL Offs(p0, 0, steps{n}, 0), v50, fine, tBelt\\WObj:=wPart;
    ENDFOR
  ENDPROC
ENDMODULE
""",
    "values.script": """def main():
  global height = 0.05
  local a = p[0.4, -0.2, 0.3, 0, 3.14, 0]
  lift = p[0, 0, height, 0, 0, 0]
  set_tcp(p[0, 0, 0.1, 0, 0, 0])
  def up(q):
    global height = height + 0.01
    return pose_add(q, p[0, 0, height, 0, 0, 0])
  end
  speed = 0.05
  b = a
  b[0] = 0.45
  movel(a, a=1.2, v=speed, r=0.001)
  movel(b, a=1.2, v=speed)
  movel(up(a), v=speed)
  movel(up(a), v=0.5 * speed)
  row = [0.4, 0.5, 0.6]
  row[1] = 0.55
  i = 0
  while i < 3:
    movel(p[row[i], -0.2, height, 0, 3.14, 0], v=0.02)
    if i == 1:
      movep(pose_trans(b, p[0, 0, -0.01, 0, 0, 0]), v=0.03, r=0.002)
    end
    i = i + 1
  end
  set_tcp(p[0, 0, 0.2, 0, 0, 0])
  movec(pose_add(b, p[0, 0.01, 0.01, 0, 0, 0]), pose_add(b, p[0, 0.02, 0, 0, 0, 0]), v=0.04, mode=0)
  movej([0, -1.57, 1.57, 0, 0.5, 0], a=1, v=1)
  movel(b, t=2)
end
main()
""",
    "values.ls": fanuc(
        [
            "UFRAME_NUM=2",
            "UTOOL_NUM=1",
            "R[1]=1",
            "R[2]=R[1]*2",
            "L P[1] 100mm/sec FINE",
            "L P[R[1]] R[2]mm/sec CNT50",
            "L P[R[2]] 20mm/sec CNT50",
            "FOR R[3]=2 TO 4",
            "L P[R[3]] 30mm/sec FINE",
            "R[4]=R[3]+R[1]",
            "ENDFOR",
            "IF R[4]=5,JMP LBL[2]",
            "L P[1] 10mm/sec FINE",
            "LBL[2]",
            "IF R[4]>4 THEN",
            "L P[2] 40cm/min FINE",
            "ELSE",
            "L P[3] 40cm/min FINE",
            "ENDIF",
            "UFRAME_NUM=3",
            "C P[3] P[4] 50mm/sec FINE",
            "L P[1] 50mm/sec FINE",
            "LBL[3]",
            "R[1]=R[1]+1",
            "L P[R[1]] 50mm/sec FINE",
            "IF R[1]<3,JMP LBL[3]",
            "L P[5] 20mm/sec FINE INC",
            "A P[1] 20mm/sec CNT10",
            "A P[2] 20mm/sec CNT10",
            "A P[3] 20mm/sec FINE",
            "L P[4] 25mm/sec FINE",
        ]
    ),
    "values.jbi": """/JOB
//NAME VALUES
//POS
///NPOS 5,0,0,2,0,0
///USER 1
///TOOL 2
///POSTYPE USER
///RECTAN
C00000=10.5,20.5,30.5,180,0,10
C00001=20.5,20.5,30.5,180,0,10
C00002=30.5,25.5,30.5,180,0,10
C00003=40.5,20.5,30.5,180,0,10
///TOOL 3
///POSTYPE BASE
C00004=50.5,20.5,30.5,180,0,10
///TOOL 2
///POSTYPE USER
P00001=60.5,20.5,30.5,180,0,10
P00002=1.5,2.5,3.5,0,0,0
//INST
NOP
SPEED V=50.5
MOVJ C00000 VJ=50.0
MOVL C00001
MOVL P00001 V=20.5 PL=0
SET D001 5
MOVC C00001 V=20.5
MOVC C00002
MOVC C00003 FPT
MOVL C00000 V=30.5 CR=2.5
IMOV P00002 V=10.5 UF#(1)
SPEED V=60.5
MOVL C00004
ADD P001 P002
MOVL C00001 V=70.5
END
""",
    "values.nc": """%
G21 G90 G17 G40 G94 G54
T1 M6
G0 X0 Y0 Z10
G1 Z1.5 F600
G61
G1 X10.5
G64
G91 G1 X5.5 Y2.5
G90
G1 X20.5 Y4.5
G2 X30.5 Y4.5 I5 J0
G18
G3 X40.5 Z1.5 R5
G17
G20
G1 X2 Y1 F20
G21
G55
G1 X60.5 F300
G43.4 H1
G1 X61.5 Y5.5 Z2.5 A10 C20
G49
G1 X62.5 Y6.5 A0 C0
G0 Z10
M30
""",
    "values.mpf": """N10 G71 G90 G17 G94 G54
N20 G0 X0 Y0 Z10
N30 TRANS X10 Y5
N40 G1 X1.5 Y2.5 Z1 F600
N50 TRANS
N60 G1 X12.5 Y2.5
N70 G91
N80 G1 X5.5
N90 G90
N100 TRAORI
N110 G1 X20.5 Y3.5 Z2.5 A3=0.1 B3=0 C3=0.9 F1200
N120 G1 X21.5 A3=0.2 B3=0 C3=0.9
N130 TRAFOOF
N140 G70
N150 G1 X1 Y1 Z0.5
N160 M30
""",
    "computed.mpf": """N10 G71 G90 G17 G94 G54
N20 DEF REAL WIDTH=2.5
N30 R1=10
N40 G0 X0 Y0 Z10
N50 G1 X=R1*2 Y=AC(3.5) F600
N60 G3 X30 Y13.5 CR=10
N70 TRANS X5 Y1.5
N80 X=WIDTH Y2.5
N90 ROT Z30
N100 X1.5 Y2.5
N110 ROT
N120 R2=0
N130 WHILE R2<2
N140 R2=R2+1
N150 X=R1+R2*5 Y2
N160 ENDWHILE
N170 IF R2==2 GOTOF FAR
N180 X99 Y9
N190 FAR: X31.5 Y4
N200 M30
""",
    "computed.ngc": """G21 G90 G17
#<wide>=4.5
#1=3
o10 sub
G1 X[#<_far>+#1] Y#2
o10 endsub
#<_far>=20.5
G0 X0 Y0 Z5
G1 X#<wide> Y[2*3.5] F600
o10 call [1.5] [2.5]
o20 while [#1 LT 5]
#1=[#1+1]
X[#1*2]
o20 endwhile
o30 if [#1 GT 4]
Y8
o30 else
Y9
o30 endif
X30 Y10
M2
""",
    "values.h": """0 BEGIN PGM VALUES MM
1 BLK FORM 0.1 Z X+0 Y+0 Z-20
2 TOOL CALL 3 Z S2000 F480
3 L X+0 Y+0 Z+10 R0 FMAX M3
4 L Z-1.5 F300
5 L X+10.5 F AUTO
6 CC X+10.5 Y+5
7 C X+10.5 Y+10 DR+
8 CR X+20.5 Y+10 R+8 DR-
9 LP PR+12 PA+30
10 L X+40 Y+0
11 RND R2.5
12 L Y+20
13 CYCL DEF 7.0 DATUM SHIFT
14 CYCL DEF 7.1 X+5
15 CYCL DEF 7.2 Y+6
16 CYCL DEF 10.0 ROTATION
17 CYCL DEF 10.1 ROT+30
18 L X+1 Y+2 F120
19 CYCL DEF 10.1 ROT+0
20 CYCL DEF 7.1 X+0
21 CYCL DEF 7.2 Y+0
22 CYCL DEF 247 DATUM SETTING ~
  Q339=+4 ;DATUM NUMBER
23 Q1 = 7
24 Q2 = Q1 * 2 + 3
25 L X+Q2 Y+1 Z+2
26 LBL 1
27 L IX+2
28 CALL LBL 1 REP 2
29 FN 9: IF +Q1 EQU +7 GOTO LBL 2
30 L X+99
31 LBL 2
32 PLANE SPATIAL SPA+0 SPB+30 SPC+0 TURN FMAX
33 L X+1 Y+2 Z+3 F240
34 PLANE RESET TURN FMAX
35 L X+3 Y+4 Z+5
36 M128
37 L X+4 A+10 C+20
38 LN X+5 Y+6 Z+7 NX+0 NY+0 NZ+1 TX+0.1 TY+0 TZ+0.9
39 M129
40 L A+0 C+0
41 L X+8 Y+9 Z+1
42 END PGM VALUES MM
""",
    "values.apt": """PARTNO VALUES
UNITS/MM
MULTAX/ON
LOADTL/1
RAPID
GOTO/0,0,50,0,0,1
FEDRAT/600,MMPM
GOTO/10.5,0,1.5,0,0,1
GODLTA/10,0,0
CIRCLE/20.5,5,1.5,0,0,1,5
GOTO/25.5,5,1.5
TRANS/0,0,10
GOTO/30.5,5,1.5,0,0,1
TRANS/0,0,0
FEDRAT/300,MMPM
GOTO/40.5,5,1.5,0,0.6,0.8
GODLTA/-5.5
RAPID
GOTO/40.5,5,50
FINI
""",
    "values.csv": """x_mm,y_mm,z_mm,a_deg,b_deg,c_deg,feed_mm_s,motion
0,0,10,0,0,180,,PTP
10.5,0,10,0,0,180,20,LIN
20.5,5,10,0,10,180,25,LIN
""",
}

VAL3 = """<?xml version="1.0" encoding="utf-8" ?>
<Programs xmlns="http://www.staubli.com/robotics/VAL3/Program/2">
  <Program name="values">
    <Locals>
      <Local name="l_nI" type="num" xsi:type="array" size="1" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"/>
    </Locals>
    <Code><![CDATA[
begin
  nStep=5.5
  pWork=pPath[0]
  pWork.trsf.x=120.5
  movel(pWork,tBelt[0],mGrind[0])
  pPath[1].trsf.y=pPath[1].trsf.y+nStep
  movel(pPath[1],tBelt[0],mGrind[0])
  mGrind[0].tvel=25
  fPart.trsf.z=150
  movel(pPath[0],tBelt[0],mGrind[0])
  for l_nI=0 to 2
    pWork=appro(pPath[l_nI],{0,0,-nStep,0,0,0})
    movel(pWork,tBelt[0],mGrind[0])
    nStep=nStep+1
  endFor
  if nStep>8
    movel(pPath[2],tBelt[0],mGrind[0])
  else
    movel(pPath[1],tBelt[0],mGrind[0])
  endIf
  movec(pPath[1],pPath[2],tBelt[0],mGrind[0])
  tBelt[0].trsf.z=110
  movel(pPath[0],tBelt[0],mGrind[0])
end
]]></Code>
  </Program>
</Programs>
"""
VAL3_DATA = """<?xml version="1.0" encoding="utf-8" ?>
<Database xmlns="http://www.staubli.com/robotics/VAL3/Data/2" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
  <Datas>
    <Data name="fPart" access="private" xsi:type="array" type="frame" size="1"><Value key="0" x="500" z="100" fatherId="world[0]"/></Data>
    <Data name="tBelt" access="private" xsi:type="array" type="tool" size="1"><Value key="0" z="100" fatherId="flange[0]"/></Data>
    <Data name="mGrind" access="private" xsi:type="array" type="mdesc" size="1"><Value key="0" tmax="50" rmax="100"/></Data>
    <Data name="nStep" access="private" xsi:type="array" type="num" size="1"/>
    <Data name="pWork" access="private" xsi:type="array" type="pointRx" size="1"><Value key="0" x="1" fatherId="fPart[0]"/></Data>
    <Data name="pPath" access="private" xsi:type="array" type="pointRx" size="3">
      <Value key="0" x="10" y="1" z="2" fatherId="fPart[0]"/>
      <Value key="1" x="20" y="3" z="4" rx="180" fatherId="fPart[0]"/>
      <Value key="2" x="30" y="1" z="2" rx="170" fatherId="fPart[0]"/>
    </Data>
  </Datas>
</Database>
"""
BESIDE = {"values.pgx": {"values.dtx": VAL3_DATA}}
PROGRAMS["values.pgx"] = VAL3
