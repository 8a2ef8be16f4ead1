.PROGRAM small()
  BASE NULL
  TOOL TRANS(12.5, 0, 150.25, 0, 0, 0)
  SPEED 62.5 MM/S ALWAYS
  ACCURACY 1.5 ALWAYS
  JAPPRO start, 50
  LMOVE start
  step = 2.5
  FOR i = 1 TO 3
    LMOVE SHIFT(start BY step*i, 0, 0)
  END
  CALL lay(0.5)
  IF SIG(1) THEN
    LMOVE start
  ELSE
    DRAW 0, 1.25, 0
  END
  SPEED 20 MM/S
  C1MOVE start + TRANS(5, 5, 0, 0, 0, 0)
  C2MOVE start + TRANS(10, 0, 0, 0, 0, 0)
  LDEPART 50
.END
.PROGRAM lay(.by)
  POINT there = start + TRANS(0, 0, -.by, 0, 0, 0)
  LMOVE there
  TDRAW 0, 0, -2.5
.END
.TRANS
start 600.5 10.25 400.125 5 180 -5
.END
