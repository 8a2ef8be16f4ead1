/PROG  SMALL
/ATTR
OWNER		= MNEDITOR;
LINE_COUNT	= 16;
DEFAULT_GROUP	= 1,*,*,*,*;
/MN
   1:  UFRAME_NUM=3 ;
   2:  UTOOL_NUM=2 ;
   3:  !grinding ;
   4:  R[1:row]=1 ;
   5:J P[1] 50% CNT20    ;
   6:  LBL[1] ;
   7:L P[2:approach] 100mm/sec CNT100    ;
   8:  R[1]=R[1]+1 ;
   9:  IF R[1]<3,JMP LBL[1] ;
  10:C P[3]
    :  P[4] 75cm/min FINE    ;
  11:L P[4] 2.5sec FINE Offset,PR[1]    ;
  12:  FOR R[2]=1 TO 4 ;
  13:L P[R[2]] 12.5inch/min CNT50    ;
  14:  ENDFOR ;
  15:  DO[1:spindle]=OFF ;
  16:J P[5] 20% FINE    ;
/POS
P[1]{
   GP1:
	UF : 3, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =  -895.783  mm,	Y =  -599.592  mm,	Z =  -254.972  mm,
	W =   -95.991 deg,	P =   -52.170 deg,	R =   -86.819 deg
};
P[2:"approach"]{
   GP1:
	UF : 3, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =  -835.928  mm,	Y =  -601.220  mm,	Z =  -258.813  mm,
	W =   -95.991 deg,	P =   -52.170 deg,	R =   -86.819 deg
};
P[3]{
   GP1:
	UF : 3, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =  -837.051  mm,	Y =  -581.008  mm,	Z =  -284.882  mm,
	W =   -96.039 deg,	P =   -52.518 deg,	R =   -86.759 deg
};
P[4]{
   GP1:
	UF : 3, UT : 2,		CONFIG : 'N U T, 0, 0, 0',
	X =  -838.131  mm,	Y =  -562.314  mm,	Z =  -309.630  mm,
	W =   -96.090 deg,	P =   -52.888 deg,	R =   -86.694 deg
};
P[5]{
   GP1:
	UF : F, UT : F,
	J1=    10.500 deg,	J2=   -20.250 deg,	J3=    30.125 deg,
	J4=     0.000 deg,	J5=    45.000 deg,	J6=     0.000 deg
};
/END
