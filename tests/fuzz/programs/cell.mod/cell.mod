MODULE Cell
  CONST robtarget pOwn:=[[10.5,20.25,30.125],[1,0,0,0],[0,-1,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];
  LOCAL VAR num rows:=2;
  PROC main()
    MoveJ pOwn,v1000,z10,tShared\WObj:=wShared;
    MoveL pShared{1},vShared,zShared,tShared\WObj:=wShared;
    FOR i FROM 1 TO rows DO
      MoveL raised(pShared{i},i*2.5),vShared,fine,tShared\WObj:=wShared;
    ENDFOR
    stroke pOwn,12.75;
    leave;
    MoveL Offs(pOwn,step,0,0),v50,fine,tShared\WObj:=wShared;
  ENDPROC
ENDMODULE
