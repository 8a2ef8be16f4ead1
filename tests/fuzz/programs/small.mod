%%%
  VERSION:1
  LANGUAGE:ENGLISH
%%%
MODULE Small
  RECORD row
    num feed;
    pos place;
  ENDRECORD
  PERS tooldata tBelt:=[TRUE,[[12.5,0,287.35],[0.707106781,0,0.707106781,0]],[4.2,[0,0,110],[1,0,0,0],0,0,0]];
  TASK PERS wobjdata wPart:=[FALSE,TRUE,"",[[1500,-250,420],[0.965925826,0,0,0.258819045]],[[0,0,0],[1,0,0,0]]];
  CONST speeddata vGrind:=[100.5,500,5000,1000];
  CONST zonedata zGrind:=[FALSE,1.5,1.5,1.5,0.2,1.5,0.2];
  CONST num nRows:=3;
  VAR num depth:=0.5;
  CONST robtarget pRow{3}:=[[[10.5,20.25,30.125],[1,0,0,0],[0,-1,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],
    [[11.5,21.25,31.125],[0.707106781,0,0.707106781,0],[0,-1,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],
    [[12.5,22.25,32.125],[0.866025404,0.5,0,0],[0,-1,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]];
  PROC main()
    VAR num i;
    ConfL\Off;
    MoveAbsJ [[0,0,0,0,30,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v1000,fine,tBelt;
    MoveJ pRow{1},v1000,z10,tBelt\WObj:=wPart;
    FOR i FROM 1 TO nRows DO
      MoveL Offs(pRow{i},0,0,-depth*2),vGrind,zGrind,tBelt\WObj:=wPart;
      depth:=depth+0.125;
    ENDFOR
    MoveC [[20.5,30.25,31.125],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],
      RelTool(pRow{3},5.5,0,-2.25\Rz:=15.5),v50,z1,tBelt\WObj:=wPart;
    IF depth>0.6 THEN
      back 12.75;
    ELSEIF DInput(di1)=1 THEN
      MoveL pRow{2},v20,fine,tBelt\WObj:=wPart;
    ENDIF
    MoveL RelTool(CRobT(\Tool:=tBelt\WObj:=wPart),0,0,-50.5),v200\T:=2.5,z5,tBelt\WObj:=wPart;
    SetDO doBelt,0;
  ENDPROC
  PROC back(num way)
    MoveL [[0.5,0,way],[1,0,0,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v100,fine,tBelt\WObj:=wPart;
  ENDPROC
ENDMODULE
