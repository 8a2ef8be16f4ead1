"""Instructions of ABB RAPID by what they mean for a path: nothing, or a changed variable."""


# They neither move the robot nor change data.
HARMLESS = frozenset(
    """
    setdo setgo setao set reset pulsedo invertdo settpl iodisable ioenable iobusstart
    waittime waitdi waitdo waituntil waitai waitao waitgi waitgo waitrob waitsynctask
    waitwobj dropwobj
    tpwrite tperase tpshow uishow errwrite errlog setdataval write writebin writestrbin
    writeanybin open close rewind
    confl confj accset worldacclim pathacclim pathresol singarea softact softdeact gripload
    mechunitload corrclear corrcon corrdiscon motionsup speedrefresh tunereset tuneservo
    clkstart clkstop clkreset connect idelete isignaldi isignaldo isignalai isignalgi itimer
    iwatch isleep idisable ienable ierror ivarvalue ipers
    triggio triggequip triggint triggspeed triggcheckio triggrampao
    stop break systemstopaction stopmove startmove startmoveretry storepath restopath clearpath
    actunit deactunit syncmoveon syncmoveoff syncmoveundo syncmovesuspend syncmoveresume
    load unload waitload startload checkprogref save erasemodule
    socketcreate socketconnect socketclose socketlisten socketbind socketsend
    eoffsoff eoffson eoffsset fcspdchgact fcspdchgdeact fccalib fcsuppdist fcloadid wzboxdef wzcyldef wzsphdef wzlimsup wzdoset wzenable wzdisable wzfree
    mocgenactivity trynext retry resetretrycount bookerrno
    """.lower().split()
)
# They fill the variables among their arguments at run time.
CHANGING = frozenset(
    """
    tpreadnum tpreadfk tpreaddnum uimsgbox readrawbytes readanybin socketreceive socketaccept
    unpackrawbytes packrawbytes getdataval readcfgdata getsysdata readblock
    readerrdata gettrapdata cammsg camgetresult camreqimage
    """.split()
)
