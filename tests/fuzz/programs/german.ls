/PROG  GERMAN
/ATTR
EIGN.		= MNEDITOR;
PROG_GRÖßE	= 100;
ZEILEN	= 24;
DEFAULT_GROUP	= 1,*,*,*,*;
/MN
   1:  BENUTZER_NUM=3 ;
   2:  WKZ_NUM=2 ;
   3:  !Schleifen ;
   4:  i[1:Reihe]=1 ;
   5:J P[1] 50% CNT20 ACC80 ZEIT VOR   0.10sek,P-SPS    ;
   6:  LABEL[1] ;
   7:L P[2:Anfahrt] 100mm/sek CNT100     ;
   8:  i[1]=i[1]+1 ;
   9:  WENN i[1]<3,SPRUNG LABEL[1] ;
  10:C P[3]
    :  P[4] 75cm/min FINE     ;
  11:L P[4] 2.5sek FINE     ;
  12:  FOR i[2]=1 TO 4 ;
  13:L P[i[2]] 12.5mm/sek CNT50     ;
  14:  ENDFOR ;
  15:  WENN i[1]=3,SPRUNG LABEL[2] ;
  16:L P[1] max_Geschw. CNT0     ;
  17:  LABEL[2] ;
  18:  A[1:Spindel]=AUS ;
  19:  FB-PSPS (M[1] [&] !E[30]) ;
  20:  WARTE    .50(sek) ;
  21:L P[2] 50mm/sek CNT0 WKZ_Offset ,PR[3]     ;
  22:  WENN (E[4]=AUS),AUFRUF MAKRO7 ;
  23:L P[3] 9mm/sek CNT0     ;
  24:  ENDE ;
/POS
P[1]{
   GP1:
	UF : 3, UT : 2,		KONFIG : 'N U T, 0, 0, 0',
	X =  -895.783  mm,	Y =  -599.592  mm,	Z =  -254.972  mm,
	W =   -95.991 deg,	P =   -52.170 deg,	R =   -86.819 deg
};
P[2:"Anfahrt"]{
   GP1:
	UF : 3, UT : 2,		KONFIG : 'N U T, 0, 0, 0',
	X =  -835.928  mm,	Y =  -601.220  mm,	Z =  -258.813  mm,
	W =   -95.991 deg,	P =   -52.170 deg,	R =   -86.819 deg
};
P[3]{
   GP1:
	UF : 3, UT : 2,		KONFIG : 'N U T, 0, 0, 0',
	X =  -837.051  mm,	Y =  -581.008  mm,	Z =  -284.882  mm,
	W =   -96.039 deg,	P =   -52.518 deg,	R =   -86.759 deg
};
P[4]{
   GP1:
	UF : 3, UT : 2,		KONFIG : 'N U T, 0, 0, 0',
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
