<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de_DE" sourcelanguage="en">
<context>
    <name>App::Property</name>
    <message>
        <source>full: as sampling, belt_machine and simulation say; coarse, for searching: samples 0.6 of contact_spacing_mm apart or farther, contact_tolerance 0.01 or looser; its figures are named coarse and are no verdict</source>
        <translation>full: wie sampling, belt_machine und simulation sagen; coarse, zum Suchen: Stützpunkte 0,6 von contact_spacing_mm oder weiter auseinander, contact_tolerance 0,01 oder gröber; die Zahlen heißen grob und sind kein Urteil</translation>
    </message>
    <message>
        <source>of the simulations from which feeds are planned; coarse: faster, and rougher (resolution.mode of a job); the figures told before and after are those of the full resolution</source>
        <translation>der Simulationen, aus denen Vorschübe geplant werden; coarse: schneller und gröber (resolution.mode eines Auftrags); die Zahlen vorher und nachher sind die der vollen Auflösung</translation>
    </message>
    <message>
        <source>full, or coarse: for searching, and no verdict</source>
        <translation>full, oder coarse: zum Suchen, und kein Urteil</translation>
    </message>
    <message>
        <source>5 % of the area lie below</source>
        <translation>5 % der Fläche liegen darunter</translation>
    </message>
    <message>
        <source>all figures of the comparison, as JSON</source>
        <translation>alle Zahlen des Vergleichs, als JSON</translation>
    </message>
    <message>
        <source>chord error on faces that are not ground</source>
        <translation>Sehnenfehler auf Flächen, die nicht geschliffen werden</translation>
    </message>
    <message>
        <source>left on the design: no stock was found there</source>
        <translation>auf dem Soll belassen: dort wurde kein Rohteil gefunden</translation>
    </message>
    <message>
        <source>made from another result; make it again</source>
        <translation>aus einem anderen Ergebnis erstellt; neu erstellen</translation>
    </message>
    <message>
        <source>measured less predicted height</source>
        <translation>gemessene weniger vorhergesagte Höhe</translation>
    </message>
    <message>
        <source>of the ground part; 0: the mesh is open</source>
        <translation>des geschliffenen Teils; 0: das Netz ist offen</translation>
    </message>
    <message>
        <source>of the same triangles on the design</source>
        <translation>derselben Dreiecke auf dem Soll</translation>
    </message>
    <message>
        <source>of the scan&apos;s height over the design</source>
        <translation>der Höhe des Scans über dem Soll</translation>
    </message>
    <message>
        <source>one colour per vertex</source>
        <translation>eine Farbe je Eckpunkt</translation>
    </message>
    <message>
        <source>root mean square of that</source>
        <translation>quadratisches Mittel davon</translation>
    </message>
    <message>
        <source>root mean square of the alignment</source>
        <translation>quadratisches Mittel der Ausrichtung</translation>
    </message>
    <message>
        <source>share of the area that the scan covers, percent</source>
        <translation>Anteil der Fläche, den der Scan abdeckt, Prozent</translation>
    </message>
    <message>
        <source>that the displacement turned over</source>
        <translation>die durch die Verschiebung umgeklappt sind</translation>
    </message>
    <message>
        <source>the result that is meshed</source>
        <translation>das Ergebnis, das vernetzt wird</translation>
    </message>
    <message>
        <source>the scan of the ground part that was compared</source>
        <translation>der verglichene Scan des geschliffenen Teils</translation>
    </message>
    <message>
        <source>what the user should know of the mesh</source>
        <translation>was der Benutzer über das Netz wissen sollte</translation>
    </message>
    <message>
        <source>which result it was made from</source>
        <translation>aus welchem Ergebnis es erstellt wurde</translation>
    </message>
    <message>
        <source>without gaps, as the design is</source>
        <translation>ohne Lücken, wie das Soll</translation>
    </message>
    <message>
        <source>95 % of the area are surer than that</source>
        <translation>95 % der Fläche sind sicherer als das</translation>
    </message>
    <message>
        <source>95 % of the area lie below</source>
        <translation>95 % der Fläche liegen darunter</translation>
    </message>
    <message>
        <source>A robot of your own: six revolute joints in series.</source>
        <translation>Ein eigener Roboter: sechs Drehgelenke in Reihe.</translation>
    </message>
    <message>
        <source>How sure the law is, as `beltgrind calibrate` writes it; empty: not known.</source>
        <translation>Wie sicher das Gesetz ist, wie es `beltgrind calibrate` schreibt; leer: nicht bekannt.</translation>
    </message>
    <message>
        <source>K = C_A K_A, mm2/N</source>
        <translation>K = C_A K_A, mm²/N</translation>
    </message>
    <message>
        <source>Poisson&apos;s ratio of the rim&apos;s rubber, up to 0.499</source>
        <translation>Querkontraktionszahl des Gummibelags, bis 0,499</translation>
    </message>
    <message>
        <source>W: the work of the pressing force at belt speed, J; or the removed volume, mm3</source>
        <translation>W: die Arbeit der Anpresskraft bei Bandgeschwindigkeit, J; oder das abgetragene Volumen, mm³</translation>
    </message>
    <message>
        <source>Young&apos;s modulus of the rim&apos;s rubber, MPa</source>
        <translation>Elastizitätsmodul des Gummibelags, MPa</translation>
    </message>
    <message>
        <source>a mesh&apos;s file (STL, PLY, OBJ) in place of an object</source>
        <translation>die Datei eines Netzes (STL, PLY, OBJ) statt eines Objekts</translation>
    </message>
    <message>
        <source>a pass ends at an edge where the normal turns by more, degrees</source>
        <translation>eine Bahn endet an einer Kante, an der sich die Normale um mehr dreht, Grad</translation>
    </message>
    <message>
        <source>a plane, or the line on the surface from Start to End</source>
        <translation>eine Ebene, oder die Linie auf der Oberfläche von Start bis End</translation>
    </message>
    <message>
        <source>a rim turned to a profile: points [y, drop] mm across the whole width, y ascending, the drop below radius_mm; straight lines between them; empty: none</source>
        <translation>ein auf Profil gedrehter Belag: Punkte [y, Tiefe] mm über die ganze Breite, y aufsteigend, die Tiefe unter radius_mm; dazwischen Geraden; leer: keiner</translation>
    </message>
    <message>
        <source>a robot by the id that `beltgrind presets robots` lists; empty: none, or the model</source>
        <translation>ein Roboter mit der Kennung, die `beltgrind presets robots` nennt; leer: keiner, oder das Modell</translation>
    </message>
    <message>
        <source>allowance: uniform; solid: another B-rep; mesh: a scan</source>
        <translation>allowance: gleichmäßig; solid: ein anderer Körper; mesh: ein Scan</translation>
    </message>
    <message>
        <source>an event where a joint turns further within a step of the simulation, degrees</source>
        <translation>ein Ereignis, wo ein Gelenk in einem Schritt der Simulation weiter dreht, Grad</translation>
    </message>
    <message>
        <source>an event where the robot is nearer to a singularity, degrees</source>
        <translation>ein Ereignis, wo der Roboter einer Singularität näher ist, Grad</translation>
    </message>
    <message>
        <source>an input has changed since; simulate again</source>
        <translation>eine Eingabe hat sich seither geändert; neu simulieren</translation>
    </message>
    <message>
        <source>an input of the simulation has changed since</source>
        <translation>eine Eingabe der Simulation hat sich seither geändert</translation>
    </message>
    <message>
        <source>angle of the belt&apos;s travel against the pass, about the contact&apos;s z, degrees; 0: along it, 90: the wheel&apos;s axis lies along the pass</source>
        <translation>Winkel des Bandlaufs gegen die Bahn, um z des Kontakts, Grad; 0: längs, 90: die Achse der Scheibe liegt längs der Bahn</translation>
    </message>
    <message>
        <source>belt speed V_b, m/s</source>
        <translation>Bandgeschwindigkeit V_b, m/s</translation>
    </message>
    <message>
        <source>bending stiffness of the belt on the rim, E t^3 / 12 (1 - nu^2), N mm (wheel_rim only)</source>
        <translation>Biegesteifigkeit des Bandes auf dem Belag, E t^3 / 12 (1 - nu^2), N mm (nur wheel_rim)</translation>
    </message>
    <message>
        <source>between neighbouring poses of a pass, degrees</source>
        <translation>zwischen benachbarten Posen einer Bahn, Grad</translation>
    </message>
    <message>
        <source>between neighbouring poses of a pass, mm</source>
        <translation>zwischen benachbarten Posen einer Bahn, mm</translation>
    </message>
    <message>
        <source>between the robot&apos;s way from pose to pose and the pass, mm</source>
        <translation>zwischen dem Weg des Roboters von Pose zu Pose und der Bahn, mm</translation>
    </message>
    <message>
        <source>by percentile: so much of the area lies between the ends, %</source>
        <translation>by percentile: so viel der Fläche liegt zwischen den Enden, %</translation>
    </message>
    <message>
        <source>by tolerance: the ramps end at so many times the wider limit</source>
        <translation>by tolerance: die Farbverläufe enden beim Sovielfachen der weiteren Grenze</translation>
    </message>
    <message>
        <source>cell of the wheel&apos;s contact grid, mm; never finer than 1.5 samples</source>
        <translation>Zelle im Kontaktraster der Scheibe, mm; nie feiner als 1,5 Abtastpunkte</translation>
    </message>
    <message>
        <source>chord error of the solid&apos;s triangles, mm</source>
        <translation>Sehnenfehler der Dreiecke des Körpers, mm</translation>
    </message>
    <message>
        <source>compliance of the wheel</source>
        <translation>Nachgiebigkeit der Scheibe</translation>
    </message>
    <message>
        <source>constant_feed: the programmed feed everywhere, sharp corners; trapezoidal: the robot speeds up and slows down, stands still at exact stops and rounds corners within their zones</source>
        <translation>constant_feed: überall der programmierte Vorschub, scharfe Ecken; trapezoidal: der Roboter beschleunigt und bremst, steht bei Genauhalt still und rundet Ecken in ihren Zonen</translation>
    </message>
    <message>
        <source>contact&apos;s width across the pass; 0: not asked for</source>
        <translation>Breite des Kontakts quer zur Bahn; 0: nicht gefragt</translation>
    </message>
    <message>
        <source>curve: [J or mm3, share of a fresh belt&apos;s cut]; points ascending in the first; empty: none</source>
        <translation>curve: [J oder mm³, Anteil des Abtrags eines frischen Bandes]; Punkte aufsteigend im ersten; leer: keine</translation>
    </message>
    <message>
        <source>density of the rim&apos;s rubber, kg/m3, about 1100 to 1200: under position control the rim grows by its rotation (docs/methods.md); 0: it does not</source>
        <translation>Dichte des Gummis, kg/m3, etwa 1100 bis 1200: unter Lageregelung weitet die Drehung den Belag auf (docs/methods.md); 0: nicht</translation>
    </message>
    <message>
        <source>depth removed, by length</source>
        <translation>abgetragene Tiefe, nach Länge</translation>
    </message>
    <message>
        <source>deviation at which the colour ramps end</source>
        <translation>Abweichung, bei der die Farbverläufe enden</translation>
    </message>
    <message>
        <source>deviation at which the colour ramps end, mm</source>
        <translation>Abweichung, bei der die Farbverläufe enden, mm</translation>
    </message>
    <message>
        <source>direction: the way of the passes, in the design&apos;s coordinates</source>
        <translation>direction: die Richtung der Bahnen, in den Koordinaten des Solls</translation>
    </message>
    <message>
        <source>distance of neighbouring passes on the surface, at most, mm; 0: step_over_share of the contact&apos;s width</source>
        <translation>Abstand benachbarter Bahnen auf der Oberfläche, höchstens, mm; 0: step_over_share der Kontaktbreite</translation>
    </message>
    <message>
        <source>distance of neighbouring passes, at most</source>
        <translation>Abstand benachbarter Bahnen, höchstens</translation>
    </message>
    <message>
        <source>draw the part&apos;s other faces in grey</source>
        <translation>die anderen Flächen des Teils grau zeichnen</translation>
    </message>
    <message>
        <source>elasticity of the wheel. wheel_rim: rubber rim of finite width on a rigid core; bonded_layer: the same without side faces; half_space: for contacts far smaller than the rim; elastic_foundation: independent springs (Winkler); surrogate: predicted by a regression trained on solved contacts (beltgrind surrogate); geometric: a rigid tool that cuts all it meets (control position)</source>
        <translation>Elastizität der Scheibe. wheel_rim: Gummibelag endlicher Breite auf starrem Kern; bonded_layer: dasselbe ohne Seitenflächen; half_space: für Kontakte viel kleiner als der Belag; elastic_foundation: unabhängige Federn (Winkler); surrogate: vorhergesagt durch eine Regression über gelöste Kontakte (beltgrind surrogate); geometric: ein starres Werkzeug, das alles abträgt, was es trifft (Regelung position)</translation>
    </message>
    <message>
        <source>feed of approach and retract, mm/s</source>
        <translation>Vorschub beim An- und Abfahren, mm/s</translation>
    </message>
    <message>
        <source>feed of the contact along the passes, mm/s; the program&apos;s feeds are those of the tool centre point that give it</source>
        <translation>Vorschub des Kontakts längs der Bahnen, mm/s; die Vorschübe des Programms sind die des TCP, die ihn ergeben</translation>
    </message>
    <message>
        <source>feed of the tool centre point, at most, mm/s: where the part turns fast under a slow contact</source>
        <translation>Vorschub des TCP, höchstens, mm/s: wo sich das Teil unter einem langsamen Kontakt schnell dreht</translation>
    </message>
    <message>
        <source>force: the robot presses with force_N; position: it keeps to the poses</source>
        <translation>force: der Roboter drückt mit force_N; position: er hält die Posen ein</translation>
    </message>
    <message>
        <source>gaps in a pass (holes) up to this length are crossed in contact, mm; over longer ones the robot retracts</source>
        <translation>Lücken in einer Bahn (Löcher) bis zu dieser Länge werden im Kontakt überquert, mm; über längeren hebt der Roboter ab</translation>
    </message>
    <message>
        <source>half of the area lies below</source>
        <translation>die halbe Fläche liegt darunter</translation>
    </message>
    <message>
        <source>hash of the inputs</source>
        <translation>Hash der Eingaben</translation>
    </message>
    <message>
        <source>hash of what the passes were laid from</source>
        <translation>Hash dessen, woraus die Bahnen gelegt wurden</translation>
    </message>
    <message>
        <source>height above the surface at which the robot goes from pass to pass, along the normal, mm</source>
        <translation>Höhe über der Oberfläche, in der der Roboter von Bahn zu Bahn geht, längs der Normalen, mm</translation>
    </message>
    <message>
        <source>how far above the design surface the contact is programmed, mm; for position control</source>
        <translation>wie weit über der Solloberfläche der Kontakt programmiert wird, mm; für Positionsregelung</translation>
    </message>
    <message>
        <source>how far below the design a height segment begins, mm</source>
        <translation>wie weit unter dem Soll ein Höhensegment beginnt, mm</translation>
    </message>
    <message>
        <source>how far inward, mm</source>
        <translation>wie weit nach innen, mm</translation>
    </message>
    <message>
        <source>how far outward from the design the stock is searched, mm</source>
        <translation>wie weit nach außen vom Soll das Rohteil gesucht wird, mm</translation>
    </message>
    <message>
        <source>how far passes go straight on beyond the border, mm; negative: they end so far before it</source>
        <translation>wie weit Bahnen über den Rand geradeaus weitergehen, mm; negativ: so weit davor enden sie</translation>
    </message>
    <message>
        <source>how far the contact moves in a step at most, mm</source>
        <translation>wie weit der Kontakt in einem Schritt höchstens wandert, mm</translation>
    </message>
    <message>
        <source>how far the force control moves the wheel from the programmed pose, along the pressing direction, both ways, mm</source>
        <translation>wie weit die Kraftregelung die Scheibe aus der programmierten Pose bewegt, längs der Anpressrichtung, nach beiden Seiten, mm</translation>
    </message>
    <message>
        <source>how far the wheel turns against the work in a step at most, degrees</source>
        <translation>wie weit sich die Scheibe in einem Schritt höchstens gegen das Werkstück dreht, Grad</translation>
    </message>
    <message>
        <source>how stiff the robot is along the pressing direction under position control, N/mm; 0: rigid</source>
        <translation>wie steif der Roboter längs der Anpressrichtung bei Positionsregelung ist, N/mm; 0: starr</translation>
    </message>
    <message>
        <source>how the wheel comes to the surface and leaves it. plunge: along the normal; arc: on a quarter of a circle, tangential at the surface</source>
        <translation>wie die Scheibe an die Oberfläche kommt und sie verlässt. plunge: längs der Normalen; arc: auf einem Viertelkreis, an der Oberfläche tangential</translation>
    </message>
    <message>
        <source>in contact, h</source>
        <translation>im Kontakt, h</translation>
    </message>
    <message>
        <source>k_t of the belt as it comes; law.wear lowers it further with use</source>
        <translation>k_t des Bandes, wie es kommt; law.wear senkt es mit dem Gebrauch weiter</translation>
    </message>
    <message>
        <source>language of the source</source>
        <translation>Sprache der Quelle</translation>
    </message>
    <message>
        <source>largest pressure times belt speed without a risk of burning, MPa m/s; 0: none</source>
        <translation>größter Druck mal Bandgeschwindigkeit ohne Gefahr von Schleifbrand, MPa m/s; 0: keine Grenze</translation>
    </message>
    <message>
        <source>law of removal</source>
        <translation>Abtragsgesetz</translation>
    </message>
    <message>
        <source>length of all passes</source>
        <translation>Länge aller Bahnen</translation>
    </message>
    <message>
        <source>length of pass over which the normal is averaged, mm: turns at edges between faces are spread over it; 0: the surface&apos;s own</source>
        <translation>Bahnlänge, über die die Normale gemittelt wird, mm: Drehungen an Kanten zwischen Flächen werden darauf verteilt; 0: die der Oberfläche selbst</translation>
    </message>
    <message>
        <source>length of the plunge or radius of the arc, mm</source>
        <translation>Länge des Eintauchens oder Radius des Bogens, mm</translation>
    </message>
    <message>
        <source>length of the way of the tool centre point</source>
        <translation>Länge des Wegs des TCP</translation>
    </message>
    <message>
        <source>lines of the source</source>
        <translation>Zeilen der Quelle</translation>
    </message>
    <message>
        <source>lines: the passes are those lines or cuts themselves, the step-over kept where neighbours are farthest apart; even: only the middle pass is, the others keep an equal distance on the surface</source>
        <translation>lines: die Bahnen sind jene Linien oder Schnitte selbst, der Bahnabstand gilt, wo Nachbarn am weitesten auseinander liegen; even: nur die mittlere Bahn ist es, die anderen halten auf der Oberfläche gleichen Abstand</translation>
    </message>
    <message>
        <source>local: alpha, exponent of the pressure</source>
        <translation>local: alpha, Exponent des Drucks</translation>
    </message>
    <message>
        <source>local: below it nothing is cut, MPa</source>
        <translation>local: darunter wird nichts abgetragen, MPa</translation>
    </message>
    <message>
        <source>local: belt speed at which beta has no effect, m/s</source>
        <translation>local: Bandgeschwindigkeit, bei der beta nicht wirkt, m/s</translation>
    </message>
    <message>
        <source>local: beta, exponent of the belt speed</source>
        <translation>local: beta, Exponent der Bandgeschwindigkeit</translation>
    </message>
    <message>
        <source>local: cutting pressure that is approached however hard the wheel presses, MPa; 0: none</source>
        <translation>local: abtragender Druck, der nie überschritten wird, so fest die Scheibe auch drückt, MPa; 0: keiner</translation>
    </message>
    <message>
        <source>local: feed at which gamma has no effect, mm/s</source>
        <translation>local: Vorschub, bei dem gamma nicht wirkt, mm/s</translation>
    </message>
    <message>
        <source>local: gamma, exponent of the feed, beyond the time that it leaves</source>
        <translation>local: gamma, Exponent des Vorschubs, über die Zeit hinaus, die er lässt</translation>
    </message>
    <message>
        <source>local: measured cut as a share of a plain wheel&apos;s, [land share, share], a further factor; points ascending in the first; empty: none</source>
        <translation>local: gemessener Abtrag als Anteil dessen einer glatten Scheibe, [Stegeanteil, Anteil], ein weiterer Faktor; Punkte aufsteigend im ersten; leer: keine</translation>
    </message>
    <message>
        <source>local: measured cut as a share of that at the reference feed, [mm/s, share], in place of the exponent; points ascending in the first; empty: none</source>
        <translation>local: gemessener Abtrag als Anteil dessen beim Bezugsvorschub, [mm/s, Anteil], statt des Exponenten; Punkte aufsteigend im ersten; leer: keine</translation>
    </message>
    <message>
        <source>local: measured cut as a share of that at the reference pressure, [MPa, share], in place of the exponent; points ascending in the first; empty: none</source>
        <translation>local: gemessener Abtrag als Anteil dessen beim Bezugsdruck, [MPa, Anteil], statt des Exponenten; Punkte aufsteigend im ersten; leer: keine</translation>
    </message>
    <message>
        <source>local: measured cut as a share of that at the reference speed, [m/s, share], in place of the exponent; points ascending in the first; empty: none</source>
        <translation>local: gemessener Abtrag als Anteil dessen bei der Bezugsgeschwindigkeit, [m/s, Anteil], statt des Exponenten; Punkte aufsteigend im ersten; leer: keine</translation>
    </message>
    <message>
        <source>local: pressure at which alpha has no effect, MPa</source>
        <translation>local: Druck, bei dem alpha nicht wirkt, MPa</translation>
    </message>
    <message>
        <source>local: share of a serrated wheel&apos;s surface that bears: lands over lands and grooves; 1: a plain wheel</source>
        <translation>local: tragender Anteil der Oberfläche einer genuteten Scheibe: Stege durch Stege und Nuten; 1: glatte Scheibe</translation>
    </message>
    <message>
        <source>local_linear: dh/dt = K k_t V_b p; local: the same with exponents, threshold, saturation and curves; hammann: the linear law for the mean pressure over the contact; geometric: a rigid tool cuts all that its envelope meets (control position)</source>
        <translation>local_linear: dh/dt = K k_t V_b p; local: dasselbe mit Exponenten, Schwelle, Sättigung und Kurven; hammann: das lineare Gesetz für den mittleren Druck im Kontakt; geometric: ein starres Werkzeug trägt alles ab, was seine Hülle trifft (Regelung position)</translation>
    </message>
    <message>
        <source>lower and upper limit of the deviation, mm</source>
        <translation>untere und obere Grenze der Abweichung, mm</translation>
    </message>
    <message>
        <source>lower limit; set it at the job</source>
        <translation>untere Grenze; am Auftrag einstellen</translation>
    </message>
    <message>
        <source>mean probability, percent; 0: not known</source>
        <translation>mittlere Wahrscheinlichkeit, Prozent; 0: nicht bekannt</translation>
    </message>
    <message>
        <source>mean standard deviation of the deviation</source>
        <translation>mittlere Standardabweichung der Abweichung</translation>
    </message>
    <message>
        <source>mm around each pose in which the corner is rounded; negative: not known</source>
        <translation>mm um jede Pose, in denen die Ecke gerundet wird; negativ: nicht bekannt</translation>
    </message>
    <message>
        <source>number of Cartesian poses</source>
        <translation>Zahl der kartesischen Posen</translation>
    </message>
    <message>
        <source>number of passes</source>
        <translation>Zahl der Bahnen</translation>
    </message>
    <message>
        <source>of the belt in the end, percent of a fresh one</source>
        <translation>des Bandes am Ende, Prozent eines frischen</translation>
    </message>
    <message>
        <source>of the deviation along the section</source>
        <translation>der Abweichung längs des Schnitts</translation>
    </message>
    <message>
        <source>of the deviation, by length</source>
        <translation>der Abweichung, nach Länge</translation>
    </message>
    <message>
        <source>of the deviation; negative: below the design</source>
        <translation>der Abweichung; negativ: unter dem Soll</translation>
    </message>
    <message>
        <source>of the deviation; positive: stock left</source>
        <translation>der Abweichung; positiv: es steht noch Aufmaß</translation>
    </message>
    <message>
        <source>of the faces</source>
        <translation>der Flächen</translation>
    </message>
    <message>
        <source>of the height field</source>
        <translation>des Höhenfelds</translation>
    </message>
    <message>
        <source>of the plane</source>
        <translation>der Ebene</translation>
    </message>
    <message>
        <source>of the section, without gaps</source>
        <translation>des Schnitts, ohne Lücken</translation>
    </message>
    <message>
        <source>of the simulation</source>
        <translation>der Simulation</translation>
    </message>
    <message>
        <source>on the design before</source>
        <translation>zuvor auf dem Soll</translation>
    </message>
    <message>
        <source>one colour per sample</source>
        <translation>eine Farbe je Abtastpunkt</translation>
    </message>
    <message>
        <source>one feed for all poses; 0: as programmed</source>
        <translation>ein Vorschub für alle Posen; 0: wie programmiert</translation>
    </message>
    <message>
        <source>one force for all poses; 0: as programmed</source>
        <translation>eine Kraft für alle Posen; 0: wie programmiert</translation>
    </message>
    <message>
        <source>outer radius at mid-width, belt included, mm</source>
        <translation>Außenradius in der Mitte der Breite, mit Band, mm</translation>
    </message>
    <message>
        <source>part in hand: the contact frame in the base frame</source>
        <translation>Teil in der Hand: das Kontaktsystem im Basissystem</translation>
    </message>
    <message>
        <source>part in hand: the document&apos;s origin in the tool frame</source>
        <translation>Teil in der Hand: der Ursprung des Dokuments im Werkzeugsystem</translation>
    </message>
    <message>
        <source>points of each piece of it</source>
        <translation>Punkte jedes Stücks davon</translation>
    </message>
    <message>
        <source>positioning moves: nothing is ground on the way to these poses</source>
        <translation>Zustellbewegungen: auf dem Weg zu diesen Posen wird nichts geschliffen</translation>
    </message>
    <message>
        <source>pressing force along the passes, N; 0: the belt machine&apos;s</source>
        <translation>Anpresskraft längs der Bahnen, N; 0: die der Bandschleifmaschine</translation>
    </message>
    <message>
        <source>pressing force towards each pose, N; negative: the belt machine&apos;s</source>
        <translation>Anpresskraft hin zu jeder Pose, N; negativ: die der Bandschleifmaschine</translation>
    </message>
    <message>
        <source>pressing force where the program has none, N</source>
        <translation>Anpresskraft, wo das Programm keine hat, N</translation>
    </message>
    <message>
        <source>pressure per indentation of the elastic foundation, MPa/mm; 0: as stiff as the wheel_rim is on a plane under force_N</source>
        <translation>Druck je Eindrückung der elastischen Bettung, MPa/mm; 0: so steif wie wheel_rim auf einer Ebene unter force_N</translation>
    </message>
    <message>
        <source>radius of the rim&apos;s profile across the width, mm; 0: cylinder</source>
        <translation>Radius des Profils über die Breite, mm; 0: Zylinder</translation>
    </message>
    <message>
        <source>relative error of the pressure field</source>
        <translation>relativer Fehler des Druckfelds</translation>
    </message>
    <message>
        <source>removed by grinding</source>
        <translation>durch Schleifen abgetragen</translation>
    </message>
    <message>
        <source>removed volume, mm3</source>
        <translation>abgetragenes Volumen, mm³</translation>
    </message>
    <message>
        <source>results whose use has been counted</source>
        <translation>Ergebnisse, deren Gebrauch gezählt ist</translation>
    </message>
    <message>
        <source>samples over which no stock was found</source>
        <translation>Abtastpunkte, über denen kein Rohteil gefunden wurde</translation>
    </message>
    <message>
        <source>samples where the stock lies below the design</source>
        <translation>Abtastpunkte, wo das Rohteil unter dem Soll liegt</translation>
    </message>
    <message>
        <source>share of a fresh belt&apos;s cut, percent</source>
        <translation>Anteil des Abtrags eines frischen Bandes, Prozent</translation>
    </message>
    <message>
        <source>share of the area cut too deep, percent</source>
        <translation>Anteil der Fläche, die zu tief geschliffen ist, Prozent</translation>
    </message>
    <message>
        <source>share of the area in tolerance, percent</source>
        <translation>Anteil der Fläche in Toleranz, Prozent</translation>
    </message>
    <message>
        <source>share of the area with too much left, percent</source>
        <translation>Anteil der Fläche, auf der zu viel steht, Prozent</translation>
    </message>
    <message>
        <source>share of the cut that stays</source>
        <translation>Anteil des Abtrags, der bleibt</translation>
    </message>
    <message>
        <source>share of the length in tolerance, percent</source>
        <translation>Anteil der Länge in Toleranz, Prozent</translation>
    </message>
    <message>
        <source>shorter pieces of passes are left out, mm</source>
        <translation>kürzere Stücke von Bahnen werden weggelassen, mm</translation>
    </message>
    <message>
        <source>six joint angles in whose configuration every program begins, degrees; empty: the one that gets furthest</source>
        <translation>sechs Gelenkwinkel, in deren Stellung jedes Programm beginnt, Grad; leer: die, die am weitesten kommt</translation>
    </message>
    <message>
        <source>spacing of the samples that the passes are found on, mm; 0: by the faces&apos; size and the step-over</source>
        <translation>Abstand der Abtastpunkte, auf denen die Bahnen gefunden werden, mm; 0: nach der Größe der Flächen und dem Bahnabstand</translation>
    </message>
    <message>
        <source>speed towards each pose, mm/s</source>
        <translation>Geschwindigkeit hin zu jeder Pose, mm/s</translation>
    </message>
    <message>
        <source>standard deviation at which its ramp ends</source>
        <translation>Standardabweichung, bei der ihr Farbverlauf endet</translation>
    </message>
    <message>
        <source>step-over as a share of the contact&apos;s width across the pass</source>
        <translation>Bahnabstand als Anteil der Kontaktbreite quer zur Bahn</translation>
    </message>
    <message>
        <source>steps of each ramp; 0: without steps</source>
        <translation>Stufen jedes Farbverlaufs; 0: ohne Stufen</translation>
    </message>
    <message>
        <source>tension of the belt on the rim, per width, N/mm (wheel_rim only)</source>
        <translation>Spannung des Bandes auf dem Belag, je Breite, N/mm (nur wheel_rim)</translation>
    </message>
    <message>
        <source>the CAM path or robot trajectory of FreeCAD that the poses follow, in place of a file</source>
        <translation>der CAM-Pfad oder die Roboterbahn von FreeCAD, denen die Posen folgen, statt einer Datei</translation>
    </message>
    <message>
        <source>the Part or Mesh object that is the stock</source>
        <translation>das Part- oder Mesh-Objekt, das das Rohteil ist</translation>
    </message>
    <message>
        <source>the belt machine, for the cell&apos;s frames</source>
        <translation>die Bandschleifmaschine, für die Systeme der Zelle</translation>
    </message>
    <message>
        <source>the belt, none: a fresh one</source>
        <translation>das Band; keines: ein frisches</translation>
    </message>
    <message>
        <source>the events as JSON</source>
        <translation>die Ereignisse als JSON</translation>
    </message>
    <message>
        <source>the faces to be ground</source>
        <translation>die Flächen, die geschliffen werden</translation>
    </message>
    <message>
        <source>the faces with the passes</source>
        <translation>die Flächen mit den Bahnen</translation>
    </message>
    <message>
        <source>the ground height field</source>
        <translation>das geschliffene Höhenfeld</translation>
    </message>
    <message>
        <source>the ground profile in space</source>
        <translation>das geschliffene Profil im Raum</translation>
    </message>
    <message>
        <source>the result shown</source>
        <translation>das gezeigte Ergebnis</translation>
    </message>
    <message>
        <source>the result that is cut</source>
        <translation>das Ergebnis, das geschnitten wird</translation>
    </message>
    <message>
        <source>the robot program that the poses come from</source>
        <translation>das Roboterprogramm, aus dem die Posen kommen</translation>
    </message>
    <message>
        <source>the robot&apos;s own base in the base frame of the programs</source>
        <translation>der eigene Fuß des Roboters im Basissystem der Programme</translation>
    </message>
    <message>
        <source>the tool frame of the programs in the robot&apos;s flange</source>
        <translation>das Werkzeugsystem der Programme im Flansch des Roboters</translation>
    </message>
    <message>
        <source>thickness of the rim on its rigid core, mm</source>
        <translation>Dicke des Belags auf seinem starren Kern, mm</translation>
    </message>
    <message>
        <source>time at the programmed feeds without acceleration, s; the job&apos;s own: Simulation.ProcessTime</source>
        <translation>Zeit bei den programmierten Vorschüben ohne Beschleunigung, s; die des Auftrags: Simulation.ProcessTime</translation>
    </message>
    <message>
        <source>time constant with which the regulator&apos;s force follows the commanded one, s; 0: at once</source>
        <translation>Zeitkonstante, mit der die Kraft des Reglers der befohlenen folgt, s; 0: sofort</translation>
    </message>
    <message>
        <source>times which the rubber is stiffer under the quick contact than the modulus says, which is measured slowly (docs/methods.md)</source>
        <translation>um welchen Faktor der Gummi unter dem schnellen Kontakt steifer ist, als der langsam gemessene Modul sagt (docs/methods.md)</translation>
    </message>
    <message>
        <source>tool centre points in the program&apos;s base frame, mm</source>
        <translation>TCPs im Basissystem des Programms, mm</translation>
    </message>
    <message>
        <source>tool in hand: the contact frame in the tool frame</source>
        <translation>Werkzeug in der Hand: das Kontaktsystem im Werkzeugsystem</translation>
    </message>
    <message>
        <source>tool in hand: the document&apos;s origin in the base frame</source>
        <translation>Werkzeug in der Hand: der Ursprung des Dokuments im Basissystem</translation>
    </message>
    <message>
        <source>trapezoidal: acceleration of reorientation, degrees/s2</source>
        <translation>trapezoidal: Beschleunigung der Umorientierung, Grad/s²</translation>
    </message>
    <message>
        <source>trapezoidal: acceleration of the tool centre point along the path, and across it in corners, mm/s2; the default is URScript&apos;s for movel, large robots reach 1000 to 5000</source>
        <translation>trapezoidal: Beschleunigung des TCP längs der Bahn, in Ecken auch quer, mm/s²; die Vorgabe ist die von movel in URScript, große Roboter erreichen 1000 bis 5000</translation>
    </message>
    <message>
        <source>trapezoidal: largest speed of reorientation, degrees/s; the default is KUKA&apos;s $VEL.ORI1</source>
        <translation>trapezoidal: größte Geschwindigkeit der Umorientierung, Grad/s; die Vorgabe ist $VEL.ORI1 von KUKA</translation>
    </message>
    <message>
        <source>trapezoidal: zone of poses whose program does not tell it, mm; 0: exact stop</source>
        <translation>trapezoidal: Überschleifzone von Posen, deren Programm keine nennt, mm; 0: Genauhalt</translation>
    </message>
    <message>
        <source>two_stage: J or mm3 in which it falls to 1/e</source>
        <translation>two_stage: J oder mm³, in denen er auf 1/e fällt</translation>
    </message>
    <message>
        <source>two_stage: share that goes at first</source>
        <translation>two_stage: Anteil, der zuerst vergeht</translation>
    </message>
    <message>
        <source>uniform stock on the design, mm</source>
        <translation>gleichmäßiges Aufmaß auf dem Soll, mm</translation>
    </message>
    <message>
        <source>uninterrupted lines on one face</source>
        <translation>ununterbrochene Linien auf einer Fläche</translation>
    </message>
    <message>
        <source>upper limit; set it at the job</source>
        <translation>obere Grenze; am Auftrag einstellen</translation>
    </message>
    <message>
        <source>version of the properties</source>
        <translation>Version der Eigenschaften</translation>
    </message>
    <message>
        <source>weighted by area</source>
        <translation>nach Fläche gewichtet</translation>
    </message>
    <message>
        <source>what `beltgrind surrogate` wrote, for the model surrogate</source>
        <translation>was `beltgrind surrogate` schrieb, für das Modell surrogate</translation>
    </message>
    <message>
        <source>what changed in every step, for playback</source>
        <translation>was sich in jedem Schritt änderte, für die Wiedergabe</translation>
    </message>
    <message>
        <source>what could not be resolved, by file and line</source>
        <translation>was nicht aufgelöst werden konnte, nach Datei und Zeile</translation>
    </message>
    <message>
        <source>what goes with the part (clamps), in the document&apos;s coordinates</source>
        <translation>was mit dem Teil geht (Spannmittel), in den Koordinaten des Dokuments</translation>
    </message>
    <message>
        <source>what goes with the wheel (housing), in the contact frame</source>
        <translation>was mit der Scheibe geht (Gehäuse), im Kontaktsystem</translation>
    </message>
    <message>
        <source>what happened on the way</source>
        <translation>was unterwegs geschah</translation>
    </message>
    <message>
        <source>what stands still in the cell, in the base frame</source>
        <translation>was in der Zelle still steht, im Basissystem</translation>
    </message>
    <message>
        <source>what the belt did, as JSON</source>
        <translation>was das Band tat, als JSON</translation>
    </message>
    <message>
        <source>what the robot carries (gripper, tool), in the tool frame</source>
        <translation>was der Roboter trägt (Greifer, Werkzeug), im Werkzeugsystem</translation>
    </message>
    <message>
        <source>what the robot takes, s</source>
        <translation>was der Roboter braucht, s</translation>
    </message>
    <message>
        <source>what the simulation took, s</source>
        <translation>was die Simulation brauchte, s</translation>
    </message>
    <message>
        <source>what the user should know of the input</source>
        <translation>was man von der Eingabe wissen sollte</translation>
    </message>
    <message>
        <source>what the user should know of the passes</source>
        <translation>was man von den Bahnen wissen sollte</translation>
    </message>
    <message>
        <source>what was cut, and how</source>
        <translation>was geschnitten wurde, und wie</translation>
    </message>
    <message>
        <source>where the file&apos;s mesh lies in the document</source>
        <translation>wo das Netz der Datei im Dokument liegt</translation>
    </message>
    <message>
        <source>where the line begins</source>
        <translation>wo die Linie beginnt</translation>
    </message>
    <message>
        <source>where the line ends</source>
        <translation>wo die Linie endet</translation>
    </message>
    <message>
        <source>where the ramps end</source>
        <translation>wo die Farbverläufe enden</translation>
    </message>
    <message>
        <source>which result the colours show</source>
        <translation>welches Ergebnis die Farben zeigen</translation>
    </message>
    <message>
        <source>who holds what</source>
        <translation>wer was hält</translation>
    </message>
    <message>
        <source>why there is no section; else empty</source>
        <translation>warum es keinen Schnitt gibt; sonst leer</translation>
    </message>
    <message>
        <source>width, mm</source>
        <translation>Breite, mm</translation>
    </message>
    <message>
        <source>work of the pressing force at belt speed, J</source>
        <translation>Arbeit der Anpresskraft bei Bandgeschwindigkeit, J</translation>
    </message>
    <message>
        <source>contacts whose pressure did not settle</source>
        <translation>Kontakte, deren Druck nicht konvergierte</translation>
    </message>
    <message>
        <source>convergence.json</source>
        <translation>convergence.json</translation>
    </message>
    <message>
        <source>events outside of the law&apos;s range</source>
        <translation>Ereignisse außerhalb des Bereichs des Gesetzes</translation>
    </message>
    <message>
        <source>how far a depth may be off because of the settings; 0: not checked</source>
        <translation>wie weit eine Tiefe wegen der Einstellungen falsch sein kann; 0: nicht geprüft</translation>
    </message>
    <message>
        <source>how many events there are</source>
        <translation>wie viele Ereignisse es gibt</translation>
    </message>
    <message>
        <source>how many warnings of the input there are</source>
        <translation>wie viele Warnungen zu den Eingaben es gibt</translation>
    </message>
    <message>
        <source>summary.json</source>
        <translation>summary.json</translation>
    </message>
    <message>
        <source>the job whose figures these are</source>
        <translation>der Job, dessen Werte das sind</translation>
    </message>
    <message>
        <source>the time series as JSON</source>
        <translation>die Zeitverläufe als JSON</translation>
    </message>
    <message>
        <source>whether the job&apos;s settings are: yes, no, not checked</source>
        <translation>ob es die Einstellungen des Jobs sind: yes (ja), no (nein), not checked (nicht geprüft)</translation>
    </message>
    <message>
        <source>whether the law of removal was calibrated</source>
        <translation>ob das Abtragsgesetz kalibriert wurde</translation>
    </message>
    <message>
        <source>a line for every face</source>
        <translation>eine Zeile für jede Fläche</translation>
    </message>
    <message>
        <source>a line for every zone</source>
        <translation>eine Zeile für jede Zone</translation>
    </message>
    <message>
        <source>all of it as JSON</source>
        <translation>alles als JSON</translation>
    </message>
    <message>
        <source>area of the largest connected place out of tolerance</source>
        <translation>Fläche der größten zusammenhängenden Stelle außer Toleranz</translation>
    </message>
    <message>
        <source>connected areas cut too deep</source>
        <translation>zusammenhängende Stellen, die zu tief geschliffen sind</translation>
    </message>
    <message>
        <source>connected areas with too much left</source>
        <translation>zusammenhängende Stellen, an denen zu viel steht</translation>
    </message>
    <message>
        <source>contact point at the end of every motion</source>
        <translation>Kontaktpunkt am Ende jeder Bewegung</translation>
    </message>
    <message>
        <source>contacts that did not converge</source>
        <translation>Kontakte, die nicht konvergierten</translation>
    </message>
    <message>
        <source>deviation farthest beyond its limit, or next to it</source>
        <translation>Abweichung am weitesten jenseits ihrer Grenze oder am nächsten daran</translation>
    </message>
    <message>
        <source>events outside of what was measured</source>
        <translation>Ereignisse außerhalb des Gemessenen</translation>
    </message>
    <message>
        <source>faces that fail</source>
        <translation>Flächen, die nicht bestehen</translation>
    </message>
    <message>
        <source>how far; negative: what is left to the limit</source>
        <translation>wie weit; negativ: was bis zur Grenze bleibt</translation>
    </message>
    <message>
        <source>largest Wt of a face across the feed; 0: none</source>
        <translation>größtes Wt einer Fläche quer zum Vorschub; 0: keines</translation>
    </message>
    <message>
        <source>largest Wt of a face along the feed; 0: none</source>
        <translation>größtes Wt einer Fläche längs des Vorschubs; 0: keines</translation>
    </message>
    <message>
        <source>left above the design</source>
        <translation>übrig über dem Entwurf</translation>
    </message>
    <message>
        <source>missing below the design</source>
        <translation>fehlt unter dem Entwurf</translation>
    </message>
    <message>
        <source>names of the programs</source>
        <translation>Namen der Programme</translation>
    </message>
    <message>
        <source>parts of the surface with tolerances of their own; later ones override earlier ones</source>
        <translation>Teile der Oberfläche mit eigenen Toleranzen; spätere gelten vor früheren</translation>
    </message>
    <message>
        <source>pass, fail or unknown</source>
        <translation>pass (bestanden), fail (nicht bestanden) oder unknown (unbekannt)</translation>
    </message>
    <message>
        <source>places of the programs not resolved</source>
        <translation>Stellen der Programme nicht aufgelöst</translation>
    </message>
    <message>
        <source>places of the programs that were not resolved; -1: not known</source>
        <translation>Stellen der Programme, die nicht aufgelöst wurden; -1: nicht bekannt</translation>
    </message>
    <message>
        <source>pose that every motion leads to, from 0</source>
        <translation>Pose, zu der jede Bewegung führt, ab 0</translation>
    </message>
    <message>
        <source>program of every motion, from 0</source>
        <translation>Programm jeder Bewegung, ab 0</translation>
    </message>
    <message>
        <source>samples where no stock was found</source>
        <translation>Punkte, an denen kein Rohteil gefunden wurde</translation>
    </message>
    <message>
        <source>share cut too deep, percent</source>
        <translation>Anteil, der zu tief geschliffen ist, Prozent</translation>
    </message>
    <message>
        <source>share of the inspected area, percent</source>
        <translation>Anteil der geprüften Fläche, Prozent</translation>
    </message>
    <message>
        <source>share with too much left, percent</source>
        <translation>Anteil, an dem zu viel steht, Prozent</translation>
    </message>
    <message>
        <source>source line of every motion; 0: not known</source>
        <translation>Quellzeile jeder Bewegung; 0: nicht bekannt</translation>
    </message>
    <message>
        <source>stock below the design from the start</source>
        <translation>Rohteil von Anfang an unter dem Entwurf</translation>
    </message>
    <message>
        <source>the result judged</source>
        <translation>das beurteilte Ergebnis</translation>
    </message>
    <message>
        <source>the verdict of the run and its limits, JSON</source>
        <translation>das Urteil des Laufs und seine Grenzen, JSON</translation>
    </message>
    <message>
        <source>what could not be judged, and why</source>
        <translation>was nicht beurteilt werden konnte, und warum</translation>
    </message>
    <message>
        <source>what was judged, and how</source>
        <translation>was beurteilt wurde, und wie</translation>
    </message>
    <message>
        <source>where that is</source>
        <translation>wo das ist</translation>
    </message>
    <message>
        <source>where the wheel never was</source>
        <translation>wo die Scheibe nie war</translation>
    </message>
    <message>
        <source>zones that fail</source>
        <translation>Zonen, die nicht bestehen</translation>
    </message>
    <message>
        <source>an event where neighbouring poses of a feed motion are turned further against each other, degrees; 0: none</source>
        <translation>ein Ereignis, wo benachbarte Posen einer Vorschubbewegung weiter gegeneinander gedreht sind, Grad; 0: keines</translation>
    </message>
    <message>
        <source>an event where the contact is lost and found again within this time, s; 0: none</source>
        <translation>ein Ereignis, wo der Kontakt verloren und innerhalb dieser Zeit wiedergefunden wird, s; 0: keines</translation>
    </message>
    <message>
        <source>an event where the force exceeds the commanded one by more than this share of it; 0: none</source>
        <translation>ein Ereignis, wo die Kraft die befohlene um mehr als diesen Anteil übertrifft; 0: keines</translation>
    </message>
    <message>
        <source>an event where the wheel touches further round its rim from the programmed contact point, degrees; 0: none</source>
        <translation>ein Ereignis, wo die Scheibe am Umfang weiter weg vom programmierten Kontaktpunkt berührt, Grad; 0: keines</translation>
    </message>
    <message>
        <source>an event where two bodies that move against each other come nearer, mm</source>
        <translation>ein Ereignis, wo zwei gegeneinander bewegte Körper sich näher kommen, mm</translation>
    </message>
    <message>
        <source>how far below the belt&apos;s surface the wheel begins that must not touch the part, mm; what lies nearer to the surface may, as it grinds</source>
        <translation>wie tief unter der Bandoberfläche die Scheibe beginnt, die das Teil nicht berühren darf, mm; was näher an der Oberfläche liegt, darf es, denn es schleift</translation>
    </message>
    <message>
        <source>largest pressure, beyond which is an event, MPa; 0: none</source>
        <translation>größter Druck, darüber ein Ereignis, MPa; 0: keiner</translation>
    </message>
    <message>
        <source>whether wheel, part and bodies are followed for collisions</source>
        <translation>ob Scheibe, Teil und Körper auf Kollisionen verfolgt werden</translation>
    </message>
    <message>
        <source>the same as JSON, for other languages</source>
        <translation>dasselbe als JSON, für andere Sprachen</translation>
    </message>
    <message>
        <source>SHA-256 of the files of the result, as JSON</source>
        <translation>SHA-256 der Dateien des Ergebnisses, als JSON</translation>
    </message>
    <message>
        <source>the base that an exported program sets: the controller&apos;s own by number (KRL) or name (RAPID), as-known (the numbers of the cell), or nothing: it must be in force</source>
        <translation>die Basis, die ein exportiertes Programm setzt: die der Steuerung, mit Nummer (KRL) oder Namen (RAPID), as-known (die Zahlen der Zelle), oder nichts: Sie muss gelten</translation>
    </message>
    <message>
        <source>the tool that an exported program sets: the controller&apos;s own by number (KRL) or name (RAPID), as-known (the numbers of the cell), or nothing: it must be in force</source>
        <translation>das Werkzeug, das ein exportiertes Programm setzt: das der Steuerung, mit Nummer (KRL) oder Namen (RAPID), as-known (die Zahlen der Zelle), oder nichts: Es muss gelten</translation>
    </message>
    <message>
        <source>how thick foot, column, upper arm, elbow, forearm, wrist and flange are, as seven radii for collisions of the arm, mm; 0: that link has no body; empty: estimated from the arm&apos;s length</source>
        <translation>wie dick Fuß, Säule, Oberarm, Ellbogen, Unterarm, Handgelenk und Flansch sind: sieben Radien für Kollisionen des Arms, mm; 0: dieses Glied hat keinen Körper; leer: aus der Länge des Arms geschätzt</translation>
    </message>
    <message>
        <source>ideal: the force is met at every moment; lag: it follows the commanded one with lag_s; actuator: the same, and a moving mass with damping between it and the contact</source>
        <translation>ideal: die Kraft wird in jedem Augenblick erreicht; lag: sie folgt der befohlenen mit lag_s; actuator: ebenso, und eine bewegte Masse mit Dämpfung liegt zwischen ihr und dem Kontakt</translation>
    </message>
    <message>
        <source>laid as a first proposal, and nobody has looked at it since</source>
        <translation>als erster Vorschlag gelegt, und seitdem hat niemand danach gesehen</translation>
    </message>
    <message>
        <source>loose faces whose normals are reversed</source>
        <translation>lose Flächen, deren Normalen umgekehrt werden</translation>
    </message>
    <message>
        <source>millimetres per unit of the file; of STEP and IGES files, which tell theirs: so many times larger than they say</source>
        <translation>Millimeter je Einheit der Datei; bei STEP- und IGES-Dateien, die ihre angeben: so viel mal größer, als sie sagen</translation>
    </message>
    <message>
        <source>reverse the normals of all loose faces, which look outwards as their neighbours and what they enclose tell, or else as the file has them</source>
        <translation>die Normalen aller losen Flächen umkehren; sie zeigen nach außen, wie Nachbarn und Umschlossenes es sagen, sonst wie in der Datei</translation>
    </message>
    <message>
        <source>distance between neighbouring samples</source>
        <translation>Abstand benachbarter Stützpunkte</translation>
    </message>
    <message>
        <source>distance between neighbouring samples, mm; 0: chosen by the faces, the wheel&apos;s contact and the tolerance</source>
        <translation>Abstand benachbarter Stützpunkte, mm; 0: gewählt nach Flächen, Kontakt der Scheibe und Toleranz</translation>
    </message>
    <message>
        <source>along which the belt travels, in the program&apos;s base, where Roll is fixed</source>
        <translation>wohin das Band läuft, in der Basis des Programms, wenn Roll auf fixed steht</translation>
    </message>
    <message>
        <source>how poses that are tool axes only (APT, G-code, CAM paths) are turned about them: held along a pass, along the pass, or the belt along RollDirection</source>
        <translation>wie Posen, die nur Werkzeugachsen sind (APT, G-Code, CAM-Bahnen), um sie gedreht werden: über eine Bahn gehalten, längs der Bahn, oder das Band längs RollDirection</translation>
    </message>
    <message>
        <source>feed of the contact while the force grows or falls, mm/s; 0: feed_mm_s</source>
        <translation>Vorschub des Kontakts, während die Kraft wächst oder fällt, mm/s; 0: feed_mm_s</translation>
    </message>
    <message>
        <source>force while the wheel comes down and lifts off, from which it grows, as a share of the full one</source>
        <translation>Kraft, während das Rad aufsetzt und abhebt, von der aus sie wächst, als Anteil der vollen</translation>
    </message>
    <message>
        <source>how the force comes onto a pass and off it. run_on: the wheel comes down outside the border, where there is room, and the force grows while it rolls over; inside: it comes down on the border, the force grows along the pass; direct: under the full force from the first moment</source>
        <translation>wie die Kraft auf eine Bahn kommt und von ihr geht. run_on: das Rad setzt außerhalb des Rands auf, wo Platz ist, und die Kraft wächst, während es hinüberrollt; inside: es setzt auf dem Rand auf, die Kraft wächst längs der Bahn; direct: vom ersten Augenblick an unter voller Kraft</translation>
    </message>
    <message>
        <source>length of pass over which the force grows to its full value, and falls at the end, mm; 0: until all of the contact is on the face</source>
        <translation>Länge der Bahn, über die die Kraft auf ihren vollen Wert wächst und am Ende fällt, mm; 0: bis der ganze Kontakt auf der Fläche ist</translation>
    </message>
    <message>
        <source>run_on: how far outside the border the wheel comes down, mm; 0: half the contact&apos;s length</source>
        <translation>run_on: wie weit außerhalb des Rands das Rad aufsetzt, mm; 0: die halbe Länge des Kontakts</translation>
    </message>
    <message>
        <source>turn of the wheel along a pass, degrees per mm: faster turns of up to edge_turn_deg are spread along it, at others it ends</source>
        <translation>Drehung des Rads längs einer Bahn, Grad je mm: schnellere Drehungen bis edge_turn_deg werden über sie verteilt, an anderen endet sie</translation>
    </message>
    <message>
        <source>line from which on motions are left out before each pose; 0: none</source>
        <translation>Zeile, ab der vor jeder Pose Bewegungen ausgelassen sind; 0: keine</translation>
    </message>
    <message>
        <source>the roll that the poses have</source>
        <translation>die Drehung, die die Posen haben</translation>
    </message>
    <message>
        <source>corners of what is left out</source>
        <translation>Ecken dessen, was ausgelassen ist</translation>
    </message>
    <message>
        <source>how deep the undeformed wheel may reach into the part beside the contact before that counts as standing in the part, mm</source>
        <translation>wie tief die unverformte Scheibe neben dem Kontakt in das Teil reichen darf, ehe sie als im Teil stehend gilt, mm</translation>
    </message>
    <message>
        <source>of the area, where it fits and no pass lies, percent</source>
        <translation>der Fläche, wo sie passt und keine Bahn liegt, Prozent</translation>
    </message>
    <message>
        <source>of the corners: 1 no room, 2 no pass</source>
        <translation>der Ecken: 1 kein Platz, 2 keine Bahn</translation>
    </message>
    <message>
        <source>three of them each</source>
        <translation>je drei davon</translation>
    </message>
    <message>
        <source>tilt: lean of the wheel about the belt&apos;s travel, at most, degrees</source>
        <translation>tilt: Neigung der Scheibe um den Bandlauf, höchstens, Grad</translation>
    </message>
    <message>
        <source>where the contact&apos;s width comes from. solved: from contacts that are solved at 50 places along the passes, on the faces as they are, the narrower ones; cylinder: from one on a cylinder with the faces&apos; median curvature across the passes</source>
        <translation>woher die Kontaktbreite kommt. solved: aus Kontakten, die an 50 Stellen längs der Bahnen auf den Flächen, wie sie sind, gelöst werden, den schmaleren; cylinder: aus einem auf einem Zylinder mit der mittleren Krümmung der Flächen quer zu den Bahnen</translation>
    </message>
    <message>
        <source>where the wheel would stand in the part, or in a body fixed to it. tilt: it leans about the belt&apos;s travel as far as it must, up to max_tilt_deg, and the place is left out where that is not enough; leave_out: without leaning; warn: the pass is laid all the same</source>
        <translation>wo die Scheibe im Teil stünde oder in einem Körper, der fest mit ihm ist. tilt: sie neigt sich um den Bandlauf so weit wie nötig, bis max_tilt_deg, und die Stelle bleibt aus, wo das nicht reicht; leave_out: ohne Neigung; warn: die Bahn wird trotzdem gelegt</translation>
    </message>
    <message>
        <source>how far round the points of the region, mm; 0: half the contact&apos;s width</source>
        <translation>wie weit um die Punkte des Gebiets, mm; 0: die halbe Kontaktbreite</translation>
    </message>
    <message>
        <source>passes only near these points of the faces; none: everywhere</source>
        <translation>Bahnen nur bei diesen Punkten der Flächen; keine: überall</translation>
    </message>
    <message>
        <source>what the passes follow. u, v: the lines of each face&apos;s own parametrisation along which u or v grows; direction: the cuts of parallel planes through all faces together; rings: round all faces together, which close about an axis; auto: of these ways, and of several directions, the one that leaves least, by a coarse simulation of each</source>
        <translation>wem die Bahnen folgen. u, v: den Linien der eigenen Parametrisierung jeder Fläche, längs denen u oder v wächst; direction: den Schnitten paralleler Ebenen durch alle Flächen zusammen; rings: rund um alle Flächen zusammen, die sich um eine Achse schließen; auto: von diesen Wegen und mehreren Richtungen dem, der am wenigsten übrig lässt, nach einer groben Simulation von jedem</translation>
    </message>
    <message>
        <source>zigzag: every other pass backwards; one_way: all passes in one direction; helix: rings are one pass, which goes on by a step-over at each turn (surfaces of revolution)</source>
        <translation>zigzag: jede zweite Bahn rückwärts; one_way: alle Bahnen in einer Richtung; helix: die Ringe sind eine Bahn, die mit jeder Drehung um einen Bahnabstand weitergeht (Drehflächen)</translation>
    </message>
    <message>
        <source>the values that the program asks for</source>
        <translation>die Werte, nach denen das Programm fragt</translation>
    </message>
    <message>
        <source>what only the controller knows of the program, as in NAME.values.json; empty: that file&apos;s, where it lies beside the program</source>
        <translation>was nur die Steuerung über das Programm weiß, wie in NAME.values.json; leer: das dieser Datei, wenn sie neben dem Programm liegt</translation>
    </message>
    <message>
        <source>a round has a motion remove more, or less, by no more than this factor</source>
        <translation>eine Runde lässt eine Bewegung höchstens um diesen Faktor mehr oder weniger abtragen</translation>
    </message>
    <message>
        <source>actuator: force against the speed of the movement, N s/mm; of a robot under admittance control its virtual damping</source>
        <translation>actuator: Kraft gegen die Geschwindigkeit der Bewegung, N s/mm; bei einem Roboter mit Admittanzregelung deren virtuelle Dämpfung</translation>
    </message>
    <message>
        <source>actuator: largest speed of the movement, mm/s; 0: none</source>
        <translation>actuator: größte Geschwindigkeit der Bewegung, mm/s; 0: beliebig</translation>
    </message>
    <message>
        <source>actuator: what moves with the wheel along the pressing direction, kg; of a robot under admittance control its virtual mass</source>
        <translation>actuator: was sich mit der Scheibe in Andruckrichtung bewegt, kg; bei einem Roboter mit Admittanzregelung deren virtuelle Masse</translation>
    </message>
    <message>
        <source>an input, the tolerance or a setting has changed since</source>
        <translation>eine Eingabe, die Toleranz oder eine Einstellung hat sich seither geändert</translation>
    </message>
    <message>
        <source>before, as planned and why, from one side</source>
        <translation>vorher, wie geplant und warum, von einer Seite</translation>
    </message>
    <message>
        <source>before, as planned and why, from two sides</source>
        <translation>vorher, wie geplant und warum, von zwei Seiten</translation>
    </message>
    <message>
        <source>before, of every pose, N</source>
        <translation>vorher, jeder Pose, N</translation>
    </message>
    <message>
        <source>before, of every pose, mm/s</source>
        <translation>vorher, jeder Pose, mm/s</translation>
    </message>
    <message>
        <source>corners of what stays out of tolerance</source>
        <translation>Ecken dessen, was außer Toleranz bleibt</translation>
    </message>
    <message>
        <source>different feeds in the whole plan, at most; 0: as many as there are motions</source>
        <translation>verschiedene Vorschübe im ganzen Plan, höchstens; 0: so viele, wie es Bewegungen gibt</translation>
    </message>
    <message>
        <source>figures as JSON</source>
        <translation>Zahlen als JSON</translation>
    </message>
    <message>
        <source>greatest feed of the programs&apos; tool centre point, mm/s</source>
        <translation>größter Vorschub des Werkzeugmittelpunkts der Programme, mm/s</translation>
    </message>
    <message>
        <source>greatest force where a slower feed is not enough, N; 0: forces are not raised</source>
        <translation>größte Kraft, wo ein langsamerer Vorschub nicht genügt, N; 0: Kräfte werden nicht erhöht</translation>
    </message>
    <message>
        <source>hash of the same job with its plan</source>
        <translation>Prüfsumme desselben Auftrags mit seinem Plan</translation>
    </message>
    <message>
        <source>hash of what was planned</source>
        <translation>Prüfsumme dessen, was geplant wurde</translation>
    </message>
    <message>
        <source>its feeds and forces come from a plan</source>
        <translation>seine Vorschübe und Kräfte kommen von einem Plan</translation>
    </message>
    <message>
        <source>least feed of the programs&apos; tool centre point, mm/s</source>
        <translation>kleinster Vorschub des Werkzeugmittelpunkts der Programme, mm/s</translation>
    </message>
    <message>
        <source>least force that a program&apos;s greatest may become where a faster feed is not enough, N; 0: forces are not lowered</source>
        <translation>kleinste Kraft, auf die die größte eines Programms sinken darf, wo ein schnellerer Vorschub nicht genügt, N; 0: Kräfte werden nicht gesenkt</translation>
    </message>
    <message>
        <source>more of the area comes into tolerance than before</source>
        <translation>es kommt mehr von der Fläche in Toleranz als vorher</translation>
    </message>
    <message>
        <source>motions whose feed must not change, by lines of the programs&apos; sources or by poses</source>
        <translation>Bewegungen, deren Vorschub sich nicht ändern darf, nach Zeilen der Programme oder nach Posen</translation>
    </message>
    <message>
        <source>names of the job&apos;s paths</source>
        <translation>Namen der Bahnen des Auftrags</translation>
    </message>
    <message>
        <source>nothing is ground on the way to these poses</source>
        <translation>auf dem Weg zu diesen Posen wird nichts geschliffen</translation>
    </message>
    <message>
        <source>of each path, what changes in its file; JSON</source>
        <translation>von jeder Bahn, was sich in ihrer Datei ändert; JSON</translation>
    </message>
    <message>
        <source>of the area, that a round must bring into tolerance; two rounds below it end the plan</source>
        <translation>der Fläche, die eine Runde in Toleranz bringen muss; zwei Runden darunter beenden den Plan</translation>
    </message>
    <message>
        <source>of the corners: as planning.reasons</source>
        <translation>der Ecken: wie planning.reasons</translation>
    </message>
    <message>
        <source>path of every pose, from 0</source>
        <translation>Bahn jeder Pose, ab 0</translation>
    </message>
    <message>
        <source>planned, of every pose, N</source>
        <translation>geplant, jeder Pose, N</translation>
    </message>
    <message>
        <source>planned, of every pose, mm/s</source>
        <translation>geplant, jeder Pose, mm/s</translation>
    </message>
    <message>
        <source>poses whose force is the belt machine&apos;s still</source>
        <translation>Posen, deren Kraft weiter die der Bandmaschine ist</translation>
    </message>
    <message>
        <source>share of the area as planned, percent</source>
        <translation>Anteil der Fläche wie geplant, Prozent</translation>
    </message>
    <message>
        <source>share of the area, percent</source>
        <translation>Anteil der Fläche, Prozent</translation>
    </message>
    <message>
        <source>simulate the planned programs once more at half the spacing and step; the figures told are that run&apos;s</source>
        <translation>die geplanten Programme noch einmal mit halbem Abstand und Schritt simulieren; die genannten Zahlen sind die dieses Laufs</translation>
    </message>
    <message>
        <source>simulations from which feeds are planned, at most</source>
        <translation>Simulationen, aus denen Vorschübe geplant werden, höchstens</translation>
    </message>
    <message>
        <source>the programs of the job have the planned feeds and forces</source>
        <translation>die Programme des Auftrags haben die geplanten Vorschübe und Kräfte</translation>
    </message>
    <message>
        <source>way of the contact up to every pose, mm</source>
        <translation>Weg des Kontakts bis zu jeder Pose, mm</translation>
    </message>
    <message>
        <source>what every round found</source>
        <translation>was jede Runde ergab</translation>
    </message>
    <message>
        <source>what the robot takes as planned, s</source>
        <translation>was der Roboter wie geplant braucht, s</translation>
    </message>
    <message>
        <source>what unequal feeds of neighbouring motions cost, against the deviations</source>
        <translation>was ungleiche Vorschübe benachbarter Bewegungen kosten, gegen die Abweichungen</translation>
    </message>
    <message>
        <source>why what is out of tolerance stays so</source>
        <translation>warum außer Toleranz bleibt, was es ist</translation>
    </message>
    <message>
        <source>how often all passes are run through, one after the other</source>
        <translation>wie oft alle Bahnen nacheinander durchlaufen werden</translation>
    </message>
    <message>
        <source>settings of the passes, if they are laid anew; JSON</source>
        <translation>Einstellungen der Bahnen, wenn sie neu gelegt werden; JSON</translation>
    </message>
    <message>
        <source>the passes are laid anew, too: step-over, run-out, how often they are run through</source>
        <translation>auch die Bahnen werden neu gelegt: Zustellung, Auslauf, wie oft sie durchlaufen werden</translation>
    </message>
    <message>
        <source>tolerance: as much of the area in tolerance as can be; time: the shortest grind that still has wanted_share</source>
        <translation>tolerance: so viel der Fläche in Toleranz wie möglich; time: die kürzeste Bearbeitung, die wanted_share noch hat</translation>
    </message>
    <message>
        <source>greatest change of the feed along the path, mm/s per mm; 0: no limit</source>
        <translation>größte Änderung des Vorschubs längs der Bahn, mm/s je mm; 0: keine Grenze</translation>
    </message>
    <message>
        <source>greatest change of the force, N/s; steps that the program has itself may stay; 0: no limit</source>
        <translation>größte Änderung der Kraft, N/s; Stufen, die das Programm selbst hat, dürfen bleiben; 0: keine Grenze</translation>
    </message>
    <message>
        <source>greatest pressure times belt speed where forces may change, MPa m/s; 0: the law&apos;s heat_limit_MPa_m_s</source>
        <translation>größter Druck mal Bandgeschwindigkeit, wo sich Kräfte ändern dürfen, MPa m/s; 0: heat_limit_MPa_m_s des Gesetzes</translation>
    </message>
    <message>
        <source>greatest pressure where forces may change, MPa; 0: the law&apos;s pressure_limit_MPa</source>
        <translation>größter Druck, wo sich Kräfte ändern dürfen, MPa; 0: pressure_limit_MPa des Gesetzes</translation>
    </message>
    <message>
        <source>of the area, that must be in tolerance, for time, and for what of the laws drawn at random passes; 0: as much as can be, but for 0.002</source>
        <translation>der Fläche, der in Toleranz sein muss, für die Zeit und dafür, wie viele der gezogenen Gesetze bestehen; 0: so viel wie möglich, bis auf 0.002</translation>
    </message>
    <message>
        <source>standard deviation of where the raw part lies against the design, along each axis, mm; for the probability</source>
        <translation>Standardabweichung der Lage des Rohteils gegen den Entwurf, längs jeder Achse, mm; für die Wahrscheinlichkeit</translation>
    </message>
    <message>
        <source>with which the feed may change along the path, mm/s2; 0: no limit</source>
        <translation>mit der sich der Vorschub längs der Bahn ändern darf, mm/s2; 0: keine Grenze</translation>
    </message>
    <message>
        <source>with which the part shall be in tolerance, the law being as unsure as its calibration says; 0: as simulated</source>
        <translation>mit der das Teil in Toleranz sein soll, so unsicher, wie die Kalibrierung das Gesetz nennt; 0: wie simuliert</translation>
    </message>
    <message>
        <source>J or mm3 in which the wearing share falls to 1/e; power: W from which the cut falls</source>
        <translation>J oder mm³, in denen der verschleißende Anteil auf 1/e fällt; power: W, von dem an der Abtrag fällt</translation>
    </message>
    <message>
        <source>exponential: rest + (1 - rest) exp(-W / scale); two_stage: rest + first_share exp(-W / first_scale) + (1 - rest - first_share) exp(-W / scale); power: (1 + W / scale)^-exponent; curve: measured</source>
        <translation>exponential: rest + (1 - rest) exp(-W / scale); two_stage: rest + first_share exp(-W / first_scale) + (1 - rest - first_share) exp(-W / scale); power: (1 + W / scale)^-exponent; curve: gemessen</translation>
    </message>
    <message>
        <source>power: exponent of the fall</source>
        <translation>power: Exponent des Abfalls</translation>
    </message>
    <message>
        <source>by how much the surface may bulge over the chords between samples where it is curved, mm: there they lie closer together; 0: as far apart as elsewhere</source>
        <translation>um wie viel die Fläche, wo sie gekrümmt ist, über die Sehnen zwischen den Abtastpunkten hinausstehen darf, mm: Dort liegen sie dichter; 0: so weit auseinander wie sonst</translation>
    </message>
    <message>
        <source>least distance between samples where the surface is tightly curved, as at a leading edge, mm; without a precision, normals turn by a quarter of a radian at most from sample to sample; 0: a fortieth of the spacing, if there is a precision</source>
        <translation>kleinster Abstand der Abtastpunkte, wo die Fläche eng gekrümmt ist, wie an einer Vorderkante, mm; ohne Genauigkeit drehen sich die Normalen von Punkt zu Punkt um höchstens ein viertel Radiant; 0: ein Vierzigstel des Abstands, wenn eine Genauigkeit gegeben ist</translation>
    </message>
    <message>
        <source>radius left and chord loss at each edge that it meets</source>
        <translation>verbliebener Radius und Sehnenverlust an jeder Kante, die er trifft</translation>
    </message>
    <message>
        <source>What is answered from the table.</source>
        <translation>Was aus der Tabelle beantwortet wird.</translation>
    </message>
    <message>
        <source>a row a run, as table.csv has it</source>
        <translation>eine Zeile je Lauf, wie in table.csv</translation>
    </message>
    <message>
        <source>answers as answers.json has them</source>
        <translation>Antworten wie in answers.json</translation>
    </message>
    <message>
        <source>grid: every value with every other; latin_hypercube: each part of every range once; sobol: a sequence that fills evenly; monte_carlo: at random; sobol_indices: the blocks that Sobol indices are found from</source>
        <translation>grid: jeder Wert mit jedem anderen; latin_hypercube: jeder Teil jedes Bereichs einmal; sobol: eine Folge, die gleichmäßig füllt; monte_carlo: zufällig; sobol_indices: die Blöcke, aus denen Sobol-Indizes bestimmt werden</translation>
    </message>
    <message>
        <source>hash of what was run</source>
        <translation>Hash dessen, was gelaufen ist</translation>
    </message>
    <message>
        <source>how many; of sobol_indices, of one block; of a grid nothing, which has as many as its values make</source>
        <translation>wie viele; bei sobol_indices in einem Block; bei einem Gitter ohne Bedeutung, das so viele hat, wie seine Werte ergeben</translation>
    </message>
    <message>
        <source>of what is drawn at random: the same seed gives the same runs</source>
        <translation>für alles Zufällige: dieselbe Startzahl ergibt dieselben Läufe</translation>
    </message>
    <message>
        <source>processes that run; 0: as many as there are cores, 1: one run after the other</source>
        <translation>Prozesse, die laufen; 0: so viele, wie es Kerne gibt, 1: ein Lauf nach dem anderen</translation>
    </message>
    <message>
        <source>run that the document was set to last; 0: none</source>
        <translation>Lauf, auf den das Dokument zuletzt gesetzt wurde; 0: keiner</translation>
    </message>
    <message>
        <source>runs of the design</source>
        <translation>Läufe des Versuchsplans</translation>
    </message>
    <message>
        <source>runs that could not be run</source>
        <translation>Läufe, die nicht möglich waren</translation>
    </message>
    <message>
        <source>runs whose verdict is pass, percent; -1: not known</source>
        <translation>Läufe, deren Urteil bestanden ist, Prozent; -1: nicht bekannt</translation>
    </message>
    <message>
        <source>runs with figures</source>
        <translation>Läufe mit Ergebnis</translation>
    </message>
    <message>
        <source>the design as design.json has it</source>
        <translation>der Versuchsplan wie in design.json</translation>
    </message>
    <message>
        <source>the job&apos;s settings that were varied, as JSON</source>
        <translation>die Einstellungen des Auftrags, die variiert wurden, als JSON</translation>
    </message>
    <message>
        <source>the same of the job alone</source>
        <translation>dasselbe des Auftrags allein</translation>
    </message>
    <message>
        <source>the same of the job set to OpenedRun</source>
        <translation>dasselbe des auf OpenedRun gesetzten Auftrags</translation>
    </message>
    <message>
        <source>what varies</source>
        <translation>was variiert</translation>
    </message>
    <message>
        <source>which of the varied depend on each other: a Gaussian copula</source>
        <translation>welche der variierten Größen voneinander abhängen: eine Gauß-Copula</translation>
    </message>
    <message>
        <source>What temperatures are computed with; without it there are none.</source>
        <translation>Womit Temperaturen berechnet werden; ohne das gibt es keine.</translation>
    </message>
    <message>
        <source>likely, of the hottest sample, degrees C; 0: not computed</source>
        <translation>wahrscheinlich, des heißesten Stützpunkts, Grad C; 0: nicht berechnet</translation>
    </message>
    <message>
        <source>of the part before it was ground, degrees C</source>
        <translation>des Teils vor dem Schleifen, Grad C</translation>
    </message>
    <message>
        <source>share of the area likely above the limit, percent</source>
        <translation>Anteil der Fläche, der wahrscheinlich über der Grenze liegt, Prozent</translation>
    </message>
    <message>
        <source>the same, if friction and partition are the most that they may be</source>
        <translation>dasselbe, wenn Reibung und Wärmeanteil am größten sind</translation>
    </message>
    <message>
        <source>what the colours show; uncertainty: of a calibrated law; measured, difference: of a scan; temperature: the greatest, of a job with Heat; roughness: Ra, of a job with Finish</source>
        <translation>was die Farben zeigen; uncertainty: eines kalibrierten Gesetzes; measured, difference: eines Scans; temperature: die höchste, einer Aufgabe mit Heat; roughness: Ra, einer Aufgabe mit Finish</translation>
    </message>
    <message>
        <source>What the finish (roughness, direction of the scratches) is computed with; without it there is none.</source>
        <translation>Womit die Oberflächengüte (Rauheit, Richtung der Schleifspuren) berechnet wird; ohne das gibt es keine.</translation>
    </message>
    <message>
        <source>Ra of the roughest sample that was ground, µm; 0: not known</source>
        <translation>Ra des rauesten geschliffenen Stützpunkts, µm; 0: nicht bekannt</translation>
    </message>
    <message>
        <source>Ra, µm, weighted by the ground area; 0: not known</source>
        <translation>Ra, µm, nach der geschliffenen Fläche gewichtet; 0: nicht bekannt</translation>
    </message>
    <message>
        <source>share of the ground area with a known Ra, percent</source>
        <translation>Anteil der geschliffenen Fläche mit bekanntem Ra, Prozent</translation>
    </message>
    <message>
        <source>share of the ground area where crossed scratches stay, percent; -1: not known</source>
        <translation>Anteil der geschliffenen Fläche, auf dem gekreuzte Schleifspuren bleiben, Prozent; -1: nicht bekannt</translation>
    </message>
    <message>
        <source>draw the direction of the scratches, of a job with Finish; red: crossed</source>
        <translation>die Richtung der Schleifspuren zeichnen, einer Aufgabe mit Finish; rot: gekreuzt</translation>
    </message>
    <message>
        <source>Poisson&apos;s ratio of the belt, below 0.5</source>
        <translation>Querkontraktionszahl des Bandes, unter 0,5</translation>
    </message>
    <message>
        <source>Young&apos;s modulus of the belt, MPa</source>
        <translation>Elastizitätsmodul des Bandes, MPa</translation>
    </message>
    <message>
        <source>along the belt&apos;s travel from the middle between the rollers to the contact frame&apos;s origin, mm</source>
        <translation>in Laufrichtung des Bandes von der Mitte zwischen den Rollen zum Ursprung des Kontaktsystems, mm</translation>
    </message>
    <message>
        <source>by how much the belt&apos;s face (grains, size coat) gives way under pressure, MPa/mm; 0: as its own thickness does</source>
        <translation>wie sehr die Fläche des Bandes (Körner, Deckbindung) unter Druck nachgibt, MPa/mm; 0: wie seine eigene Dicke</translation>
    </message>
    <message>
        <source>by how much what lies between belt and layers gives way, MPa/mm; 0: as the belt&apos;s face does</source>
        <translation>wie sehr nachgibt, was zwischen Band und Schichten liegt, MPa/mm; 0: wie die Fläche des Bandes</translation>
    </message>
    <message>
        <source>fixed: they stay, and the belt&apos;s stretch adds to its tension; tensioned: they keep the pull</source>
        <translation>fixed: sie bleiben stehen, und die Dehnung des Bandes erhöht seine Spannung; tensioned: sie halten den Zug</translation>
    </message>
    <message>
        <source>layers between the plate and the belt, from the plate outwards; empty: the plate itself bears the belt</source>
        <translation>Schichten zwischen Platte und Band, von der Platte nach außen; leer: die Platte selbst trägt das Band</translation>
    </message>
    <message>
        <source>length between the rollers, mm</source>
        <translation>Länge zwischen den Rollen, mm</translation>
    </message>
    <message>
        <source>radius of the rollers, for collisions, mm; 0: none are looked at</source>
        <translation>Radius der Rollen, für Kollisionen, mm; 0: keine werden betrachtet</translation>
    </message>
    <message>
        <source>tension of the belt that touches nothing, N per mm of its width</source>
        <translation>Spannung des Bandes, das nichts berührt, N je mm seiner Breite</translation>
    </message>
    <message>
        <source>thickness of the belt, mm</source>
        <translation>Dicke des Bandes, mm</translation>
    </message>
    <message>
        <source>thickness of the plate behind the layers, for collisions, mm</source>
        <translation>Dicke der Platte hinter den Schichten, für Kollisionen, mm</translation>
    </message>
    <message>
        <source>width of the belt, mm</source>
        <translation>Breite des Bandes, mm</translation>
    </message>
    <message>
        <source>between the belt&apos;s two runs there, mm</source>
        <translation>zwischen den beiden Trumen dort, mm</translation>
    </message>
    <message>
        <source>from the wheel&apos;s axle back to where the belt meets its pulleys, mm; more than the wheel&apos;s radius</source>
        <translation>von der Achse der Scheibe zurück bis zu den Umlenkrollen, mm; mehr als der Radius der Scheibe</translation>
    </message>
    <message>
        <source>thickness of the arms on both sides of the wheel, along its axle, mm; 0: none are looked at</source>
        <translation>Dicke der Arme zu beiden Seiten der Scheibe, längs ihrer Achse, mm; 0: keine werden betrachtet</translation>
    </message>
    <message>
        <source>what presses the belt on the part. contact_wheel, and without the key: a wheel with the belt round it; free_belt: the belt itself, between two rollers; platen: a plate behind the belt (docs/free-belt.md); small_wheel: a contact_wheel in a fork, beside which the belt&apos;s two runs are looked at for collisions. Of a free_belt and a platen, the contact frame&apos;s origin lies on the face of the belt that touches nothing; wheel and compliance are then of no account</source>
        <translation>was das Band auf das Werkstück drückt. contact_wheel, auch ohne den Schlüssel: ein Rad mit dem Band darum; free_belt: das Band selbst, zwischen zwei Rollen; platen: eine Platte hinter dem Band (docs/free-belt.md); small_wheel: ein Rad in einer Gabel, neben dem die beiden Trume des Bandes für Kollisionen betrachtet werden. Bei free_belt und platen liegt der Ursprung des Kontaktsystems auf der Fläche des Bandes, das nichts berührt; Rad und Nachgiebigkeit zählen dann nicht</translation>
    </message>
    <message>
        <source>of the area, where there is no room and no pass lies, percent</source>
        <translation>der Fläche, wo kein Platz ist und keine Bahn liegt, in Prozent</translation>
    </message>
    <message>
        <source>of the tool along a pass, degrees per mm</source>
        <translation>des Werkzeugs längs einer Bahn, Grad je mm</translation>
    </message>
    <message>
        <source>of the tool between neighbouring poses of a pass</source>
        <translation>des Werkzeugs zwischen benachbarten Posen einer Bahn</translation>
    </message>
    <message>
        <source>removed on the way down to the passes and off them, percent, by force and time; -1: not known</source>
        <translation>des Abtrags, auf dem Weg hinab zu den Bahnen und von ihnen weg, in Prozent, nach Kraft und Zeit; -1: nicht bekannt</translation>
    </message>
    <message>
        <source>when every motion ends, s; empty: not known</source>
        <translation>wann jede Bewegung endet, s; leer: nicht bekannt</translation>
    </message>
    <message>
        <source>zones by which events tell the finish, JSON</source>
        <translation>Zonen, nach denen Ereignisse die Oberflächengüte beurteilen, JSON</translation>
    </message>
    <message>
        <source>from the rollers&apos; axes back to where the belt&apos;s two runs meet their pulleys, mm; 0: runs and arms are not looked at</source>
        <translation>von den Achsen der Rollen zurück bis dorthin, wo die beiden Trume des Bandes auf ihre Umlenkrollen treffen, mm; 0: Trume und Arme werden nicht betrachtet</translation>
    </message>
    <message>
        <source>length along the belt&apos;s travel, of a curved platen straight from end to end, mm</source>
        <translation>Länge in Laufrichtung des Bandes, bei einer gewölbten Platte gerade von Ende zu Ende, mm</translation>
    </message>
    <message>
        <source>on which sides of the belt they are: both; minus_y or plus_y of the contact frame alone</source>
        <translation>auf welchen Seiten des Bandes sie sind: both (beiden); minus_y oder plus_y: nur dort im Kontaktsystem</translation>
    </message>
    <message>
        <source>radius of the face that the belt slides on, bent along the travel and convex towards the work, mm: the belt lies round all of it and leaves it along its tangents; 0: flat</source>
        <translation>Radius der Fläche, auf der das Band gleitet, in Laufrichtung gewölbt, zum Werkstück hin erhaben, mm: das Band liegt auf ihrer ganzen Länge und verlässt sie in ihren Tangenten; 0: eben</translation>
    </message>
    <message>
        <source>thickness of the arms beside the belt, from roller to roller and back to the pulleys, mm; 0: none are looked at</source>
        <translation>Dicke der Arme neben dem Band, von Rolle zu Rolle und zurück zu den Umlenkrollen, mm; 0: keine werden betrachtet</translation>
    </message>
    <message>
        <source>the job&apos;s stock, where the passes depend on it</source>
        <translation>das Aufmaß des Auftrags, wo die Bahnen davon abhängen</translation>
    </message>
    <message>
        <source>what the user should know of the runs</source>
        <translation>was der Benutzer von den Läufen wissen sollte</translation>
    </message>
    <message>
        <source>hash of the surface that the mesh is of</source>
        <translation>Hash der Oberfläche, deren Netz es ist</translation>
    </message>
</context>
<context>
    <name>BeltGrinding</name>
    <message>
        <source>{} (coarse)</source>
        <translation>{} (grob)</translation>
    </message>
    <message>
        <source>Coarse resolution: for searching, no verdict.</source>
        <translation>Grobe Auflösung: zum Suchen, kein Urteil.</translation>
    </message>
    <message>
        <source>Resolution of the search</source>
        <translation>Auflösung der Suche</translation>
    </message>
    <message>
        <source>full</source>
        <translation>voll</translation>
    </message>
    <message>
        <source>coarse</source>
        <translation>grob</translation>
    </message>
    <message>
        <source>(none)</source>
        <translation>(keine)</translation>
    </message>
    <message>
        <source>(not known)</source>
        <translation>(nicht bekannt)</translation>
    </message>
    <message>
        <source>Aligning and measuring...</source>
        <translation>Wird ausgerichtet und gemessen...</translation>
    </message>
    <message>
        <source>Alignment, rms</source>
        <translation>Ausrichtung, RMS</translation>
    </message>
    <message>
        <source>Area measured</source>
        <translation>Gemessene Fläche</translation>
    </message>
    <message>
        <source>Compare</source>
        <translation>Vergleichen</translation>
    </message>
    <message>
        <source>Compare a scan</source>
        <translation>Scan vergleichen</translation>
    </message>
    <message>
        <source>Datum faces</source>
        <translation>Bezugsflächen</translation>
    </message>
    <message>
        <source>Difference, mean</source>
        <translation>Differenz, Mittel</translation>
    </message>
    <message>
        <source>Difference, rms</source>
        <translation>Differenz, RMS</translation>
    </message>
    <message>
        <source>Ground part as mesh</source>
        <translation>Geschliffenes Teil als Netz</translation>
    </message>
    <message>
        <source>Make the mesh anew</source>
        <translation>Netz neu erstellen</translation>
    </message>
    <message>
        <source>Measured, mean</source>
        <translation>Gemessen, Mittel</translation>
    </message>
    <message>
        <source>Points used</source>
        <translation>Genutzte Punkte</translation>
    </message>
    <message>
        <source>Reading {}</source>
        <translation>{} wird gelesen</translation>
    </message>
    <message>
        <source>Same verdict</source>
        <translation>Gleiches Urteil</translation>
    </message>
    <message>
        <source>Scan</source>
        <translation>Scan</translation>
    </message>
    <message>
        <source>Scan less prediction</source>
        <translation>Scan weniger Vorhersage</translation>
    </message>
    <message>
        <source>Start</source>
        <translation>Anfang</translation>
    </message>
    <message>
        <source>aligned already</source>
        <translation>schon ausgerichtet</translation>
    </message>
    <message>
        <source>all that are not ground</source>
        <translation>alle nicht geschliffenen</translation>
    </message>
    <message>
        <source>as it lies</source>
        <translation>wie er liegt</translation>
    </message>
    <message>
        <source>cancelled</source>
        <translation>abgebrochen</translation>
    </message>
    <message>
        <source>matrix from a file</source>
        <translation>Matrix aus einer Datei</translation>
    </message>
    <message>
        <source>numbers of the faces that the scan is laid on, as 1,2,5</source>
        <translation>Nummern der Flächen, auf die der Scan gelegt wird, wie 1,2,5</translation>
    </message>
    <message>
        <source>pairs of points from a file</source>
        <translation>Punktpaare aus einer Datei</translation>
    </message>
    <message>
        <source>principal axes</source>
        <translation>Hauptachsen</translation>
    </message>
    <message>
        <source>scan - prediction, {}</source>
        <translation>Scan - Vorhersage, {}</translation>
    </message>
    <message>
        <source>scan, {}</source>
        <translation>Scan, {}</translation>
    </message>
    <message>
        <source>... and {} more</source>
        <translation>... und {} weitere</translation>
    </message>
    <message>
        <source>5 % lie below</source>
        <translation>5 % liegen darunter</translation>
    </message>
    <message>
        <source>95 % lie below</source>
        <translation>95 % liegen darunter</translation>
    </message>
    <message>
        <source>; about {} left</source>
        <translation>; noch etwa {}</translation>
    </message>
    <message>
        <source>A direction</source>
        <translation>Eine Richtung</translation>
    </message>
    <message>
        <source>A new belt is on.</source>
        <translation>Ein neues Band ist aufgelegt.</translation>
    </message>
    <message>
        <source>Add selected</source>
        <translation>Hinzufügen</translation>
    </message>
    <message>
        <source>Again</source>
        <translation>Erneut</translation>
    </message>
    <message>
        <source>Allowance</source>
        <translation>Aufmaß</translation>
    </message>
    <message>
        <source>Along</source>
        <translation>Entlang</translation>
    </message>
    <message>
        <source>Along the normal</source>
        <translation>Entlang der Normalen</translation>
    </message>
    <message>
        <source>Angular acceleration</source>
        <translation>Winkelbeschleunigung</translation>
    </message>
    <message>
        <source>Approach</source>
        <translation>Anfahren</translation>
    </message>
    <message>
        <source>Approach feed</source>
        <translation>Anfahrvorschub</translation>
    </message>
    <message>
        <source>Approach length</source>
        <translation>Anfahrlänge</translation>
    </message>
    <message>
        <source>Area</source>
        <translation>Fläche</translation>
    </message>
    <message>
        <source>At a pose of the program</source>
        <translation>An einer Pose des Programms</translation>
    </message>
    <message>
        <source>At every moment</source>
        <translation>Jederzeit</translation>
    </message>
    <message>
        <source>At the part, as they are drawn</source>
        <translation>Am Werkstück, wie gezeichnet</translation>
    </message>
    <message>
        <source>At the wheel, in the contact frame</source>
        <translation>An der Scheibe, im Kontaktsystem</translation>
    </message>
    <message>
        <source>Belt</source>
        <translation>Schleifband</translation>
    </message>
    <message>
        <source>Belt against pass</source>
        <translation>Band gegen Bahn</translation>
    </message>
    <message>
        <source>Belt and control</source>
        <translation>Band und Regelung</translation>
    </message>
    <message>
        <source>Belt bending</source>
        <translation>Bandbiegung</translation>
    </message>
    <message>
        <source>Belt grinding</source>
        <translation>Bandschleifen</translation>
    </message>
    <message>
        <source>Belt machine</source>
        <translation>Bandschleifmaschine</translation>
    </message>
    <message>
        <source>Belt speed</source>
        <translation>Bandgeschwindigkeit</translation>
    </message>
    <message>
        <source>Belt tension</source>
        <translation>Bandspannung</translation>
    </message>
    <message>
        <source>Belt wear</source>
        <translation>Bandverschleiß</translation>
    </message>
    <message>
        <source>Belt-grinding job</source>
        <translation>Bandschleifauftrag</translation>
    </message>
    <message>
        <source>Bodies</source>
        <translation>Körper</translation>
    </message>
    <message>
        <source>Bonded layer</source>
        <translation>Aufgeklebte Schicht</translation>
    </message>
    <message>
        <source>Bridge gaps up to</source>
        <translation>Lücken überbrücken bis</translation>
    </message>
    <message>
        <source>By a curve</source>
        <translation>Nach Kurve</translation>
    </message>
    <message>
        <source>CSV with columns such as force_N, time_s, area_mm2</source>
        <translation>CSV mit Spalten wie force_N, time_s, area_mm2</translation>
    </message>
    <message>
        <source>Calibrate removal law</source>
        <translation>Abtragsgesetz kalibrieren</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Cancel the simulation</source>
        <translation>Simulation abbrechen</translation>
    </message>
    <message>
        <source>Cancelled; the document is as it was.</source>
        <translation>Abgebrochen; das Dokument ist wie zuvor.</translation>
    </message>
    <message>
        <source>Cell</source>
        <translation>Zelle</translation>
    </message>
    <message>
        <source>Choose the table of measured grinds.</source>
        <translation>Bitte die Tabelle der gemessenen Schliffe wählen.</translation>
    </message>
    <message>
        <source>Chord error</source>
        <translation>Sehnenfehler</translation>
    </message>
    <message>
        <source>Clearance</source>
        <translation>Sicherheitsabstand</translation>
    </message>
    <message>
        <source>Close the open task panel first.</source>
        <translation>Zuerst das offene Aufgabenfenster schließen.</translation>
    </message>
    <message>
        <source>Colours</source>
        <translation>Farben</translation>
    </message>
    <message>
        <source>Colours end at</source>
        <translation>Farbskala endet bei</translation>
    </message>
    <message>
        <source>Constant feed</source>
        <translation>Konstanter Vorschub</translation>
    </message>
    <message>
        <source>Contact across the pass: {:.1f} mm</source>
        <translation>Kontakt quer zur Bahn: {:.1f} mm</translation>
    </message>
    <message>
        <source>Contact at a pose</source>
        <translation>Kontakt an einer Pose</translation>
    </message>
    <message>
        <source>Contact in base</source>
        <translation>Kontakt in Basis</translation>
    </message>
    <message>
        <source>Contact in tool</source>
        <translation>Kontakt im Werkzeug</translation>
    </message>
    <message>
        <source>Contact wheel</source>
        <translation>Kontaktscheibe</translation>
    </message>
    <message>
        <source>Control</source>
        <translation>Regelung</translation>
    </message>
    <message>
        <source>Count the simulated grind</source>
        <translation>Simulierten Schliff anrechnen</translation>
    </message>
    <message>
        <source>Crown radius (0: cylinder)</source>
        <translation>Balligkeitsradius (0: Zylinder)</translation>
    </message>
    <message>
        <source>Cut too deep</source>
        <translation>Zu tief geschliffen</translation>
    </message>
    <message>
        <source>Cutting ability (fresh: 1)</source>
        <translation>Schnittvermögen (neu: 1)</translation>
    </message>
    <message>
        <source>Damping</source>
        <translation>Dämpfung</translation>
    </message>
    <message>
        <source>Default zone</source>
        <translation>Standardzone</translation>
    </message>
    <message>
        <source>Density (0: no growth)</source>
        <translation>Dichte (0: starr)</translation>
    </message>
    <message>
        <source>Deviation</source>
        <translation>Abweichung</translation>
    </message>
    <message>
        <source>Direction</source>
        <translation>Richtung</translation>
    </message>
    <message>
        <source>Distance at most</source>
        <translation>Abstand höchstens</translation>
    </message>
    <message>
        <source>Done.</source>
        <translation>Fertig.</translation>
    </message>
    <message>
        <source>Drive wheel&apos;s diameter, mm</source>
        <translation>Ø der Antriebsscheibe, mm</translation>
    </message>
    <message>
        <source>Dynamic modulus</source>
        <translation>Dynamischer Modul</translation>
    </message>
    <message>
        <source>Edit</source>
        <translation>Bearbeiten</translation>
    </message>
    <message>
        <source>Edit...</source>
        <translation>Bearbeiten...</translation>
    </message>
    <message>
        <source>Elastic foundation</source>
        <translation>Elastische Bettung</translation>
    </message>
    <message>
        <source>Elasticity</source>
        <translation>Elastizität</translation>
    </message>
    <message>
        <source>Even on the surface</source>
        <translation>Gleichmäßig auf der Fläche</translation>
    </message>
    <message>
        <source>Event</source>
        <translation>Ereignis</translation>
    </message>
    <message>
        <source>Exponent of belt speed</source>
        <translation>Exponent der Bandgeschwindigkeit</translation>
    </message>
    <message>
        <source>Exponent of feed</source>
        <translation>Exponent des Vorschubs</translation>
    </message>
    <message>
        <source>Exponent of pressure</source>
        <translation>Exponent des Drucks</translation>
    </message>
    <message>
        <source>Exponential</source>
        <translation>Exponentiell</translation>
    </message>
    <message>
        <source>Export job file</source>
        <translation>Auftragsdatei schreiben</translation>
    </message>
    <message>
        <source>Faces</source>
        <translation>Flächen</translation>
    </message>
    <message>
        <source>Faces to be ground</source>
        <translation>Zu schleifende Flächen</translation>
    </message>
    <message>
        <source>Falls to 1/e in</source>
        <translation>Fällt auf 1/e nach</translation>
    </message>
    <message>
        <source>Falls with</source>
        <translation>Fällt mit</translation>
    </message>
    <message>
        <source>Feed</source>
        <translation>Vorschub</translation>
    </message>
    <message>
        <source>Feed (0: as programmed)</source>
        <translation>Vorschub (0: wie programmiert)</translation>
    </message>
    <message>
        <source>Fewer leave more of the machine to others; results are equal</source>
        <translation>Weniger lassen anderen Programmen mehr vom Rechner; die Ergebnisse sind gleich</translation>
    </message>
    <message>
        <source>File</source>
        <translation>Datei</translation>
    </message>
    <message>
        <source>Fit</source>
        <translation>Anpassen</translation>
    </message>
    <message>
        <source>Fitting ...</source>
        <translation>Wird angepasst ...</translation>
    </message>
    <message>
        <source>Flip loose normals</source>
        <translation>Lose Normalen umkehren</translation>
    </message>
    <message>
        <source>Folder of the result</source>
        <translation>Ordner des Ergebnisses</translation>
    </message>
    <message>
        <source>For the legend and the figures of the deviation. All else is shown in the units of FreeCAD&apos;s own preferences</source>
        <translation>Für die Legende und die Kennwerte der Abweichung. Alles andere erscheint in den Einheiten aus FreeCADs eigenen Einstellungen</translation>
    </message>
    <message>
        <source>Force</source>
        <translation>Kraft</translation>
    </message>
    <message>
        <source>Force (0: as programmed)</source>
        <translation>Kraft (0: wie programmiert)</translation>
    </message>
    <message>
        <source>Force (0: machine&apos;s)</source>
        <translation>Kraft (0: der Maschine)</translation>
    </message>
    <message>
        <source>Force control</source>
        <translation>Kraftregelung</translation>
    </message>
    <message>
        <source>Frames</source>
        <translation>Koordinatensysteme</translation>
    </message>
    <message>
        <source>From selected edge</source>
        <translation>Von gewählter Kante</translation>
    </message>
    <message>
        <source>General</source>
        <translation>Allgemein</translation>
    </message>
    <message>
        <source>Geometric (rigid tool)</source>
        <translation>Geometrisch (starres Werkzeug)</translation>
    </message>
    <message>
        <source>Grinding up to pose {} ...</source>
        <translation>Schleift bis Pose {} ...</translation>
    </message>
    <message>
        <source>Grinding, {}</source>
        <translation>Schleift, {}</translation>
    </message>
    <message>
        <source>Half-space</source>
        <translation>Halbraum</translation>
    </message>
    <message>
        <source>Hammann, global</source>
        <translation>Hammann, global</translation>
    </message>
    <message>
        <source>Heat limit</source>
        <translation>Wärmegrenze</translation>
    </message>
    <message>
        <source>Housing, gripper, fixtures: their coordinates are taken in the chosen frame</source>
        <translation>Gehäuse, Greifer, Vorrichtungen: ihre Koordinaten gelten im gewählten Koordinatensystem</translation>
    </message>
    <message>
        <source>Import a robot program to see the cell at its poses.</source>
        <translation>Ein Roboterprogramm einlesen, um die Zelle an seinen Posen zu sehen.</translation>
    </message>
    <message>
        <source>Import robot program</source>
        <translation>Roboterprogramm einlesen</translation>
    </message>
    <message>
        <source>In contact</source>
        <translation>Im Eingriff</translation>
    </message>
    <message>
        <source>In the robot&apos;s hand, in the tool frame</source>
        <translation>In der Roboterhand, im Werkzeugsystem</translation>
    </message>
    <message>
        <source>In tol., expected</source>
        <translation>In Tol., erwartet</translation>
    </message>
    <message>
        <source>In tolerance</source>
        <translation>In Toleranz</translation>
    </message>
    <message>
        <source>K</source>
        <translation>K</translation>
    </message>
    <message>
        <source>Kind</source>
        <translation>Art</translation>
    </message>
    <message>
        <source>Lands of a serrated wheel (share)</source>
        <translation>Stege einer genuteten Scheibe (Anteil)</translation>
    </message>
    <message>
        <source>Larger plot</source>
        <translation>Größeres Diagramm</translation>
    </message>
    <message>
        <source>Law</source>
        <translation>Gesetz</translation>
    </message>
    <message>
        <source>Line</source>
        <translation>Zeile</translation>
    </message>
    <message>
        <source>Lines of the surface</source>
        <translation>Linien der Fläche</translation>
    </message>
    <message>
        <source>Local linear</source>
        <translation>Lokal linear</translation>
    </message>
    <message>
        <source>Local with exponents</source>
        <translation>Lokal mit Exponenten</translation>
    </message>
    <message>
        <source>Lower limit</source>
        <translation>Untere Grenze</translation>
    </message>
    <message>
        <source>Material</source>
        <translation>Werkstoff</translation>
    </message>
    <message>
        <source>Maximum</source>
        <translation>Maximum</translation>
    </message>
    <message>
        <source>Mean</source>
        <translation>Mittelwert</translation>
    </message>
    <message>
        <source>Measured grinds</source>
        <translation>Gemessene Schliffe</translation>
    </message>
    <message>
        <source>Median</source>
        <translation>Median</translation>
    </message>
    <message>
        <source>Mesh (a scan)</source>
        <translation>Netz (ein Scan)</translation>
    </message>
    <message>
        <source>Minimum</source>
        <translation>Minimum</translation>
    </message>
    <message>
        <source>Model</source>
        <translation>Modell</translation>
    </message>
    <message>
        <source>Motion</source>
        <translation>Art</translation>
    </message>
    <message>
        <source>Must be at least {}</source>
        <translation>Muss mindestens {} sein</translation>
    </message>
    <message>
        <source>Must be at most {}</source>
        <translation>Darf höchstens {} sein</translation>
    </message>
    <message>
        <source>Must be greater than {}</source>
        <translation>Muss größer als {} sein</translation>
    </message>
    <message>
        <source>New belt</source>
        <translation>Neues Band</translation>
    </message>
    <message>
        <source>New jobs</source>
        <translation>Neue Aufträge</translation>
    </message>
    <message>
        <source>No events.</source>
        <translation>Keine Ereignisse.</translation>
    </message>
    <message>
        <source>No result yet.</source>
        <translation>Noch kein Ergebnis.</translation>
    </message>
    <message>
        <source>None</source>
        <translation>Keiner</translation>
    </message>
    <message>
        <source>Object</source>
        <translation>Objekt</translation>
    </message>
    <message>
        <source>Off: the part stays and the wheel moves over it. On: the part moves where the robot holds it</source>
        <translation>Aus: Das Werkstück bleibt stehen, die Scheibe fährt darüber. Ein: Das Werkstück bewegt sich, wenn der Roboter es hält</translation>
    </message>
    <message>
        <source>One way</source>
        <translation>Gleichsinnig</translation>
    </message>
    <message>
        <source>Open job file</source>
        <translation>Auftragsdatei öffnen</translation>
    </message>
    <message>
        <source>Order</source>
        <translation>Reihenfolge</translation>
    </message>
    <message>
        <source>Out of date: an input has changed since.</source>
        <translation>Veraltet: Eine Eingabe hat sich seitdem geändert.</translation>
    </message>
    <message>
        <source>Out of date: simulate again.</source>
        <translation>Veraltet: erneut simulieren.</translation>
    </message>
    <message>
        <source>Parameter</source>
        <translation>Parameter</translation>
    </message>
    <message>
        <source>Part in base</source>
        <translation>Werkstück in Basis</translation>
    </message>
    <message>
        <source>Part in hand</source>
        <translation>Werkstück</translation>
    </message>
    <message>
        <source>Part in tool</source>
        <translation>Werkstück im Werkzeug</translation>
    </message>
    <message>
        <source>Passes</source>
        <translation>Bahnen</translation>
    </message>
    <message>
        <source>Path acceleration</source>
        <translation>Bahnbeschleunigung</translation>
    </message>
    <message>
        <source>Place of the file</source>
        <translation>Lage der Datei</translation>
    </message>
    <message>
        <source>Poisson&apos;s ratio</source>
        <translation>Querkontraktionszahl</translation>
    </message>
    <message>
        <source>Pose</source>
        <translation>Pose</translation>
    </message>
    <message>
        <source>Poses</source>
        <translation>Posen</translation>
    </message>
    <message>
        <source>Position</source>
        <translation>Lage</translation>
    </message>
    <message>
        <source>Presets</source>
        <translation>Vorgaben</translation>
    </message>
    <message>
        <source>Problems ({})</source>
        <translation>Probleme ({})</translation>
    </message>
    <message>
        <source>Process</source>
        <translation>Prozess</translation>
    </message>
    <message>
        <source>Program</source>
        <translation>Programm</translation>
    </message>
    <message>
        <source>Radius</source>
        <translation>Radius</translation>
    </message>
    <message>
        <source>Raster path</source>
        <translation>Zeilenbahn</translation>
    </message>
    <message>
        <source>Read the file again</source>
        <translation>Datei neu einlesen</translation>
    </message>
    <message>
        <source>Reference feed</source>
        <translation>Bezugsvorschub</translation>
    </message>
    <message>
        <source>Reference pressure</source>
        <translation>Bezugsdruck</translation>
    </message>
    <message>
        <source>Reference speed</source>
        <translation>Bezugsgeschwindigkeit</translation>
    </message>
    <message>
        <source>Remaining cut: {:.1f} % of a fresh belt&apos;s</source>
        <translation>Restschnittvermögen: {:.1f} % eines neuen Bandes</translation>
    </message>
    <message>
        <source>Removal</source>
        <translation>Abtrag</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>Entfernen</translation>
    </message>
    <message>
        <source>Removed</source>
        <translation>Abgetragen</translation>
    </message>
    <message>
        <source>Removed volume, mm³</source>
        <translation>Abtragsvolumen, mm³</translation>
    </message>
    <message>
        <source>Removed: {:,.1f} of {:,.1f} mm³
Process time: {:.1f} s
Samples: {:,}, steps: {:,}, computed in {:.1f} s
Missed rays: {:,}, defective stock: {:,} samples</source>
        <translation>Abgetragen: {:,.1f} von {:,.1f} mm³
Prozesszeit: {:.1f} s
Abtastpunkte: {:,}, Schritte: {:,}, gerechnet in {:.1f} s
Verfehlte Strahlen: {:,}, fehlendes Aufmaß: {:,} Punkte</translation>
    </message>
    <message>
        <source>Rigid (geometric)</source>
        <translation>Starr (geometrisch)</translation>
    </message>
    <message>
        <source>Rim thickness</source>
        <translation>Belagdicke</translation>
    </message>
    <message>
        <source>Robot holds</source>
        <translation>Roboter hält</translation>
    </message>
    <message>
        <source>Robot program</source>
        <translation>Roboterprogramm</translation>
    </message>
    <message>
        <source>Robot&apos;s speed</source>
        <translation>Robotergeschwindigkeit</translation>
    </message>
    <message>
        <source>Robot&apos;s stiffness (0: rigid)</source>
        <translation>Robotersteifigkeit (0: starr)</translation>
    </message>
    <message>
        <source>Root mean square</source>
        <translation>Quadratisches Mittel</translation>
    </message>
    <message>
        <source>Rotation speed</source>
        <translation>Drehgeschwindigkeit</translation>
    </message>
    <message>
        <source>Run-out at borders</source>
        <translation>Überlauf an Rändern</translation>
    </message>
    <message>
        <source>Runs counted: {}.</source>
        <translation>Angerechnete Läufe: {}.</translation>
    </message>
    <message>
        <source>Sample spacing</source>
        <translation>Abtastabstand</translation>
    </message>
    <message>
        <source>Sampling and tolerance</source>
        <translation>Abtastung und Toleranz</translation>
    </message>
    <message>
        <source>Saturation (0: none)</source>
        <translation>Sättigung (0: keine)</translation>
    </message>
    <message>
        <source>Search inward</source>
        <translation>Suche nach innen</translation>
    </message>
    <message>
        <source>Search outward</source>
        <translation>Suche nach außen</translation>
    </message>
    <message>
        <source>Select Part or Mesh objects in the tree first.</source>
        <translation>Zuerst Part- oder Mesh-Objekte im Baum auswählen.</translation>
    </message>
    <message>
        <source>Select an edge in the 3D view first.</source>
        <translation>Zuerst eine Kante in der 3D-Ansicht auswählen.</translation>
    </message>
    <message>
        <source>Select faces in the 3D view first.</source>
        <translation>Zuerst Flächen in der 3D-Ansicht auswählen.</translation>
    </message>
    <message>
        <source>Set the belt speed to {} m/s</source>
        <translation>Bandgeschwindigkeit auf {} m/s setzen</translation>
    </message>
    <message>
        <source>Share of contact width</source>
        <translation>Anteil der Kontaktbreite</translation>
    </message>
    <message>
        <source>Share that goes at first</source>
        <translation>Anfangs verlorener Anteil</translation>
    </message>
    <message>
        <source>Share that stays</source>
        <translation>Bleibender Anteil</translation>
    </message>
    <message>
        <source>Shore A</source>
        <translation>Shore A</translation>
    </message>
    <message>
        <source>Show</source>
        <translation>Anzeigen</translation>
    </message>
    <message>
        <source>Show result</source>
        <translation>Ergebnis zeigen</translation>
    </message>
    <message>
        <source>Show the cell as it moves</source>
        <translation>Zelle in Bewegung zeigen</translation>
    </message>
    <message>
        <source>Simulate a job that runs on this belt first.</source>
        <translation>Zuerst einen Auftrag simulieren, der mit diesem Band läuft.</translation>
    </message>
    <message>
        <source>Simulation</source>
        <translation>Simulation</translation>
    </message>
    <message>
        <source>Smooth normals over</source>
        <translation>Normalen glätten über</translation>
    </message>
    <message>
        <source>Solid</source>
        <translation>Volumenkörper</translation>
    </message>
    <message>
        <source>Source</source>
        <translation>Quelltext</translation>
    </message>
    <message>
        <source>Spacing</source>
        <translation>Abstände</translation>
    </message>
    <message>
        <source>Stand still, in the base frame</source>
        <translation>Stehen still, im Basissystem</translation>
    </message>
    <message>
        <source>Standard colours</source>
        <translation>Standardfarben</translation>
    </message>
    <message>
        <source>Step-over (0: by contact)</source>
        <translation>Zeilenabstand (0: nach Kontakt)</translation>
    </message>
    <message>
        <source>Stiffness (0: of the rim)</source>
        <translation>Steifigkeit (0: des Kranzes)</translation>
    </message>
    <message>
        <source>Stock</source>
        <translation>Rohteil</translation>
    </message>
    <message>
        <source>Stock on the design faces</source>
        <translation>Aufmaß auf den Sollflächen</translation>
    </message>
    <message>
        <source>Surrogate</source>
        <translation>Ersatzmodell</translation>
    </message>
    <message>
        <source>Surrogate (trained)</source>
        <translation>Ersatzmodell (trainiert)</translation>
    </message>
    <message>
        <source>Take selected</source>
        <translation>Auswahl übernehmen</translation>
    </message>
    <message>
        <source>Tangential arc</source>
        <translation>Tangentialer Bogen</translation>
    </message>
    <message>
        <source>The lower limit lies above the upper limit.</source>
        <translation>Die untere Grenze liegt über der oberen.</translation>
    </message>
    <message>
        <source>The standard colours can be told apart with any colour vision</source>
        <translation>Die Standardfarben sind bei jeder Farbsehschwäche unterscheidbar</translation>
    </message>
    <message>
        <source>The unit does not fit: {}</source>
        <translation>Die Einheit passt nicht: {}</translation>
    </message>
    <message>
        <source>This is no number: {}</source>
        <translation>Das ist keine Zahl: {}</translation>
    </message>
    <message>
        <source>Threads</source>
        <translation>Threads</translation>
    </message>
    <message>
        <source>Threshold pressure</source>
        <translation>Schwellendruck</translation>
    </message>
    <message>
        <source>Time, s</source>
        <translation>Zeit, s</translation>
    </message>
    <message>
        <source>Timing</source>
        <translation>Zeitgesetz</translation>
    </message>
    <message>
        <source>Tolerance</source>
        <translation>Toleranz</translation>
    </message>
    <message>
        <source>Too much left</source>
        <translation>Zu viel übrig</translation>
    </message>
    <message>
        <source>Tool in hand</source>
        <translation>Werkzeug</translation>
    </message>
    <message>
        <source>Travel of the force control</source>
        <translation>Hub der Kraftregelung</translation>
    </message>
    <message>
        <source>Turn at most</source>
        <translation>Drehung höchstens</translation>
    </message>
    <message>
        <source>Two stages</source>
        <translation>Zweistufig</translation>
    </message>
    <message>
        <source>Uncertainty (1 sd)</source>
        <translation>Unsicherheit (1 σ)</translation>
    </message>
    <message>
        <source>Uncertainty, 95 %</source>
        <translation>Unsicherheit, 95 %</translation>
    </message>
    <message>
        <source>Uncertainty, mean</source>
        <translation>Unsicherheit, Mittel</translation>
    </message>
    <message>
        <source>Uniform allowance</source>
        <translation>Gleichmäßig</translation>
    </message>
    <message>
        <source>Unit</source>
        <translation>Einheit</translation>
    </message>
    <message>
        <source>Unit of the file</source>
        <translation>Einheit der Datei</translation>
    </message>
    <message>
        <source>Upper limit</source>
        <translation>Obere Grenze</translation>
    </message>
    <message>
        <source>Use in the job</source>
        <translation>Im Auftrag verwenden</translation>
    </message>
    <message>
        <source>Value (95 %)</source>
        <translation>Wert (95 %)</translation>
    </message>
    <message>
        <source>What it has done</source>
        <translation>Bisherige Leistung</translation>
    </message>
    <message>
        <source>Wheel</source>
        <translation>Scheibe</translation>
    </message>
    <message>
        <source>Wheel rim</source>
        <translation>Scheibenkranz</translation>
    </message>
    <message>
        <source>Width</source>
        <translation>Breite</translation>
    </message>
    <message>
        <source>With a lag</source>
        <translation>Mit Verzug</translation>
    </message>
    <message>
        <source>With acceleration and zones</source>
        <translation>Mit Beschleunigung und Überschleifzonen</translation>
    </message>
    <message>
        <source>Work</source>
        <translation>Arbeit</translation>
    </message>
    <message>
        <source>Work of one unit of wear, J</source>
        <translation>Arbeit je Verschleißeinheit, J</translation>
    </message>
    <message>
        <source>Work, J</source>
        <translation>Arbeit, J</translation>
    </message>
    <message>
        <source>Young&apos;s modulus</source>
        <translation>E-Modul</translation>
    </message>
    <message>
        <source>Young&apos;s modulus E in MPa from the Shore A hardness S:</source>
        <translation>E-Modul E in MPa aus der Shore-A-Härte S:</translation>
    </message>
    <message>
        <source>Zigzag</source>
        <translation>Zickzack</translation>
    </message>
    <message>
        <source>all</source>
        <translation>alle</translation>
    </message>
    <message>
        <source>all faces</source>
        <translation>alle Flächen</translation>
    </message>
    <message>
        <source>choose a preset…</source>
        <translation>Vorgabe wählen…</translation>
    </message>
    <message>
        <source>deviation, {}</source>
        <translation>Abweichung, {}</translation>
    </message>
    <message>
        <source>falls to 1/e in</source>
        <translation>fällt auf 1/e nach</translation>
    </message>
    <message>
        <source>fixed</source>
        <translation>fest</translation>
    </message>
    <message>
        <source>from hardness…</source>
        <translation>aus Härte…</translation>
    </message>
    <message>
        <source>linear</source>
        <translation>linear</translation>
    </message>
    <message>
        <source>needed only where the table gives a wear number</source>
        <translation>nur nötig, wenn die Tabelle eine Verschleißzahl angibt</translation>
    </message>
    <message>
        <source>needed only where the table gives rotations a minute</source>
        <translation>nur nötig, wenn die Tabelle Umdrehungen je Minute angibt</translation>
    </message>
    <message>
        <source>or file</source>
        <translation>oder Datei</translation>
    </message>
    <message>
        <source>out of date: simulate again</source>
        <translation>veraltet: erneut simulieren</translation>
    </message>
    <message>
        <source>pose </source>
        <translation>Pose </translation>
    </message>
    <message>
        <source>rapid</source>
        <translation>Eilgang</translation>
    </message>
    <message>
        <source>the job was removed while it ran</source>
        <translation>der Auftrag wurde während des Laufs gelöscht</translation>
    </message>
    <message>
        <source>u of each face</source>
        <translation>u jeder Fläche</translation>
    </message>
    <message>
        <source>uncertainty, {}</source>
        <translation>Unsicherheit, {}</translation>
    </message>
    <message>
        <source>v of each face</source>
        <translation>v jeder Fläche</translation>
    </message>
    <message>
        <source>{} grinds. Left out one by one, they are predicted with a median error of {:.1f} %, nine of ten within {:.0f} %.</source>
        <translation>{} Schliffe. Einzeln ausgelassen, werden sie mit einem Medianfehler von {:.1f} % vorhergesagt, neun von zehn innerhalb von {:.0f} %.</translation>
    </message>
    <message>
        <source>{} passes {:.2f} mm apart, {:.0f} mm; {} poses, {:.1f} s</source>
        <translation>{} Bahnen im Abstand von {:.2f} mm, {:.0f} mm; {} Posen, {:.1f} s</translation>
    </message>
    <message>
        <source>{} poses, {:.1f} mm, {:.1f} s ({})</source>
        <translation>{} Posen, {:.1f} mm, {:.1f} s ({})</translation>
    </message>
    <message>
        <source>{} uses the calibrated law.</source>
        <translation>{} verwendet das kalibrierte Gesetz.</translation>
    </message>
    <message>
        <source>Follow selected path</source>
        <translation>Gewählter Bahn folgen</translation>
    </message>
    <message>
        <source>Import result</source>
        <translation>Ergebnis einlesen</translation>
    </message>
    <message>
        <source>Job</source>
        <translation>Auftrag</translation>
    </message>
    <message>
        <source>Mesh</source>
        <translation>Netz</translation>
    </message>
    <message>
        <source>New grinding job</source>
        <translation>Neuer Schleifauftrag</translation>
    </message>
    <message>
        <source>Read programs again</source>
        <translation>Programme neu einlesen</translation>
    </message>
    <message>
        <source>Robot programs</source>
        <translation>Roboterprogramme</translation>
    </message>
    <message>
        <source>(none: reach is not checked)</source>
        <translation>(keiner: Erreichbarkeit ungeprüft)</translation>
    </message>
    <message>
        <source>Check the whole program</source>
        <translation>Ganzes Programm prüfen</translation>
    </message>
    <message>
        <source>Export robot program</source>
        <translation>Roboterprogramm schreiben</translation>
    </message>
    <message>
        <source>Joints: {}°</source>
        <translation>Achsen: {}°</translation>
    </message>
    <message>
        <source>Out of reach at this pose.</source>
        <translation>An dieser Pose nicht erreichbar.</translation>
    </message>
    <message>
        <source>Robot</source>
        <translation>Roboter</translation>
    </message>
    <message>
        <source>Robot in base</source>
        <translation>Roboter in Basis</translation>
    </message>
    <message>
        <source>The robot follows the whole program; nothing to report.</source>
        <translation>Der Roboter folgt dem ganzen Programm; nichts zu melden.</translation>
    </message>
    <message>
        <source>Tool in flange</source>
        <translation>Werkzeug im Flansch</translation>
    </message>
    <message>
        <source>own model (property RobotModel)</source>
        <translation>eigenes Modell (Eigenschaft RobotModel)</translation>
    </message>
    <message>
        <source>95 % uncertainty</source>
        <translation>95-%-Unsicherheit</translation>
    </message>
    <message>
        <source>Click the first point on the surface.</source>
        <translation>Den ersten Punkt auf der Fläche anklicken.</translation>
    </message>
    <message>
        <source>Click the second point.</source>
        <translation>Den zweiten Punkt anklicken.</translation>
    </message>
    <message>
        <source>Click two points on the surface in the 3D view</source>
        <translation>In der 3D-Ansicht zwei Punkte auf der Fläche anklicken</translation>
    </message>
    <message>
        <source>Colours end</source>
        <translation>Farben enden</translation>
    </message>
    <message>
        <source>Cross-section</source>
        <translation>Querschnitt</translation>
    </message>
    <message>
        <source>Cut</source>
        <translation>Schnitt</translation>
    </message>
    <message>
        <source>Export cross-section</source>
        <translation>Querschnitt schreiben</translation>
    </message>
    <message>
        <source>Export {}</source>
        <translation>{} schreiben</translation>
    </message>
    <message>
        <source>Face {}, {:.2f} mm along</source>
        <translation>Fläche {}, bei {:.2f} mm</translation>
    </message>
    <message>
        <source>Heights ×</source>
        <translation>Höhen ×</translation>
    </message>
    <message>
        <source>How much the heights are enlarged</source>
        <translation>Wie stark die Höhen vergrößert sind</translation>
    </message>
    <message>
        <source>Move cross-section</source>
        <translation>Querschnitt verschieben</translation>
    </message>
    <message>
        <source>Moving mass</source>
        <translation>Bewegte Masse</translation>
    </message>
    <message>
        <source>No section</source>
        <translation>Kein Schnitt</translation>
    </message>
    <message>
        <source>Own plane: Point and Normal in the property editor</source>
        <translation>Eigene Ebene: Point und Normal im Eigenschafteneditor</translation>
    </message>
    <message>
        <source>Percentile</source>
        <translation>Perzentil</translation>
    </message>
    <message>
        <source>Pick two points</source>
        <translation>Zwei Punkte wählen</translation>
    </message>
    <message>
        <source>Plot</source>
        <translation>Diagramm</translation>
    </message>
    <message>
        <source>Steps of each ramp</source>
        <translation>Stufen je Farbrampe</translation>
    </message>
    <message>
        <source>Times the limit</source>
        <translation>Vielfaches der Grenze</translation>
    </message>
    <message>
        <source>Unrolled: heights over the arc length. True shape: the outline in the plane, heights enlarged</source>
        <translation>Abgewickelt: Höhen über der Bogenlänge. Wahre Gestalt: der Umriss in der Ebene, Höhen vergrößert</translation>
    </message>
    <message>
        <source>Written: {}</source>
        <translation>Geschrieben: {}</translation>
    </message>
    <message>
        <source>across {}</source>
        <translation>quer zu {}</translation>
    </message>
    <message>
        <source>at</source>
        <translation>bei</translation>
    </message>
    <message>
        <source>automatic</source>
        <translation>automatisch</translation>
    </message>
    <message>
        <source>between two points</source>
        <translation>zwischen zwei Punkten</translation>
    </message>
    <message>
        <source>by hand</source>
        <translation>von Hand</translation>
    </message>
    <message>
        <source>by percentile</source>
        <translation>nach Perzentil</translation>
    </message>
    <message>
        <source>by tolerance</source>
        <translation>nach Toleranz</translation>
    </message>
    <message>
        <source>design</source>
        <translation>Soll</translation>
    </message>
    <message>
        <source>ground</source>
        <translation>geschliffen</translation>
    </message>
    <message>
        <source>in the plane, mm; heights ×{}</source>
        <translation>in der Ebene, mm; Höhen ×{}</translation>
    </message>
    <message>
        <source>own plane</source>
        <translation>eigene Ebene</translation>
    </message>
    <message>
        <source>stock</source>
        <translation>Rohteil</translation>
    </message>
    <message>
        <source>tolerance</source>
        <translation>Toleranz</translation>
    </message>
    <message>
        <source>true shape</source>
        <translation>wahre Gestalt</translation>
    </message>
    <message>
        <source>unrolled</source>
        <translation>abgewickelt</translation>
    </message>
    <message>
        <source>Back</source>
        <translation>Zurück</translation>
    </message>
    <message>
        <source>Belt grinding: manual</source>
        <translation>Bandschleifen: Handbuch</translation>
    </message>
    <message>
        <source>Click on the surface</source>
        <translation>Klick auf die Fläche</translation>
    </message>
    <message>
        <source>Contents</source>
        <translation>Inhalt</translation>
    </message>
    <message>
        <source>Shows the sample&apos;s deviation and face.</source>
        <translation>Zeigt Abweichung und Fläche des Abtastpunkts.</translation>
    </message>
    <message>
        <source>The belt-grinding workbench needs the Python package {name}, and this FreeCAD does not have it ({error}). On Debian: apt install python3-{name}. Elsewhere FreeCAD&apos;s Addon Manager can install it: Tools, Addon manager, Python packages.</source>
        <translation>Der Arbeitsbereich Bandschleifen braucht das Python-Paket {name}, und dieses FreeCAD hat es nicht ({error}). Unter Debian: apt install python3-{name}. Sonst kann es der Addon-Manager von FreeCAD installieren: Werkzeuge, Addon-Manager, Python-Pakete.</translation>
    </message>
    <message>
        <source>cut too deep</source>
        <translation>zu tief geschliffen</translation>
    </message>
    <message>
        <source>in tolerance</source>
        <translation>in Toleranz</translation>
    </message>
    <message>
        <source>no stock was met here</source>
        <translation>hier wurde kein Rohteil getroffen</translation>
    </message>
    <message>
        <source>of</source>
        <translation>von</translation>
    </message>
    <message>
        <source>removed</source>
        <translation>abgetragen</translation>
    </message>
    <message>
        <source>sample</source>
        <translation>Abtastpunkt</translation>
    </message>
    <message>
        <source>segment</source>
        <translation>Segment</translation>
    </message>
    <message>
        <source>too much left</source>
        <translation>zu viel übrig</translation>
    </message>
    <message>
        <source>, line {}</source>
        <translation>, Zeile {}</translation>
    </message>
    <message>
        <source>Cancelled.</source>
        <translation>Abgebrochen.</translation>
    </message>
    <message>
        <source>Contact area</source>
        <translation>Kontaktfläche</translation>
    </message>
    <message>
        <source>Next event</source>
        <translation>Nächstes Ereignis</translation>
    </message>
    <message>
        <source>Out of date: an input has changed since; simulate again.</source>
        <translation>Veraltet: Eine Eingabe hat sich seitdem geändert; erneut simulieren.</translation>
    </message>
    <message>
        <source>Peak pressure</source>
        <translation>Höchster Druck</translation>
    </message>
    <message>
        <source>Play or pause</source>
        <translation>Abspielen oder anhalten</translation>
    </message>
    <message>
        <source>Playback</source>
        <translation>Wiedergabe</translation>
    </message>
    <message>
        <source>Previous event</source>
        <translation>Voriges Ereignis</translation>
    </message>
    <message>
        <source>Removal rate</source>
        <translation>Abtragsrate</translation>
    </message>
    <message>
        <source>Rows</source>
        <translation>Zeilen</translation>
    </message>
    <message>
        <source>Simulate with recording</source>
        <translation>Mit Aufzeichnung simulieren</translation>
    </message>
    <message>
        <source>Speed, as a multiple of the real time</source>
        <translation>Geschwindigkeit, als Vielfaches der Echtzeit</translation>
    </message>
    <message>
        <source>There is no result yet.</source>
        <translation>Es gibt noch kein Ergebnis.</translation>
    </message>
    <message>
        <source>This result was not recorded.</source>
        <translation>Dieses Ergebnis wurde nicht aufgezeichnet.</translation>
    </message>
    <message>
        <source>{:.2f} of {:.2f} s · {}, pose {}</source>
        <translation>{:.2f} von {:.2f} s · {}, Pose {}</translation>
    </message>
    <message>
        <source>{:.2f} s, pose {}</source>
        <translation>{:.2f} s, Pose {}</translation>
    </message>
    <message>
        <source>Show the plot</source>
        <translation>Diagramm zeigen</translation>
    </message>
    <message>
        <source>arc length, mm; upright: height above the design, {}</source>
        <translation>Bogenlänge, mm; senkrecht: Höhe über dem Soll, {}</translation>
    </message>
    <message>
        <source>deviation {}</source>
        <translation>Abweichung {}</translation>
    </message>
    <message>
        <source>stock {}, removed {}</source>
        <translation>Aufmaß {}, abgetragen {}</translation>
    </message>
    <message>
        <source>uncertainty (1 sd) {}</source>
        <translation>Unsicherheit (1 σ) {}</translation>
    </message>
    <message>
        <source>{:.2f} mm long, {:.1f} % in tolerance
deviation {} to {}, mean {}
removed {} on the mean</source>
        <translation>{:.2f} mm lang, {:.1f} % in Toleranz
Abweichung {} bis {}, Mittel {}
im Mittel {} abgetragen</translation>
    </message>
    <message>
        <source>5 % of the area lie below</source>
        <translation>5 % der Fläche liegen darunter</translation>
    </message>
    <message>
        <source>95 % of the area lie below</source>
        <translation>95 % der Fläche liegen darunter</translation>
    </message>
    <message>
        <source>An input has changed since</source>
        <translation>Eine Eingabe hat sich seither geändert</translation>
    </message>
    <message>
        <source>An input has changed since the simulation: figures and pictures are of the old one, the settings and the job file of the new one.</source>
        <translation>Seit der Simulation hat sich eine Eingabe geändert: Werte und Bilder sind vom alten Stand, die Einstellungen und die Job-Datei vom neuen.</translation>
    </message>
    <message>
        <source>Are the spacing of the samples, the steps and the contact&apos;s cells fine enough? The job is simulated at twice, once and half of them. That takes about ten times as long as one simulation.</source>
        <translation>Sind der Abstand der Stützpunkte, die Schritte und die Zellen des Kontakts fein genug? Der Job wird mit doppelten, einfachen und halben simuliert. Das dauert etwa zehnmal so lange wie eine Simulation.</translation>
    </message>
    <message>
        <source>Area cut too deep</source>
        <translation>Fläche zu tief geschliffen</translation>
    </message>
    <message>
        <source>Area in tolerance</source>
        <translation>Fläche in Toleranz</translation>
    </message>
    <message>
        <source>Area with too much left</source>
        <translation>Fläche, auf der zu viel übrig ist</translation>
    </message>
    <message>
        <source>Check</source>
        <translation>Prüfen</translation>
    </message>
    <message>
        <source>Check settings</source>
        <translation>Einstellungen prüfen</translation>
    </message>
    <message>
        <source>Checking the settings, {}</source>
        <translation>Die Einstellungen werden geprüft, {}</translation>
    </message>
    <message>
        <source>Coefficient K</source>
        <translation>Koeffizient K</translation>
    </message>
    <message>
        <source>Contacts not converged</source>
        <translation>Nicht konvergierte Kontakte</translation>
    </message>
    <message>
        <source>Cut left in the belt</source>
        <translation>Verbliebene Schärfe des Bandes</translation>
    </message>
    <message>
        <source>Deviation from the design</source>
        <translation>Abweichung vom Entwurf</translation>
    </message>
    <message>
        <source>Error</source>
        <translation>Fehler</translation>
    </message>
    <message>
        <source>Error of a depth because of the settings</source>
        <translation>Fehler einer Tiefe wegen der Einstellungen</translation>
    </message>
    <message>
        <source>Events</source>
        <translation>Ereignisse</translation>
    </message>
    <message>
        <source>Figure</source>
        <translation>Wert</translation>
    </message>
    <message>
        <source>Figures</source>
        <translation>Werte</translation>
    </message>
    <message>
        <source>Ground area</source>
        <translation>Geschliffene Fläche</translation>
    </message>
    <message>
        <source>Half of the area lies below</source>
        <translation>Die halbe Fläche liegt darunter</translation>
    </message>
    <message>
        <source>Highest deviation</source>
        <translation>Höchste Abweichung</translation>
    </message>
    <message>
        <source>How sure that is</source>
        <translation>Wie sicher das ist</translation>
    </message>
    <message>
        <source>Law of removal</source>
        <translation>Abtragsgesetz</translation>
    </message>
    <message>
        <source>Lowest deviation</source>
        <translation>Tiefste Abweichung</translation>
    </message>
    <message>
        <source>Not checked yet.</source>
        <translation>Noch nicht geprüft.</translation>
    </message>
    <message>
        <source>Outside of the law&apos;s range</source>
        <translation>Außerhalb des Bereichs des Gesetzes</translation>
    </message>
    <message>
        <source>Overshoot told from</source>
        <translation>Überschwingen ab</translation>
    </message>
    <message>
        <source>Report</source>
        <translation>Bericht</translation>
    </message>
    <message>
        <source>Samples</source>
        <translation>Stützpunkte</translation>
    </message>
    <message>
        <source>Samples with stock below the design</source>
        <translation>Stützpunkte mit Rohteil unter dem Entwurf</translation>
    </message>
    <message>
        <source>Samples without stock</source>
        <translation>Stützpunkte ohne Rohteil</translation>
    </message>
    <message>
        <source>Settings</source>
        <translation>Einstellungen</translation>
    </message>
    <message>
        <source>Spacing of the samples</source>
        <translation>Abstand der Stützpunkte</translation>
    </message>
    <message>
        <source>Speed limit (0: none)</source>
        <translation>Tempogrenze (0: keine)</translation>
    </message>
    <message>
        <source>Standard deviation, mean; 0: not known</source>
        <translation>Standardabweichung, Mittel; 0: nicht bekannt</translation>
    </message>
    <message>
        <source>Step of the simulation</source>
        <translation>Schritt der Simulation</translation>
    </message>
    <message>
        <source>Steps</source>
        <translation>Schritte</translation>
    </message>
    <message>
        <source>Stock before</source>
        <translation>Aufmaß vorher</translation>
    </message>
    <message>
        <source>The law is calibrated</source>
        <translation>Das Gesetz ist kalibriert</translation>
    </message>
    <message>
        <source>The settings are fine enough</source>
        <translation>Die Einstellungen sind fein genug</translation>
    </message>
    <message>
        <source>The stock is a mesh in the FreeCAD document; the job file below does not hold it. Export the job to repeat it.</source>
        <translation>Das Rohteil ist ein Netz im FreeCAD-Dokument; die Job-Datei unten enthält es nicht. Zum Wiederholen den Job exportieren.</translation>
    </message>
    <message>
        <source>Time of the robot</source>
        <translation>Zeit des Roboters</translation>
    </message>
    <message>
        <source>Tolerance, lower limit</source>
        <translation>Toleranz, untere Grenze</translation>
    </message>
    <message>
        <source>Tolerance, upper limit</source>
        <translation>Toleranz, obere Grenze</translation>
    </message>
    <message>
        <source>Warnings of the input</source>
        <translation>Warnungen zu den Eingaben</translation>
    </message>
    <message>
        <source>Wheel radius</source>
        <translation>Radius der Scheibe</translation>
    </message>
    <message>
        <source>Wheel width</source>
        <translation>Breite der Scheibe</translation>
    </message>
    <message>
        <source>Writing the report</source>
        <translation>Der Bericht wird geschrieben</translation>
    </message>
    <message>
        <source>{}: {}, off by up to {}, allowed {}</source>
        <translation>{}: {}, falsch um bis zu {}, erlaubt {}</translation>
    </message>
    <message>
        <source>Area within the zones&apos; limits</source>
        <translation>Fläche in den Grenzen der Zonen</translation>
    </message>
    <message>
        <source>Beyond its limit</source>
        <translation>Über der Grenze um</translation>
    </message>
    <message>
        <source>Faces out of tolerance</source>
        <translation>Flächen außer Toleranz</translation>
    </message>
    <message>
        <source>Largest place out</source>
        <translation>Größte Stelle außerhalb</translation>
    </message>
    <message>
        <source>Left above the design</source>
        <translation>Über dem Entwurf geblieben</translation>
    </message>
    <message>
        <source>Missing below the design</source>
        <translation>Fehlt unter dem Entwurf</translation>
    </message>
    <message>
        <source>Motions not resolved; -1: not known</source>
        <translation>Nicht aufgelöste Bewegungen; -1: nicht bekannt</translation>
    </message>
    <message>
        <source>Never touched</source>
        <translation>Nie berührt</translation>
    </message>
    <message>
        <source>Verdict</source>
        <translation>Urteil</translation>
    </message>
    <message>
        <source>Verdict by zones</source>
        <translation>Urteil nach Zonen</translation>
    </message>
    <message>
        <source>Waves across the feed</source>
        <translation>Wellen quer zum Vorschub</translation>
    </message>
    <message>
        <source>Waves along the feed</source>
        <translation>Wellen längs zum Vorschub</translation>
    </message>
    <message>
        <source>Worst deviation</source>
        <translation>Schlimmste Abweichung</translation>
    </message>
    <message>
        <source>Zones out of tolerance</source>
        <translation>Zonen außer Toleranz</translation>
    </message>
    <message>
        <source>Add</source>
        <translation>Hinzufügen</translation>
    </message>
    <message>
        <source>Area, mm²</source>
        <translation>Fläche, mm²</translation>
    </message>
    <message>
        <source>Beyond, mm</source>
        <translation>Darüber hinaus, mm</translation>
    </message>
    <message>
        <source>Cannot be told: not everything was inspected</source>
        <translation>Nicht zu sagen: nicht alles wurde geprüft</translation>
    </message>
    <message>
        <source>Choose a zone in the table first.</source>
        <translation>Wählen Sie zuerst eine Zone in der Tabelle.</translation>
    </message>
    <message>
        <source>Click: show the wheel and the line. Double click: open the program</source>
        <translation>Klick: Scheibe und Zeile zeigen. Doppelklick: Programm öffnen</translation>
    </message>
    <message>
        <source>Clusters out of tolerance</source>
        <translation>Zusammenhängende Stellen außer Toleranz</translation>
    </message>
    <message>
        <source>Deep, %</source>
        <translation>Zu tief, %</translation>
    </message>
    <message>
        <source>Depth, mm</source>
        <translation>Tiefe, mm</translation>
    </message>
    <message>
        <source>Down</source>
        <translation>Abwärts</translation>
    </message>
    <message>
        <source>Each zone has limits of its own; where several hold a place, the last one counts. Without faces a zone holds all; with an edge radius only convex edges with a smaller radius. Lengths in mm; what is left empty is not inspected.</source>
        <translation>Jede Zone hat eigene Grenzen; wo mehrere einen Ort enthalten, gilt die letzte. Ohne Flächen enthält eine Zone alles, mit Kantenradius nur konvexe Kanten mit kleinerem Radius. Längen in mm; was leer bleibt, wird nicht geprüft.</translation>
    </message>
    <message>
        <source>Edge radius</source>
        <translation>Kantenradius</translation>
    </message>
    <message>
        <source>In doubt</source>
        <translation>Zweifelhaft</translation>
    </message>
    <message>
        <source>In, %</source>
        <translation>In Toleranz, %</translation>
    </message>
    <message>
        <source>Largest first. Click: go there in the 3D view</source>
        <translation>Größte zuerst. Klick: in der 3D-Ansicht dorthin</translation>
    </message>
    <message>
        <source>Lower</source>
        <translation>Untere</translation>
    </message>
    <message>
        <source>Lower limit of the thickness against the design&apos;s</source>
        <translation>Untere Grenze der Dicke gegen die des Entwurfs</translation>
    </message>
    <message>
        <source>Motions of the cluster</source>
        <translation>Bewegungen an dieser Stelle</translation>
    </message>
    <message>
        <source>Never touched: {:,.1f} of {:,.1f} mm²</source>
        <translation>Nie berührt: {:,.1f} von {:,.1f} mm²</translation>
    </message>
    <message>
        <source>Not in tolerance</source>
        <translation>Nicht in Toleranz</translation>
    </message>
    <message>
        <source>Not in tolerance: {} of {} faces</source>
        <translation>Nicht in Toleranz: {} von {} Flächen</translation>
    </message>
    <message>
        <source>Numbers of faces; empty: all</source>
        <translation>Nummern von Flächen; leer: alle</translation>
    </message>
    <message>
        <source>Only convex edges with a smaller radius; empty: all</source>
        <translation>Nur konvexe Kanten mit kleinerem Radius; leer: alles</translation>
    </message>
    <message>
        <source>Share, %</source>
        <translation>Anteil, %</translation>
    </message>
    <message>
        <source>Show verdict</source>
        <translation>Urteil zeigen</translation>
    </message>
    <message>
        <source>Size, mm</source>
        <translation>Größe, mm</translation>
    </message>
    <message>
        <source>Take selected faces</source>
        <translation>Gewählte Flächen nehmen</translation>
    </message>
    <message>
        <source>Thicker by</source>
        <translation>Dicker um</translation>
    </message>
    <message>
        <source>Thinner by</source>
        <translation>Dünner um</translation>
    </message>
    <message>
        <source>Tolerance zones</source>
        <translation>Toleranzzonen</translation>
    </message>
    <message>
        <source>Up</source>
        <translation>Aufwärts</translation>
    </message>
    <message>
        <source>Upper</source>
        <translation>Obere</translation>
    </message>
    <message>
        <source>Upper limit of the thickness against the design&apos;s</source>
        <translation>Obere Grenze der Dicke gegen die des Entwurfs</translation>
    </message>
    <message>
        <source>Waves Wt, mm</source>
        <translation>Welligkeit Wt, mm</translation>
    </message>
    <message>
        <source>What</source>
        <translation>Was</translation>
    </message>
    <message>
        <source>Where</source>
        <translation>Wo</translation>
    </message>
    <message>
        <source>Worst, mm</source>
        <translation>Schlimmste, mm</translation>
    </message>
    <message>
        <source>Zone</source>
        <translation>Zone</translation>
    </message>
    <message>
        <source>Zones and faces</source>
        <translation>Zonen und Flächen</translation>
    </message>
    <message>
        <source>Zones: {}. Elsewhere {} to {} mm.</source>
        <translation>Zonen: {}. Sonst {} bis {} mm.</translation>
    </message>
    <message>
        <source>contacts not converged</source>
        <translation>Kontakte nicht konvergiert</translation>
    </message>
    <message>
        <source>elsewhere</source>
        <translation>sonst</translation>
    </message>
    <message>
        <source>events outside of the law&apos;s range</source>
        <translation>Ereignisse außerhalb des Bereichs des Gesetzes</translation>
    </message>
    <message>
        <source>fail</source>
        <translation>nicht bestanden</translation>
    </message>
    <message>
        <source>missed rays</source>
        <translation>verfehlte Strahlen</translation>
    </message>
    <message>
        <source>never touched</source>
        <translation>nie berührt</translation>
    </message>
    <message>
        <source>pass</source>
        <translation>bestanden</translation>
    </message>
    <message>
        <source>places of the programs not resolved</source>
        <translation>Stellen der Programme nicht aufgelöst</translation>
    </message>
    <message>
        <source>samples with defective stock</source>
        <translation>Punkte mit fehlendem Aufmaß</translation>
    </message>
    <message>
        <source>unknown</source>
        <translation>unbekannt</translation>
    </message>
    <message>
        <source>{}: thickness</source>
        <translation>{}: Dicke</translation>
    </message>
    <message>
        <source>All events ({})</source>
        <translation>Alle Ereignisse ({})</translation>
    </message>
    <message>
        <source>Any</source>
        <translation>Alle</translation>
    </message>
    <message>
        <source>Collisions</source>
        <translation>Kollisionen</translation>
    </message>
    <message>
        <source>Errors</source>
        <translation>Fehler</translation>
    </message>
    <message>
        <source>From {:.2f} s, for {:.2f} s; pose {}</source>
        <translation>Ab {:.2f} s, für {:.2f} s; Pose {}</translation>
    </message>
    <message>
        <source>Look for collisions</source>
        <translation>Kollisionen suchen</translation>
    </message>
    <message>
        <source>Note</source>
        <translation>Hinweis</translation>
    </message>
    <message>
        <source>Notes</source>
        <translation>Hinweise</translation>
    </message>
    <message>
        <source>Pressure limit (0: none)</source>
        <translation>Druckgrenze (0: keine)</translation>
    </message>
    <message>
        <source>Try:</source>
        <translation>Versuchen:</translation>
    </message>
    <message>
        <source>Warning</source>
        <translation>Warnung</translation>
    </message>
    <message>
        <source>Warnings</source>
        <translation>Warnungen</translation>
    </message>
    <message>
        <source>of the pairs of points, the nearest: the rest, as a table or a clamp, does not count</source>
        <translation>von den Punktpaaren die nächsten: Der Rest, etwa ein Tisch oder eine Spannpratze, zählt nicht</translation>
    </message>
    <message>
        <source>what stays as it starts: translations along the part&apos;s axes, rotations about them</source>
        <translation>was bleibt, wie es beginnt: Verschiebungen längs der Achsen des Teils, Drehungen um sie</translation>
    </message>
    <message>
        <source>The limits have changed since the simulation: the verdict is by the new ones, the events of gouges by the old.</source>
        <translation>Die Grenzen sind seit der Simulation andere: Das Urteil gilt nach den neuen, zu tiefe Stellen sind nach den alten gemeldet.</translation>
    </message>
    <message>
        <source>The limits have changed since: gouges are told by the old ones.</source>
        <translation>Die Grenzen sind seither andere: Zu tiefe Stellen sind nach den alten gemeldet.</translation>
    </message>
    <message>
        <source>good</source>
        <translation>gut</translation>
    </message>
    <message>
        <source>{} is there already. Replace it?</source>
        <translation>{} ist schon da. Ersetzen?</translation>
    </message>
    <message>
        <source>To have the program set them, enter their names or numbers on the controller in the path&apos;s properties ProgramBase and ProgramTool.</source>
        <translation>Damit das Programm sie setzt, ihre Namen oder Nummern auf der Steuerung in den Eigenschaften ProgramBase und ProgramTool der Roboterbahn eintragen.</translation>
    </message>
    <message>
        <source>Nearest to the arm, whose thickness is estimated unless LinkRadii says it: {}, {:.0f} mm from {}</source>
        <translation>Dem Arm, dessen Dicke geschätzt ist, wenn LinkRadii sie nicht angibt, am nächsten: {}, {:.0f} mm von {}</translation>
    </message>
    <message>
        <source>What its arm runs into was not looked at: {}</source>
        <translation>Womit sein Arm zusammenstößt, wurde nicht geprüft: {}</translation>
    </message>
    <message>
        <source>looking for collisions is turned off</source>
        <translation>die Suche nach Kollisionen ist ausgeschaltet</translation>
    </message>
    <message>
        <source>Chosen from the part: wheel, force, passes, samples, and the feed at which the allowance comes off on the mean, if K is right: K is not known before the belt is calibrated.</source>
        <translation>Nach dem Bauteil gewählt: Scheibe, Kraft, Bahnen, Abtastung und der Vorschub, bei dem das Aufmaß im Mittel abgeht, wenn K stimmt: K ist erst bekannt, wenn das Band kalibriert ist.</translation>
    </message>
    <message>
        <source>It takes the place of the passes that were proposed: {}</source>
        <translation>Es ersetzt die vorgeschlagenen Bahnen: {}</translation>
    </message>
    <message>
        <source>Lay passes on the faces</source>
        <translation>Bahnen auf die Flächen legen</translation>
    </message>
    <message>
        <source>Looking at the part for first values</source>
        <translation>Das Bauteil wird nach ersten Werten untersucht</translation>
    </message>
    <message>
        <source>Off: the job gets a robot program of yours</source>
        <translation>Aus: Der Auftrag bekommt ein eigenes Roboterprogramm</translation>
    </message>
    <message>
        <source>Removal and belt wear</source>
        <translation>Abtrag und Bandverschleiß</translation>
    </message>
    <message>
        <source>So many samples take some {:.1f} GB, and minutes; {:.2g} mm would be {:,.0f}.</source>
        <translation>So viele Abtastpunkte brauchen rund {:.1f} GB und Minuten; {:.2g} mm wären {:,.0f}.</translation>
    </message>
    <message>
        <source>{:.2f} % in tolerance, {:.2f} % too much left, {:.2f} % cut too deep</source>
        <translation>{:.2f} % in Toleranz, {:.2f} % zu viel übrig, {:.2f} % zu tief geschliffen</translation>
    </message>
    <message>
        <source>Faces: {}. Area: {:,.0f} mm².</source>
        <translation>Flächen: {}. Inhalt: {:,.0f} mm².</translation>
    </message>
    <message>
        <source>Keep a marker</source>
        <translation>Marke behalten</translation>
    </message>
    <message>
        <source>about {:,.0f} samples</source>
        <translation>etwa {:,.0f} Abtastpunkte</translation>
    </message>
    <message>
        <source>Keep fixed</source>
        <translation>Fest lassen</translation>
    </message>
    <message>
        <source>Pairs used</source>
        <translation>Genutzte Paare</translation>
    </message>
    <message>
        <source>Start file</source>
        <translation>Startdatei</translation>
    </message>
    <message>
        <source>Wheel&apos;s body inset</source>
        <translation>Körper zurückgesetzt um</translation>
    </message>
    <message>
        <source>as Shift+click does</source>
        <translation>wie Umschalt+Klick</translation>
    </message>
    <message>
        <source>⚠ Changed since the values were chosen from the part: the feed need not take the allowance off on the mean any more.</source>
        <translation>⚠ Geändert, seit die Werte nach dem Bauteil gewählt wurden: Der Vorschub nimmt das Aufmaß im Mittel vielleicht nicht mehr ab.</translation>
    </message>
    <message>
        <source>A CSV, a line a grind. Columns: {}; {} or {}; {} or {}, {}; {}; {} or {}; and, if the belt wears, {}.</source>
        <translation>Eine CSV-Datei, eine Zeile je Schliff. Spalten: {}; {} oder {}; {} oder {}, {}; {}; {} oder {}; und, wenn sich das Band abnutzt, {}.</translation>
    </message>
    <message>
        <source>Ground part</source>
        <translation>Geschliffenes Teil</translation>
    </message>
    <message>
        <source>Left, %</source>
        <translation>Übrig, %</translation>
    </message>
    <message>
        <source>Making the mesh of the ground part</source>
        <translation>Das Netz des geschliffenen Teils wird gemacht</translation>
    </message>
    <message>
        <source>Mass and damping</source>
        <translation>Masse, Dämpfung</translation>
    </message>
    <message>
        <source>Raster</source>
        <translation>Raster</translation>
    </message>
    <message>
        <source>Removed {:,.1f} mm³, too much left {:,.1f} mm³, cut too deep {:,.1f} mm³</source>
        <translation>Abgetragen {:,.1f} mm³, zu viel übrig {:,.1f} mm³, zu tief geschliffen {:,.1f} mm³</translation>
    </message>
    <message>
        <source>Save an example</source>
        <translation>Beispiel speichern</translation>
    </message>
    <message>
        <source>Save an example...</source>
        <translation>Beispiel speichern ...</translation>
    </message>
    <message>
        <source>Choose loose faces in the list; faces of a solid look out of it already.</source>
        <translation>Lose Flächen in der Liste wählen; die eines Volumenkörpers zeigen schon nach außen.</translation>
    </message>
    <message>
        <source>Flip side</source>
        <translation>Seite umkehren</translation>
    </message>
    <message>
        <source>Turns loose faces to be ground from their other side</source>
        <translation>Lässt lose Flächen von ihrer anderen Seite her schleifen</translation>
    </message>
    <message>
        <source>flipped</source>
        <translation>umgekehrt</translation>
    </message>
    <message>
        <source>chosen by faces, wheel and tolerance</source>
        <translation>gewählt nach Flächen, Scheibe und Toleranz</translation>
    </message>
    <message>
        <source>spacing chosen</source>
        <translation>Abstand gewählt</translation>
    </message>
    <message>
        <source>Belt&apos;s travel</source>
        <translation>Laufrichtung des Bandes</translation>
    </message>
    <message>
        <source>Direction of travel</source>
        <translation>Richtung</translation>
    </message>
    <message>
        <source>along the pass</source>
        <translation>längs der Bahn</translation>
    </message>
    <message>
        <source>held along a pass</source>
        <translation>über eine Bahn gehalten</translation>
    </message>
    <message>
        <source>in a fixed direction</source>
        <translation>in fester Richtung</translation>
    </message>
    <message>
        <source>Entry and exit</source>
        <translation>Ein- und Auslauf</translation>
    </message>
    <message>
        <source>Entry feed (0: feed)</source>
        <translation>Einlaufvorschub (0: Vorschub)</translation>
    </message>
    <message>
        <source>Force grows over (0: by contact)</source>
        <translation>Kraftanstieg (0: nach Kontakt)</translation>
    </message>
    <message>
        <source>Force is met</source>
        <translation>Kraft erreicht</translation>
    </message>
    <message>
        <source>From outside, force grows</source>
        <translation>Von außen, Kraft wächst</translation>
    </message>
    <message>
        <source>Full force at once</source>
        <translation>Volle Kraft sofort</translation>
    </message>
    <message>
        <source>On the border, force grows</source>
        <translation>Auf dem Rand, Kraft wächst</translation>
    </message>
    <message>
        <source>Outside by (0: by contact)</source>
        <translation>Außerhalb um (0: nach Kontakt)</translation>
    </message>
    <message>
        <source>Removed while plunging: {:.1f} %</source>
        <translation>Beim Eintauchen abgetragen: {:.1f} %</translation>
    </message>
    <message>
        <source>Share of force at touch</source>
        <translation>Kraftanteil beim Aufsetzen</translation>
    </message>
    <message>
        <source>Turn in contact: {:.1f}° from pose to pose, {:.1f}° per mm</source>
        <translation>Drehung im Kontakt: {:.1f}° von Pose zu Pose, {:.1f}° je mm</translation>
    </message>
    <message>
        <source>Turn per mm at most (degrees)</source>
        <translation>Drehung je mm (Grad)</translation>
    </message>
    <message>
        <source>Each place in a line of its own</source>
        <translation>Jede Stelle in eigener Zeile</translation>
    </message>
    <message>
        <source>Contact width</source>
        <translation>Kontaktbreite</translation>
    </message>
    <message>
        <source>Leave out</source>
        <translation>Auslassen</translation>
    </message>
    <message>
        <source>On a cylinder</source>
        <translation>Auf einem Zylinder</translation>
    </message>
    <message>
        <source>Only warn</source>
        <translation>Nur warnen</translation>
    </message>
    <message>
        <source>Rim in the part at most</source>
        <translation>Belag im Teil bis zu</translation>
    </message>
    <message>
        <source>Solved along the passes</source>
        <translation>Längs der Bahnen gelöst</translation>
    </message>
    <message>
        <source>Tilt at most</source>
        <translation>Neigung höchstens</translation>
    </message>
    <message>
        <source>Tilt, else leave out</source>
        <translation>Neigen, sonst auslassen</translation>
    </message>
    <message>
        <source>Wheel in the part</source>
        <translation>Scheibe im Teil</translation>
    </message>
    <message>
        <source>without a pass</source>
        <translation>ohne Bahn</translation>
    </message>
    <message>
        <source>Comparing ways of the passes</source>
        <translation>Wege der Bahnen werden verglichen</translation>
    </message>
    <message>
        <source>Find the best way</source>
        <translation>Besten Weg suchen</translation>
    </message>
    <message>
        <source>Everywhere</source>
        <translation>Überall</translation>
    </message>
    <message>
        <source>Helix</source>
        <translation>Wendel</translation>
    </message>
    <message>
        <source>Lays passes on the chosen cluster, where too much is left</source>
        <translation>Legt Bahnen auf das gewählte Cluster, wo zu viel steht</translation>
    </message>
    <message>
        <source>Only what is left</source>
        <translation>Nur was noch steht</translation>
    </message>
    <message>
        <source>Raster path here...</source>
        <translation>Rasterbahn hier...</translation>
    </message>
    <message>
        <source>Region</source>
        <translation>Gebiet</translation>
    </message>
    <message>
        <source>Regulator&apos;s lag</source>
        <translation>Verzug des Reglers</translation>
    </message>
    <message>
        <source>Round the faces</source>
        <translation>Rund um die Flächen</translation>
    </message>
    <message>
        <source>everywhere on the faces</source>
        <translation>überall auf den Flächen</translation>
    </message>
    <message>
        <source>near {} points within {:.0f} mm</source>
        <translation>bei {} Punkten innerhalb von {:.0f} mm</translation>
    </message>
    <message>
        <source>Apply</source>
        <translation>Übernehmen</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>Name</translation>
    </message>
    <message>
        <source>Value</source>
        <translation>Wert</translation>
    </message>
    <message>
        <source>Values ({} missing)</source>
        <translation>Werte ({} fehlen)</translation>
    </message>
    <message>
        <source>What only the controller knows. Frames: x y z in mm, a b c in degrees, Rz(a) Ry(b) Rx(c), with blanks between them. What is left empty is not known.</source>
        <translation>Was nur die Steuerung weiß. Frames: x y z in mm, a b c in Grad, Rz(a) Ry(b) Rx(c), mit Leerzeichen dazwischen. Was leer bleibt, ist nicht bekannt.</translation>
    </message>
    <message>
        <source>base</source>
        <translation>Basis</translation>
    </message>
    <message>
        <source>frame</source>
        <translation>Frame</translation>
    </message>
    <message>
        <source>number</source>
        <translation>Zahl</translation>
    </message>
    <message>
        <source>tool</source>
        <translation>Werkzeug</translation>
    </message>
    <message>
        <source>Apply and save</source>
        <translation>Übernehmen und sichern</translation>
    </message>
    <message>
        <source>Writes NAME.values.json beside the program, too</source>
        <translation>Schreibt auch NAME.values.json neben das Programm</translation>
    </message>
    <message>
        <source>Only what other passes leave</source>
        <translation>Nur was andere Bahnen lassen</translation>
    </message>
    <message>
        <source>Apply plan</source>
        <translation>Plan anwenden</translation>
    </message>
    <message>
        <source>Before</source>
        <translation>Vorher</translation>
    </message>
    <message>
        <source>Both simulated at half the spacing and step.</source>
        <translation>Beides mit halbem Abstand und Schritt simuliert.</translation>
    </message>
    <message>
        <source>Bounces told within</source>
        <translation>Abprallen binnen</translation>
    </message>
    <message>
        <source>Check at half the spacing</source>
        <translation>Bei halbem Abstand prüfen</translation>
    </message>
    <message>
        <source>Click for a larger picture</source>
        <translation>Für ein größeres Bild klicken</translation>
    </message>
    <message>
        <source>Different feeds</source>
        <translation>Stufen</translation>
    </message>
    <message>
        <source>Folder for the planned programs</source>
        <translation>Ordner für die geplanten Programme</translation>
    </message>
    <message>
        <source>Greatest feed</source>
        <translation>Größter Vorschub</translation>
    </message>
    <message>
        <source>Greatest force</source>
        <translation>Größte Kraft</translation>
    </message>
    <message>
        <source>In tol.</source>
        <translation>In Tol.</translation>
    </message>
    <message>
        <source>Least feed</source>
        <translation>Kleinster Vorschub</translation>
    </message>
    <message>
        <source>Least force</source>
        <translation>Kleinste Kraft</translation>
    </message>
    <message>
        <source>Least gain of a round</source>
        <translation>Gewinn, mindestens</translation>
    </message>
    <message>
        <source>Leave these as they are</source>
        <translation>Diese so lassen</translation>
    </message>
    <message>
        <source>Limits</source>
        <translation>Grenzen</translation>
    </message>
    <message>
        <source>Made here, so apply the plan and export the program: {}</source>
        <translation>Hier erzeugt; wenden Sie den Plan an und exportieren Sie das Programm: {}</translation>
    </message>
    <message>
        <source>Most change a round</source>
        <translation>Größte Änderung</translation>
    </message>
    <message>
        <source>Motions that stay</source>
        <translation>Was bleibt</translation>
    </message>
    <message>
        <source>Nothing better was found: the feeds stay as they are.</source>
        <translation>Nichts Besseres gefunden: die Vorschübe bleiben, wie sie sind.</translation>
    </message>
    <message>
        <source>Of the area, what stays out of tolerance:</source>
        <translation>Von der Fläche bleibt außer Toleranz:</translation>
    </message>
    <message>
        <source>Out of date: an input has changed since; plan again.</source>
        <translation>Veraltet: eine Eingabe hat sich seither geändert; planen Sie neu.</translation>
    </message>
    <message>
        <source>Plan</source>
        <translation>Plan</translation>
    </message>
    <message>
        <source>Planned</source>
        <translation>Geplant</translation>
    </message>
    <message>
        <source>Planning, {}</source>
        <translation>Planung, {}</translation>
    </message>
    <message>
        <source>Process time, s</source>
        <translation>Prozesszeit, s</translation>
    </message>
    <message>
        <source>RMS, {}</source>
        <translation>RMS, {}</translation>
    </message>
    <message>
        <source>Round</source>
        <translation>Runde</translation>
    </message>
    <message>
        <source>Rounds</source>
        <translation>Runden</translation>
    </message>
    <message>
        <source>Rounds, at most</source>
        <translation>Runden, höchstens</translation>
    </message>
    <message>
        <source>Settings of the plan</source>
        <translation>Einstellungen des Plans</translation>
    </message>
    <message>
        <source>Show plan</source>
        <translation>Plan zeigen</translation>
    </message>
    <message>
        <source>Smoothing</source>
        <translation>Glättung</translation>
    </message>
    <message>
        <source>The job is simulated, its feeds are changed, and it is simulated again, a few rounds of that. The programs stay as they are until you apply the plan.</source>
        <translation>Der Auftrag wird simuliert, seine Vorschübe werden geändert, und er wird wieder simuliert, einige Runden lang. Die Programme bleiben, wie sie sind, bis Sie den Plan anwenden.</translation>
    </message>
    <message>
        <source>The programs have these feeds.</source>
        <translation>Die Programme haben diese Vorschübe.</translation>
    </message>
    <message>
        <source>Write programs...</source>
        <translation>Schreiben...</translation>
    </message>
    <message>
        <source>along the border of the faces</source>
        <translation>entlang der Ränder der Flächen</translation>
    </message>
    <message>
        <source>any number</source>
        <translation>beliebig viele</translation>
    </message>
    <message>
        <source>as planned</source>
        <translation>wie geplant</translation>
    </message>
    <message>
        <source>before</source>
        <translation>vorher</translation>
    </message>
    <message>
        <source>cut too deep at the greatest feed</source>
        <translation>zu tief geschliffen beim größten Vorschub</translation>
    </message>
    <message>
        <source>its motions also grind what needs the contrary</source>
        <translation>seine Bewegungen schleifen auch, was das Gegenteil braucht</translation>
    </message>
    <message>
        <source>its motions must not be changed</source>
        <translation>seine Bewegungen dürfen nicht geändert werden</translation>
    </message>
    <message>
        <source>motions that keep their feed: lines of the program or, of paths made here, poses; of the second program as 2:7-9</source>
        <translation>Bewegungen, die ihren Vorschub behalten: Zeilen des Programms oder, bei hier erzeugten Bahnen, Posen; des zweiten Programms als 2:7-9</translation>
    </message>
    <message>
        <source>no motion removes anything there</source>
        <translation>keine Bewegung trägt dort etwas ab</translation>
    </message>
    <message>
        <source>none, or as 12-40, 2:7</source>
        <translation>nichts, oder wie 12-40, 2:7</translation>
    </message>
    <message>
        <source>now</source>
        <translation>jetzt</translation>
    </message>
    <message>
        <source>planned</source>
        <translation>geplant</translation>
    </message>
    <message>
        <source>positioning: nothing is ground</source>
        <translation>Zustellung: nichts wird geschliffen</translation>
    </message>
    <message>
        <source>too much left at the least feed</source>
        <translation>zu viel übrig beim kleinsten Vorschub</translation>
    </message>
    <message>
        <source>way of the wheel, 0…{:.4g} mm</source>
        <translation>Weg der Scheibe, 0…{:.4g} mm</translation>
    </message>
    <message>
        <source>why it stays out of tolerance</source>
        <translation>warum es außer Toleranz bleibt</translation>
    </message>
    <message>
        <source>{:.1f} % in tolerance as planned; {:.1f} % before.</source>
        <translation>{:.1f} % in Toleranz wie geplant; {:.1f} % vorher.</translation>
    </message>
    <message>
        <source>{} feeds</source>
        <translation>{} Stufen</translation>
    </message>
    <message>
        <source>{}, pose {}</source>
        <translation>{}, Pose {}</translation>
    </message>
    <message>
        <source>Lay the passes anew</source>
        <translation>Bahnen neu legen</translation>
    </message>
    <message>
        <source>Run through, times</source>
        <translation>Durchläufe</translation>
    </message>
    <message>
        <source>the wheel does not fit there</source>
        <translation>die Scheibe passt dort nicht hin</translation>
    </message>
    <message>
        <source>Passes {:.3g} mm apart, run-out {:.3g} mm, run through {} times, {} poses</source>
        <translation>Bahnen im Abstand von {:.3g} mm, Auslauf {:.3g} mm, {}-mal durchlaufen, {} Posen</translation>
    </message>
    <message>
        <source>Goal</source>
        <translation>Ziel</translation>
    </message>
    <message>
        <source>In tolerance, share</source>
        <translation>Anteil in Toleranz</translation>
    </message>
    <message>
        <source>most in tolerance</source>
        <translation>möglichst viel in Toleranz</translation>
    </message>
    <message>
        <source>shortest time</source>
        <translation>kürzeste Zeit</translation>
    </message>
    <message>
        <source>Acceleration</source>
        <translation>Beschleunigung</translation>
    </message>
    <message>
        <source>Change of feed, mm/s per mm</source>
        <translation>Vorschubänderung, mm/s je mm</translation>
    </message>
    <message>
        <source>Change of force, N/s</source>
        <translation>Kraftänderung, N/s</translation>
    </message>
    <message>
        <source>Change, pressure, heat</source>
        <translation>Änderung, Druck, Wärme</translation>
    </message>
    <message>
        <source>Greatest pressure</source>
        <translation>Größter Druck</translation>
    </message>
    <message>
        <source>Laws that pass</source>
        <translation>Bestehende Gesetze</translation>
    </message>
    <message>
        <source>Placement, std. dev.</source>
        <translation>Lage, Standardabw.</translation>
    </message>
    <message>
        <source>Pressure × belt speed, MPa·m/s</source>
        <translation>Druck × Bandgeschw., MPa·m/s</translation>
    </message>
    <message>
        <source>Probability</source>
        <translation>Wahrscheinlichkeit</translation>
    </message>
    <message>
        <source>Surely in tol.</source>
        <translation>Sicher in Tol.</translation>
    </message>
    <message>
        <source>feed or force may not change faster</source>
        <translation>Vorschub oder Kraft dürfen sich nicht schneller ändern</translation>
    </message>
    <message>
        <source>too much left at the greatest pressure</source>
        <translation>beim größten Druck bleibt zu viel stehen</translation>
    </message>
    <message>
        <source>A part costs {:.3f}, the batch {:.2f}; {:.1f} h</source>
        <translation>Ein Teil kostet {:.3f}, das Los {:.2f}; {:.1f} h</translation>
    </message>
    <message>
        <source>A worn belt cuts less: each part is ground slower, or pressed harder, so that it loses as much as with a fresh belt. When is a new belt cheaper?</source>
        <translation>Ein verschlissenes Band trägt weniger ab: jedes Teil wird langsamer geschliffen oder stärker gedrückt, sodass es so viel verliert wie mit einem frischen. Ab wann ist ein neues Band billiger?</translation>
    </message>
    <message>
        <source>Belt plan</source>
        <translation>Bandplan</translation>
    </message>
    <message>
        <source>Changing it, min</source>
        <translation>Bandwechsel, min</translation>
    </message>
    <message>
        <source>Cost of a belt</source>
        <translation>Kosten eines Bands</translation>
    </message>
    <message>
        <source>Cost of a minute</source>
        <translation>Kosten einer Minute</translation>
    </message>
    <message>
        <source>Folder for the belt plan</source>
        <translation>Ordner für den Bandplan</translation>
    </message>
    <message>
        <source>Follows the wear</source>
        <translation>Folgt dem Verschleiß</translation>
    </message>
    <message>
        <source>Greatest force, N</source>
        <translation>Größte Kraft, N</translation>
    </message>
    <message>
        <source>Least feed, mm/s</source>
        <translation>Kleinster Vorschub, mm/s</translation>
    </message>
    <message>
        <source>New belts: {}; parts on each belt: {}</source>
        <translation>Neue Bänder: {}; Teile je Band: {}</translation>
    </message>
    <message>
        <source>Parts</source>
        <translation>Teile</translation>
    </message>
    <message>
        <source>Save...</source>
        <translation>Speichern...</translation>
    </message>
    <message>
        <source>With every belt as long as it can: {:.2f}</source>
        <translation>Jedes Band so lange, wie es kann: {:.2f}</translation>
    </message>
    <message>
        <source>Written into {}: {}</source>
        <translation>Geschrieben nach {}: {}</translation>
    </message>
    <message>
        <source>cost of the part</source>
        <translation>Kosten des Teils</translation>
    </message>
    <message>
        <source>cut of the belt, %</source>
        <translation>Abtrag des Bands, %</translation>
    </message>
    <message>
        <source>feed</source>
        <translation>Vorschub</translation>
    </message>
    <message>
        <source>force</source>
        <translation>Kraft</translation>
    </message>
    <message>
        <source>force, then feed</source>
        <translation>Kraft, dann Vorschub</translation>
    </message>
    <message>
        <source>of the program&apos;s, %</source>
        <translation>vom Programm, %</translation>
    </message>
    <message>
        <source>part; a new belt where the background changes</source>
        <translation>Teil; ein neues Band, wo der Grund wechselt</translation>
    </message>
    <message>
        <source>{} parts are ground by belts that have done more than their wear was measured for</source>
        <translation>{} Teile schleifen Bänder, die mehr getan haben, als ihr Verschleiß gemessen wurde</translation>
    </message>
    <message>
        <source>{} parts, {} new belts, cost {:.2f}</source>
        <translation>{} Teile, {} neue Bänder, Kosten {:.2f}</translation>
    </message>
    <message>
        <source>Coefficient</source>
        <translation>Beiwert</translation>
    </message>
    <message>
        <source>Correct the law</source>
        <translation>Gesetz berichtigen</translation>
    </message>
    <message>
        <source>Learning from the scan...</source>
        <translation>Lerne aus dem Scan...</translation>
    </message>
    <message>
        <source>Measured removal is {:.3f} of the predicted.</source>
        <translation>Gemessen ist das {:.3f}-Fache des vorhergesagten Abtrags.</translation>
    </message>
    <message>
        <source>The job has this law now; simulate or plan the next part.</source>
        <translation>Der Auftrag hat jetzt dieses Gesetz; simulieren oder planen Sie das nächste Teil.</translation>
    </message>
    <message>
        <source>Wear scale</source>
        <translation>Verschleißskala</translation>
    </message>
    <message>
        <source>law and wear of the belt, as far as they are unsure, by what the scan shows: for the next part</source>
        <translation>Gesetz und Verschleiß des Bands, soweit sie unsicher sind, nach dem, was der Scan zeigt: für das nächste Teil</translation>
    </message>
    <message>
        <source>Laid on the design with {} rms.</source>
        <translation>Auf den Entwurf gelegt mit {} rms.</translation>
    </message>
    <message>
        <source>Lay the scan on the design</source>
        <translation>Scan auf den Entwurf legen</translation>
    </message>
    <message>
        <source>Laying the scan on the design...</source>
        <translation>Lege den Scan auf den Entwurf...</translation>
    </message>
    <message>
        <source>At {} places feed or force change faster than they may: the program&apos;s own steps, or motions that stay.</source>
        <translation>An {} Stellen ändern sich Vorschub oder Kraft schneller, als sie dürfen: eigene Stufen des Programms, oder Bewegungen, die bleiben.</translation>
    </message>
    <message>
        <source>beside what no motion reaches</source>
        <translation>neben dem, was keine Bewegung erreicht</translation>
    </message>
    <message>
        <source>Exponent of the fall</source>
        <translation>Exponent des Abfalls</translation>
    </message>
    <message>
        <source>Power of the wear</source>
        <translation>Potenz des Verschleißes</translation>
    </message>
    <message>
        <source>Ground on the job&apos;s wheel</source>
        <translation>Mit Scheibe des Auftrags</translation>
    </message>
    <message>
        <source>The contacts are solved with the job&apos;s wheel, and the law is fitted to their pressures; columns of the wheel in the table come first</source>
        <translation>Die Kontakte werden mit der Scheibe des Auftrags gelöst, und das Gesetz wird an ihre Drücke angepasst; Spalten der Scheibe in der Tabelle gehen vor</translation>
    </message>
    <message>
        <source>RMS</source>
        <translation>RMS</translation>
    </message>
    <message>
        <source> (95 %: {:.1f} to {:.1f})</source>
        <translation> (95 %: {:.1f} bis {:.1f})</translation>
    </message>
    <message>
        <source>, {} failed</source>
        <translation>, {} fehlgeschlagen</translation>
    </message>
    <message>
        <source>= sets the value, + adds to the job&apos;s, × is a factor on it; numbers in the unit that the key ends with, blanks between them</source>
        <translation>= setzt den Wert, + wird zu dem des Auftrags addiert, × ist ein Faktor darauf; Zahlen in der Einheit, mit der der Schlüssel endet, mit Leerzeichen dazwischen</translation>
    </message>
    <message>
        <source>All runs (scatter)</source>
        <translation>Alle Läufe (Streudiagramm)</translation>
    </message>
    <message>
        <source>Cancelled: {} of {} runs are kept, Run goes on from there.</source>
        <translation>Abgebrochen: {} von {} Läufen sind behalten, Starten macht dort weiter.</translation>
    </message>
    <message>
        <source>Design</source>
        <translation>Versuchsplan</translation>
    </message>
    <message>
        <source>Double click: set the document to this run. Heads: sort</source>
        <translation>Doppelklick: das Dokument auf diesen Lauf setzen. Spaltenköpfe: sortieren</translation>
    </message>
    <message>
        <source>Each against each other</source>
        <translation>Jede gegen jede</translation>
    </message>
    <message>
        <source>It does not vary</source>
        <translation>Es variiert nicht</translation>
    </message>
    <message>
        <source>Latin hypercube</source>
        <translation>lateinischer Hyperwürfel</translation>
    </message>
    <message>
        <source>Mean over each variable</source>
        <translation>Mittel über jede Größe</translation>
    </message>
    <message>
        <source>Monte Carlo</source>
        <translation>Monte Carlo</translation>
    </message>
    <message>
        <source>Number</source>
        <translation>Anzahl</translation>
    </message>
    <message>
        <source>Open as the document&apos;s state</source>
        <translation>Als Zustand des Dokuments öffnen</translation>
    </message>
    <message>
        <source>Out of date: an input has changed since; run again.</source>
        <translation>Veraltet: Seither hat sich eine Eingabe geändert; noch einmal starten.</translation>
    </message>
    <message>
        <source>Report of the study</source>
        <translation>Bericht der Studie</translation>
    </message>
    <message>
        <source>Report...</source>
        <translation>Bericht...</translation>
    </message>
    <message>
        <source>Run</source>
        <translation>Starten</translation>
    </message>
    <message>
        <source>Running, {}</source>
        <translation>Läuft, {}</translation>
    </message>
    <message>
        <source>Runs</source>
        <translation>Läufe</translation>
    </message>
    <message>
        <source>Save table</source>
        <translation>Tabelle speichern</translation>
    </message>
    <message>
        <source>Save table...</source>
        <translation>Tabelle speichern...</translation>
    </message>
    <message>
        <source>Seed</source>
        <translation>Startzahl</translation>
    </message>
    <message>
        <source>Set to run {}</source>
        <translation>Auf Lauf {} setzen</translation>
    </message>
    <message>
        <source>Settings of the study</source>
        <translation>Einstellungen der Studie</translation>
    </message>
    <message>
        <source>Show study</source>
        <translation>Studie zeigen</translation>
    </message>
    <message>
        <source>Side by side</source>
        <translation>Gleichzeitig</translation>
    </message>
    <message>
        <source>Sobol indices</source>
        <translation>Sobol-Indizes</translation>
    </message>
    <message>
        <source>Sobol sequence</source>
        <translation>Sobol-Folge</translation>
    </message>
    <message>
        <source>State</source>
        <translation>Zustand</translation>
    </message>
    <message>
        <source>Study</source>
        <translation>Studie</translation>
    </message>
    <message>
        <source>Table and charts</source>
        <translation>Tabelle und Diagramme</translation>
    </message>
    <message>
        <source>The document has no property for these, they stay as they are: {}</source>
        <translation>Hierfür hat das Dokument keine Eigenschaft, es bleibt, wie es ist: {}</translation>
    </message>
    <message>
        <source>The job is simulated many times, with other values of what varies. The job itself stays as it is.</source>
        <translation>Der Auftrag wird viele Male simuliert, mit anderen Werten dessen, was variiert. Der Auftrag selbst bleibt, wie er ist.</translation>
    </message>
    <message>
        <source>These paths were laid anew for the settings, so the figures may differ from the table&apos;s: {}</source>
        <translation>Diese Bahnen wurden für die Einstellungen neu gelegt, sodass die Ergebnisse von denen der Tabelle abweichen können: {}</translation>
    </message>
    <message>
        <source>Tolerance yield</source>
        <translation>Ausbeute</translation>
    </message>
    <message>
        <source>Weibull: scale, shape</source>
        <translation>Weibull: Skala, Form</translation>
    </message>
    <message>
        <source>What does most (tornado)</source>
        <translation>Was am meisten bewirkt (Tornado)</translation>
    </message>
    <message>
        <source>What varies</source>
        <translation>Was variiert</translation>
    </message>
    <message>
        <source>Why</source>
        <translation>Warum</translation>
    </message>
    <message>
        <source>blocks for Sobol indices</source>
        <translation>Blöcke für Sobol-Indizes</translation>
    </message>
    <message>
        <source>done</source>
        <translation>fertig</translation>
    </message>
    <message>
        <source>failed</source>
        <translation>fehlgeschlagen</translation>
    </message>
    <message>
        <source>from … to</source>
        <translation>von … bis</translation>
    </message>
    <message>
        <source>grid</source>
        <translation>Gitter</translation>
    </message>
    <message>
        <source>lognormal: mean, std. dev.</source>
        <translation>lognormal: Mittel, Std.-Abw.</translation>
    </message>
    <message>
        <source>normal: mean, std. dev.</source>
        <translation>normal: Mittel, Std.-Abw.</translation>
    </message>
    <message>
        <source>one a core</source>
        <translation>einer je Kern</translation>
    </message>
    <message>
        <source>open</source>
        <translation>offen</translation>
    </message>
    <message>
        <source>the document is set to run {}</source>
        <translation>das Dokument ist auf Lauf {} gesetzt</translation>
    </message>
    <message>
        <source>triangular: from, mode, to</source>
        <translation>Dreieck: von, Modus, bis</translation>
    </message>
    <message>
        <source>uniform: from, to</source>
        <translation>gleichverteilt: von, bis</translation>
    </message>
    <message>
        <source>values</source>
        <translation>Werte</translation>
    </message>
    <message>
        <source>{:.1f} % of the runs pass.</source>
        <translation>{:.1f} % der Läufe bestehen.</translation>
    </message>
    <message>
        <source>{:.1f} % pass</source>
        <translation>{:.1f} % bestehen</translation>
    </message>
    <message>
        <source>{} could not be run; the table says why.</source>
        <translation>{} waren nicht möglich; die Tabelle sagt, warum.</translation>
    </message>
    <message>
        <source>{} failed</source>
        <translation>{} fehlgeschlagen</translation>
    </message>
    <message>
        <source>{} of {} runs</source>
        <translation>{} von {} Läufen</translation>
    </message>
    <message>
        <source>{} of {} runs have figures</source>
        <translation>{} von {} Läufen haben Ergebnisse</translation>
    </message>
    <message>
        <source>{} of {} runs have figures.</source>
        <translation>{} von {} Läufen haben Ergebnisse.</translation>
    </message>
    <message>
        <source>{} parts</source>
        <translation>{} Teile</translation>
    </message>
    <message>
        <source>Best setting</source>
        <translation>Beste Einstellung</translation>
    </message>
    <message>
        <source>Wanted</source>
        <translation>Gesucht</translation>
    </message>
    <message>
        <source>also between the runs</source>
        <translation>auch zwischen den Läufen</translation>
    </message>
    <message>
        <source>best: run {}</source>
        <translation>am besten: Lauf {}</translation>
    </message>
    <message>
        <source>greatest</source>
        <translation>größter Wert</translation>
    </message>
    <message>
        <source>least</source>
        <translation>kleinster Wert</translation>
    </message>
    <message>
        <source>no run keeps all limits, nearest: run {}</source>
        <translation>kein Lauf hält alle Grenzen ein, am nächsten: Lauf {}</translation>
    </message>
    <message>
        <source>no run to choose the best from</source>
        <translation>kein Lauf, der zur Wahl stünde</translation>
    </message>
    <message>
        <source>none</source>
        <translation>keine</translation>
    </message>
    <message>
        <source>only runs that pass</source>
        <translation>nur Läufe, die bestehen</translation>
    </message>
    <message>
        <source>Greatest temperature</source>
        <translation>Höchste Temperatur</translation>
    </message>
    <message>
        <source>greatest temperature, °C</source>
        <translation>höchste Temperatur, °C</translation>
    </message>
    <message>
        <source>Hottest</source>
        <translation>Heißeste Stelle</translation>
    </message>
    <message>
        <source>Hottest, at most</source>
        <translation>Höchstens</translation>
    </message>
    <message>
        <source>Add limit</source>
        <translation>Grenze hinzufügen</translation>
    </message>
    <message>
        <source>Add pair</source>
        <translation>Paar hinzufügen</translation>
    </message>
    <message>
        <source>Correlation of their normal scores, between -1 and 1; for normal variables the correlation itself, for Spearman&apos;s rank correlation r it is 2 sin(π r / 6)</source>
        <translation>Korrelation ihrer Normalwerte, zwischen -1 und 1; bei normalverteilten Größen die Korrelation selbst, bei Spearmans Rangkorrelation r ist es 2 sin(π r / 6)</translation>
    </message>
    <message>
        <source>Correlations</source>
        <translation>Korrelationen</translation>
    </message>
    <message>
        <source>Greatest value; empty: none</source>
        <translation>Größter Wert; leer: keiner</translation>
    </message>
    <message>
        <source>It has no limit</source>
        <translation>Keine Grenze</translation>
    </message>
    <message>
        <source>Least value; empty: none</source>
        <translation>Kleinster Wert; leer: keiner</translation>
    </message>
    <message>
        <source>Limits: least … greatest</source>
        <translation>Grenzen: kleinster … größter Wert</translation>
    </message>
    <message>
        <source>They are independent</source>
        <translation>Sie sind unabhängig</translation>
    </message>
    <message>
        <source>Roughness</source>
        <translation>Rauheit</translation>
    </message>
    <message>
        <source>Ra, mean</source>
        <translation>Ra, Mittel</translation>
    </message>
    <message>
        <source>Ra, greatest</source>
        <translation>Ra, größtes</translation>
    </message>
    <message>
        <source>Ra known</source>
        <translation>Ra bekannt</translation>
    </message>
    <message>
        <source>Crossed scratches</source>
        <translation>Gekreuzte Spuren</translation>
    </message>
    <message>
        <source>roughness Ra, µm</source>
        <translation>Rauheit Ra, µm</translation>
    </message>
    <message>
        <source>Add layer</source>
        <translation>Schicht hinzufügen</translation>
    </message>
    <message>
        <source>Belt between rollers</source>
        <translation>Band zwischen Rollen</translation>
    </message>
    <message>
        <source>Belt&apos;s face (0: own)</source>
        <translation>Bandfläche (0: eigene)</translation>
    </message>
    <message>
        <source>Belt&apos;s thickness</source>
        <translation>Dicke des Bandes</translation>
    </message>
    <message>
        <source>Belt&apos;s width</source>
        <translation>Breite des Bandes</translation>
    </message>
    <message>
        <source>Contact off the middle</source>
        <translation>Kontakt neben der Mitte</translation>
    </message>
    <message>
        <source>E, MPa</source>
        <translation>E, MPa</translation>
    </message>
    <message>
        <source>Fixed: the belt stretches</source>
        <translation>Fest: das Band dehnt sich</translation>
    </message>
    <message>
        <source>Free belt</source>
        <translation>Freies Band</translation>
    </message>
    <message>
        <source>Free belt or platen</source>
        <translation>Freies Band, Platte</translation>
    </message>
    <message>
        <source>Free length</source>
        <translation>Freie Länge</translation>
    </message>
    <message>
        <source>From the side, to scale; the work is above</source>
        <translation>Von der Seite, maßstäblich; das Werkstück ist oben</translation>
    </message>
    <message>
        <source>Its back (0: same)</source>
        <translation>Rückseite (0: ebenso)</translation>
    </message>
    <message>
        <source>Kind of machine</source>
        <translation>Art der Maschine</translation>
    </message>
    <message>
        <source>Length</source>
        <translation>Länge</translation>
    </message>
    <message>
        <source>Plate&apos;s thickness</source>
        <translation>Dicke der Platte</translation>
    </message>
    <message>
        <source>Platen</source>
        <translation>Stützplatte</translation>
    </message>
    <message>
        <source>Poisson</source>
        <translation>Querk.-zahl</translation>
    </message>
    <message>
        <source>Rollers</source>
        <translation>Rollen</translation>
    </message>
    <message>
        <source>Rollers&apos; radius</source>
        <translation>Radius der Rollen</translation>
    </message>
    <message>
        <source>Takes the layer away</source>
        <translation>Entfernt die Schicht</translation>
    </message>
    <message>
        <source>Tension</source>
        <translation>Spannung</translation>
    </message>
    <message>
        <source>Tensioned: keep the pull</source>
        <translation>Gespannt: halten den Zug</translation>
    </message>
    <message>
        <source>mm thick</source>
        <translation>mm dick</translation>
    </message>
    <message>
        <source>must be greater than 0</source>
        <translation>muss größer als 0 sein</translation>
    </message>
    <message>
        <source>must lie from 0 to {}</source>
        <translation>muss zwischen 0 und {} liegen</translation>
    </message>
    <message>
        <source>rim {} mm</source>
        <translation>Belag {} mm</translation>
    </message>
    <message>
        <source>width {}</source>
        <translation>Breite {}</translation>
    </message>
    <message>
        <source>work</source>
        <translation>Werkstück</translation>
    </message>
    <message>
        <source>Before grinding, °C</source>
        <translation>Vor dem Schleifen, °C</translation>
    </message>
    <message>
        <source>Burnt above, °C (0: unknown)</source>
        <translation>Verbrannt ab, °C (0: ?)</translation>
    </message>
    <message>
        <source>Conductivity, W/(m K)</source>
        <translation>Leitfähigkeit, W/(m K)</translation>
    </message>
    <message>
        <source>Density, kg/m³</source>
        <translation>Dichte, kg/m³</translation>
    </message>
    <message>
        <source>Friction</source>
        <translation>Reibung</translation>
    </message>
    <message>
        <source>Heat capacity, J/(kg K)</source>
        <translation>Wärmekap., J/(kg K)</translation>
    </message>
    <message>
        <source>Share into the work</source>
        <translation>Anteil ins Werkstück</translation>
    </message>
    <message>
        <source>Temperatures</source>
        <translation>Temperaturen</translation>
    </message>
    <message>
        <source>The rise is in proportion to friction times share: measure them before you believe a temperature.</source>
        <translation>Der Anstieg ist proportional zu Reibung mal Anteil: beide messen, bevor man einer Temperatur glaubt.</translation>
    </message>
    <message>
        <source>least … greatest</source>
        <translation>kleinster … größter Wert</translation>
    </message>
    <message>
        <source>not computed</source>
        <translation>nicht berechnet</translation>
    </message>
    <message>
        <source>own values</source>
        <translation>eigene Werte</translation>
    </message>
    <message>
        <source>the greatest lies below the least</source>
        <translation>der größte Wert liegt unter dem kleinsten</translation>
    </message>
    <message>
        <source>Arms (0: none)</source>
        <translation>Arme (0: keine)</translation>
    </message>
    <message>
        <source>Axle to pulleys</source>
        <translation>Achse bis Umlenkrollen</translation>
    </message>
    <message>
        <source>Between the runs</source>
        <translation>Zwischen den Trumen</translation>
    </message>
    <message>
        <source>Fork, for collisions</source>
        <translation>Gabel, für Kollisionen</translation>
    </message>
    <message>
        <source>Small wheel in a fork</source>
        <translation>Kleine Scheibe, Gabel</translation>
    </message>
    <message>
        <source>Force: {:.1f} N (commanded: {:.1f} N)
Highest pressure: {:.3f} MPa (darkest)
Contact: {:.0f} mm² of {:.1f} x {:.1f} mm
{}: {:+.3f} mm beyond its pose
x to the right along the belt, y upwards along the axis</source>
        <translation>Kraft: {:.1f} N (Sollwert: {:.1f} N)
Höchster Druck: {:.3f} MPa (am dunkelsten)
Kontakt: {:.0f} mm² bei {:.1f} x {:.1f} mm
{}: {:+.3f} mm über ihre Pose hinaus
x nach rechts in Bandlaufrichtung, y nach oben in Achsrichtung</translation>
    </message>
    <message>
        <source>without room</source>
        <translation>ohne Platz</translation>
    </message>
    <message>
        <source>Crossed from, °</source>
        <translation>Gekreuzt ab, °</translation>
    </message>
    <message>
        <source>Direction of the scratches: = or ⊥ (or T) with a direction, such as = 1 0 0; X or M crossed; C or R with a centre, such as C 10 0 5</source>
        <translation>Richtung der Schleifspuren: = oder ⊥ (oder T) mit einer Richtung, etwa = 1 0 0; X oder M gekreuzt; C oder R mit einem Mittelpunkt, etwa C 10 0 5</translation>
    </message>
    <message>
        <source>Finish</source>
        <translation>Oberflächengüte</translation>
    </message>
    <message>
        <source>Grit</source>
        <translation>Körnung</translation>
    </message>
    <message>
        <source>Lay</source>
        <translation>Rillenrichtung</translation>
    </message>
    <message>
        <source>Left by a pass, share</source>
        <translation>Rest je Überschliff, Anteil</translation>
    </message>
    <message>
        <source>Measured roughness</source>
        <translation>Gemessene Rauheit</translation>
    </message>
    <message>
        <source>Measured: {}</source>
        <translation>Gemessen: {}</translation>
    </message>
    <message>
        <source>Measurements</source>
        <translation>Messungen</translation>
    </message>
    <message>
        <source>Ra before grinding, µm</source>
        <translation>Ra vor dem Schleifen, µm</translation>
    </message>
    <message>
        <source>Ra, µm</source>
        <translation>Ra, µm</translation>
    </message>
    <message>
        <source>Read...</source>
        <translation>Lesen...</translation>
    </message>
    <message>
        <source>Roughness and lay</source>
        <translation>Rauheit und Rillenrichtung</translation>
    </message>
    <message>
        <source>What a pass leaves of the roughness before is not known: each counts as measured.</source>
        <translation>Was ein Überschliff von der Rauheit davor lässt, ist nicht bekannt: Jeder zählt wie gemessen.</translation>
    </message>
    <message>
        <source>as measured</source>
        <translation>wie gemessen</translation>
    </message>
    <message>
        <source>computed</source>
        <translation>berechnet</translation>
    </message>
    <message>
        <source>empty: not known</source>
        <translation>leer: nicht bekannt</translation>
    </message>
    <message>
        <source>empty: what the measurements tell</source>
        <translation>leer: was die Messungen sagen</translation>
    </message>
    <message>
        <source>grit</source>
        <translation>Körnung</translation>
    </message>
    <message>
        <source>lay alone</source>
        <translation>Rillenrichtung allein</translation>
    </message>
    <message>
        <source>must be 0 or more, and less than 1</source>
        <translation>muss 0 oder mehr und kleiner als 1 sein</translation>
    </message>
    <message>
        <source>of a fresh belt&apos;s cut</source>
        <translation>vom Abtrag eines frischen Bandes</translation>
    </message>
    <message>
        <source>roughness and lay</source>
        <translation>Rauheit und Rillenrichtung</translation>
    </message>
    <message>
        <source>Exponents of Ra: {}</source>
        <translation>Exponenten von Ra: {}</translation>
    </message>
    <message>
        <source>Greatest roughness, such as 0.8; 0.8 T16%: up to 16 % of the area may have more, or scratches that are not the lay&apos;s. The job must compute the finish</source>
        <translation>Größte Rauheit, etwa 0,8; 0,8 T16%: Bis zu 16 % der Fläche dürfen mehr haben oder Spuren, die nicht in der Rillenrichtung liegen. Der Auftrag muss die Oberflächengüte berechnen</translation>
    </message>
    <message>
        <source>belt speed</source>
        <translation>Bandgeschwindigkeit</translation>
    </message>
    <message>
        <source>give the belt&apos;s grit; {} to {} were measured</source>
        <translation>die Körnung des Bandes angeben; gemessen wurden {} bis {}</translation>
    </message>
    <message>
        <source>pressure</source>
        <translation>Druck</translation>
    </message>
    <message>
        <source>remaining cut</source>
        <translation>verbliebene Schnittfähigkeit</translation>
    </message>
    <message>
        <source>In tolerance, but the finish is not as called for: {} of {} zones</source>
        <translation>In der Toleranz, aber die Oberflächengüte ist nicht wie gefordert: {} von {} Zonen</translation>
    </message>
    <message>
        <source>In tolerance, but the finish of a zone is not known</source>
        <translation>In der Toleranz, aber die Oberflächengüte einer Zone ist nicht bekannt</translation>
    </message>
    <message>
        <source>95 % interval</source>
        <translation>95-%-Bereich</translation>
    </message>
    <message>
        <source>A CSV of measured roughnesses, to which a model is fitted</source>
        <translation>Eine CSV gemessener Rauheiten, an die ein Modell angepasst wird</translation>
    </message>
    <message>
        <source>By one Ra for all it would be {:.1f} %, nine of ten within {:.0f} %.</source>
        <translation>Mit einem Ra für alle wären es {:.1f} %, neun von zehn auf {:.0f} %.</translation>
    </message>
    <message>
        <source>By the grit alone it would be {:.1f} %, nine of ten within {:.0f} %.</source>
        <translation>Allein nach der Körnung wären es {:.1f} %, neun von zehn auf {:.0f} %.</translation>
    </message>
    <message>
        <source>Discard</source>
        <translation>Verwerfen</translation>
    </message>
    <message>
        <source>Fit...</source>
        <translation>Anpassen...</translation>
    </message>
    <message>
        <source>Fitted roughness</source>
        <translation>Angepasste Rauheit</translation>
    </message>
    <message>
        <source>Fitting, {:.0f} %</source>
        <translation>Wird angepasst, {:.0f} %</translation>
    </message>
    <message>
        <source>Ra at the references, µm</source>
        <translation>Ra am Bezugspunkt, µm</translation>
    </message>
    <message>
        <source>Save and use...</source>
        <translation>Speichern und verwenden...</translation>
    </message>
    <message>
        <source>Stop</source>
        <translation>Anhalten</translation>
    </message>
    <message>
        <source>Tables ({});;All files (*)</source>
        <translation>Tabellen ({});;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>The file that Fit... or beltgrind calibrate-finish has written</source>
        <translation>Die Datei, die Anpassen... oder beltgrind calibrate-finish geschrieben hat</translation>
    </message>
    <message>
        <source>What was measured</source>
        <translation>Was gemessen wurde</translation>
    </message>
    <message>
        <source>Without measurements there is the direction of the scratches, and no roughness: Fit... takes a table of your own.</source>
        <translation>Ohne Messungen gibt es die Richtung der Schleifspuren und keine Rauheit: Anpassen... nimmt eine eigene Tabelle.</translation>
    </message>
    <message>
        <source>and by whom; the model keeps it</source>
        <translation>und von wem; das Modell behält es</translation>
    </message>
    <message>
        <source>exponent of the belt speed</source>
        <translation>Exponent der Bandgeschwindigkeit</translation>
    </message>
    <message>
        <source>exponent of the feed</source>
        <translation>Exponent des Vorschubs</translation>
    </message>
    <message>
        <source>exponent of the grit</source>
        <translation>Exponent der Körnung</translation>
    </message>
    <message>
        <source>exponent of the pressure</source>
        <translation>Exponent des Drucks</translation>
    </message>
    <message>
        <source>exponent of the remaining cut</source>
        <translation>Exponent der verbliebenen Schnittfähigkeit</translation>
    </message>
    <message>
        <source>left by a pass, share</source>
        <translation>Rest je Überschliff, Anteil</translation>
    </message>
    <message>
        <source>not varied</source>
        <translation>nicht verändert</translation>
    </message>
    <message>
        <source>{} measurements. Left out one by one, they are told with a median error of {:.1f} %, nine of ten within {:.0f} %.</source>
        <translation>{} Messungen. Einzeln weggelassen werden sie mit einem mittleren Fehler (Median) von {:.1f} % vorhergesagt, neun von zehn auf {:.0f} %.</translation>
    </message>
    <message>
        <source>{}: lay</source>
        <translation>{}: Rillenrichtung</translation>
    </message>
    <message>
        <source>{}: roughness</source>
        <translation>{}: Rauheit</translation>
    </message>
    <message>
        <source>Chosen from the part: force, passes, samples, and the feed at which the allowance comes off on the mean, if K is right: K is not known before the belt is calibrated. The belt is taken as it is.</source>
        <translation>Nach dem Bauteil gewählt: Kraft, Bahnen, Abtastung und der Vorschub, bei dem das Aufmaß im Mittel abgeht, wenn K stimmt: K ist erst bekannt, wenn das Band kalibriert ist. Das Band bleibt, wie es ist.</translation>
    </message>
    <message>
        <source>At +y</source>
        <translation>Bei +y</translation>
    </message>
    <message>
        <source>At −y</source>
        <translation>Bei −y</translation>
    </message>
    <message>
        <source>Both</source>
        <translation>Beide</translation>
    </message>
    <message>
        <source>Frame, for collisions</source>
        <translation>Gestell, für Kollisionen</translation>
    </message>
    <message>
        <source>Radius (0: flat)</source>
        <translation>Radius (0: eben)</translation>
    </message>
    <message>
        <source>Rollers to pulleys (0: none)</source>
        <translation>Bis Umlenkr. (0: keine)</translation>
    </message>
    <message>
        <source>Sides with arms</source>
        <translation>Seiten mit Armen</translation>
    </message>
    <message>
        <source>Chosen zone</source>
        <translation>Gewählte Zone</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Belt</name>
    <message>
        <source>Belt</source>
        <translation>Schleifband</translation>
    </message>
    <message>
        <source>Puts a belt on the machine that carries its wear from run to run</source>
        <translation>Legt ein Band auf, das seinen Verschleiß von Lauf zu Lauf mitnimmt</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_BeltMachine</name>
    <message>
        <source>Belt machine</source>
        <translation>Bandschleifmaschine</translation>
    </message>
    <message>
        <source>Describes contact wheel, belt, force control and cell</source>
        <translation>Beschreibt Kontaktscheibe, Band, Kraftregelung und Zelle</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_BeltPlan</name>
    <message>
        <source>Belt plan...</source>
        <translation>Bandplan...</translation>
    </message>
    <message>
        <source>When to change the belt over a batch of parts, and how feed or force follow its wear</source>
        <translation>Wann das Band über ein Los von Teilen zu wechseln ist, und wie Vorschub oder Kraft seinem Verschleiß folgen</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Calibrate</name>
    <message>
        <source>Calibrate removal law...</source>
        <translation>Abtragsgesetz kalibrieren...</translation>
    </message>
    <message>
        <source>Fits the law of removal to a table of measured grinds</source>
        <translation>Passt das Abtragsgesetz an eine Tabelle gemessener Schliffe an</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Cell</name>
    <message>
        <source>Cell</source>
        <translation>Zelle</translation>
    </message>
    <message>
        <source>Says who holds what, and where; shows the wheel at every pose</source>
        <translation>Legt fest, wer was wo hält; zeigt die Scheibe an jeder Pose</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_CheckSettings</name>
    <message>
        <source>Are spacing and steps fine enough? Simulates coarser, as given and finer</source>
        <translation>Sind Abstand und Schritte fein genug? Simuliert gröber, wie angegeben und feiner</translation>
    </message>
    <message>
        <source>Check settings...</source>
        <translation>Einstellungen prüfen...</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Contact</name>
    <message>
        <source>Contact at a pose...</source>
        <translation>Kontakt an einer Pose...</translation>
    </message>
    <message>
        <source>Shows the pressure on the wheel&apos;s footprint at any pose</source>
        <translation>Zeigt den Druck in der Kontaktfläche der Scheibe an jeder Pose</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Deviation</name>
    <message>
        <source>Deviation</source>
        <translation>Abweichung</translation>
    </message>
    <message>
        <source>Lays the deviation from the design over the part in colour</source>
        <translation>Legt die Abweichung vom Soll farbig über das Werkstück</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_ExampleBlade</name>
    <message>
        <source>Example: compressor blade</source>
        <translation>Beispiel: Verdichterschaufel</translation>
    </message>
    <message>
        <source>Makes a document with a blade, its stock and its program</source>
        <translation>Erstellt ein Dokument mit einer Schaufel, ihrem Aufmaß und ihrem Programm</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_ExampleKnife</name>
    <message>
        <source>Example: chef&apos;s knife</source>
        <translation>Beispiel: Kochmesser</translation>
    </message>
    <message>
        <source>Makes a document with a knife, ground by a robot that speeds up and slows down</source>
        <translation>Erstellt ein Dokument mit einem Messer, geschliffen von einem Roboter, der beschleunigt und bremst</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_ExampleTap</name>
    <message>
        <source>Example: mixer tap</source>
        <translation>Beispiel: Einhebelmischer</translation>
    </message>
    <message>
        <source>Makes a document with a tap that a robot holds against the belt</source>
        <translation>Erstellt ein Dokument mit einer Armatur, die ein Roboter ans Band hält</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_ExampleTapBelt</name>
    <message>
        <source>Example: tap spout on a free belt</source>
        <translation>Beispiel: Armaturenauslauf am freien Band</translation>
    </message>
    <message>
        <source>Makes a document with a tap whose spout a free belt wraps round</source>
        <translation>Legt ein Dokument mit einer Armatur an, um deren Auslauf sich ein freies Band legt</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_ExampleVane</name>
    <message>
        <source>Example: blade with fillet and edges</source>
        <translation>Beispiel: Schaufel mit Hohlkehle und Kanten</translation>
    </message>
    <message>
        <source>Makes a document with a blade that is ground on both sides</source>
        <translation>Erstellt ein Dokument mit einer Schaufel, die auf beiden Seiten geschliffen wird</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_ExportJob</name>
    <message>
        <source>Export job file...</source>
        <translation>Auftragsdatei schreiben...</translation>
    </message>
    <message>
        <source>Writes the job as JSON, for beltgrind on another machine</source>
        <translation>Schreibt den Auftrag als JSON, für beltgrind auf einem anderen Rechner</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_ExportProgram</name>
    <message>
        <source>Export robot program...</source>
        <translation>Roboterprogramm schreiben...</translation>
    </message>
    <message>
        <source>Writes the selected robot path as KRL, RAPID, URScript or CSV</source>
        <translation>Schreibt die gewählte Roboterbahn als KRL, RAPID, URScript oder CSV</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Figures</name>
    <message>
        <source>Figures in a spreadsheet</source>
        <translation>Werte in einer Tabelle</translation>
    </message>
    <message>
        <source>Makes a spreadsheet of the figures that follows the result</source>
        <translation>Erstellt eine Tabelle der Werte, die dem Ergebnis folgt</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_FollowPath</name>
    <message>
        <source>Follow selected path</source>
        <translation>Gewählter Bahn folgen</translation>
    </message>
    <message>
        <source>Grinds along the selected CAM path or robot trajectory of FreeCAD, and follows its changes</source>
        <translation>Schleift entlang der gewählten CAM-Bahn oder Roboterbahn von FreeCAD und folgt ihren Änderungen</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_GrindFaces</name>
    <message>
        <source>Grind these faces...</source>
        <translation>Diese Flächen schleifen...</translation>
    </message>
    <message>
        <source>Lays passes on the selected faces, or the job&apos;s, and plans their feeds and forces, until they are in tolerance, or says why not</source>
        <translation>Legt Bahnen auf die gewählten Flächen oder die des Auftrags und plant ihre Vorschübe und Kräfte, bis sie in Toleranz sind, oder sagt, warum nicht</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_GroundMesh</name>
    <message>
        <source>Ground part as mesh</source>
        <translation>Geschliffenes Teil als Netz</translation>
    </message>
    <message>
        <source>Makes the whole part as ground, one closed mesh, to measure or export; once more after a new simulation</source>
        <translation>Erstellt das ganze Teil, wie geschliffen, als ein geschlossenes Netz zum Messen oder Ausgeben; nach neuer Simulation noch einmal</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_ImportProgram</name>
    <message>
        <source>Import robot program...</source>
        <translation>Roboterprogramm einlesen...</translation>
    </message>
    <message>
        <source>Reads a robot program into the job</source>
        <translation>Liest ein Roboterprogramm in den Auftrag ein</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_ImportResult</name>
    <message>
        <source>Brings back what beltgrind computed on another machine</source>
        <translation>Holt zurück, was beltgrind auf einem anderen Rechner berechnet hat</translation>
    </message>
    <message>
        <source>Import result...</source>
        <translation>Ergebnis einlesen...</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Job</name>
    <message>
        <source>Makes a grinding job of the selected faces or part</source>
        <translation>Erstellt einen Schleifauftrag aus den gewählten Flächen oder dem Werkstück</translation>
    </message>
    <message>
        <source>New job</source>
        <translation>Neuer Auftrag</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Manual</name>
    <message>
        <source>Help</source>
        <translation>Hilfe</translation>
    </message>
    <message>
        <source>Opens the manual: tutorial, every panel, troubleshooting</source>
        <translation>Öffnet das Handbuch: Einführung, alle Fenster, Fehlersuche</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_OpenJob</name>
    <message>
        <source>Makes document objects of a job.json</source>
        <translation>Macht aus einer job.json Objekte im Dokument</translation>
    </message>
    <message>
        <source>Open job file...</source>
        <translation>Auftragsdatei öffnen...</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Plan</name>
    <message>
        <source>Looks for the feeds and forces with which the programs bring the part into tolerance</source>
        <translation>Sucht die Vorschübe und Kräfte, mit denen die Programme das Teil in Toleranz bringen</translation>
    </message>
    <message>
        <source>Plan feeds...</source>
        <translation>Vorschübe planen...</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Playback</name>
    <message>
        <source>Playback</source>
        <translation>Wiedergabe</translation>
    </message>
    <message>
        <source>Shows the recorded simulation at any moment, under the 3D view</source>
        <translation>Zeigt die aufgezeichnete Simulation zu jedem Zeitpunkt, unter der 3D-Ansicht</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_RasterPath</name>
    <message>
        <source>Lays contact passes side by side on the selected faces, or on all faces of the job</source>
        <translation>Legt Kontaktbahnen nebeneinander auf die gewählten Flächen oder auf alle Flächen des Auftrags</translation>
    </message>
    <message>
        <source>Raster path...</source>
        <translation>Zeilenbahn...</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_ReadAgain</name>
    <message>
        <source>Read programs again</source>
        <translation>Programme neu einlesen</translation>
    </message>
    <message>
        <source>Reads the job&apos;s robot programs from their files again</source>
        <translation>Liest die Roboterprogramme des Auftrags erneut aus ihren Dateien</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Report</name>
    <message>
        <source>Report...</source>
        <translation>Bericht...</translation>
    </message>
    <message>
        <source>Writes verdict, pictures, events and the job itself into one HTML or PDF file</source>
        <translation>Schreibt Urteil, Bilder, Ereignisse und den Job selbst in eine HTML- oder PDF-Datei</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Scan</name>
    <message>
        <source>Compare a scan...</source>
        <translation>Scan vergleichen...</translation>
    </message>
    <message>
        <source>Lays a scan of the ground part on the design and compares it with the prediction</source>
        <translation>Legt einen Scan des geschliffenen Teils auf das Soll und vergleicht ihn mit der Vorhersage</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Section</name>
    <message>
        <source>Cross-section</source>
        <translation>Querschnitt</translation>
    </message>
    <message>
        <source>Cuts the result: design, stock and ground profile along a plane or between two points</source>
        <translation>Schneidet das Ergebnis: Soll-, Rohteil- und Schliffprofil entlang einer Ebene oder zwischen zwei Punkten</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Simulate</name>
    <message>
        <source>Grinds the job; FreeCAD stays usable</source>
        <translation>Schleift den Auftrag; FreeCAD bleibt bedienbar</translation>
    </message>
    <message>
        <source>Simulate</source>
        <translation>Simulieren</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Stock</name>
    <message>
        <source>Says what stock lies on the design faces</source>
        <translation>Legt fest, welches Aufmaß auf den Sollflächen liegt</translation>
    </message>
    <message>
        <source>Stock</source>
        <translation>Rohteil</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Study</name>
    <message>
        <source>Simulates the job many times with other values: yield, what matters most, the best setting</source>
        <translation>Simuliert den Auftrag viele Male mit anderen Werten: Ausbeute, was am meisten ausmacht, die beste Einstellung</translation>
    </message>
    <message>
        <source>Study...</source>
        <translation>Studie...</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Verdict</name>
    <message>
        <source>In tolerance or not, where not, and which motion of the program did it</source>
        <translation>In Toleranz oder nicht, wo nicht, und welche Bewegung des Programms es war</translation>
    </message>
    <message>
        <source>Verdict</source>
        <translation>Urteil</translation>
    </message>
</context>
<context>
    <name>BeltGrinding_Zones</name>
    <message>
        <source>Gives faces, edges and the thickness tolerances of their own</source>
        <translation>Gibt Flächen, Kanten und der Dicke eigene Toleranzen</translation>
    </message>
    <message>
        <source>Tolerance zones...</source>
        <translation>Toleranzzonen...</translation>
    </message>
</context>
<context>
    <name>QObject</name>
    <message>
        <source>Belt grinding</source>
        <translation>Bandschleifen</translation>
    </message>
</context>
<context>
    <name>Workbench</name>
    <message>
        <source>&amp;Belt grinding</source>
        <translation>&amp;Bandschleifen</translation>
    </message>
    <message>
        <source>Belt grinding</source>
        <translation>Bandschleifen</translation>
    </message>
    <message>
        <source>What a robot&apos;s belt grinding will leave, before any metal is ground</source>
        <translation>Was das Bandschleifen mit dem Roboter übrig lässt, bevor geschliffen wird</translation>
    </message>
    <message>
        <source>Belt grinding: judge</source>
        <translation>Bandschleifen: Beurteilen</translation>
    </message>
    <message>
        <source>Belt grinding: paths</source>
        <translation>Bandschleifen: Bahnen</translation>
    </message>
    <message>
        <source>Belt grinding: run</source>
        <translation>Bandschleifen: Simulieren</translation>
    </message>
    <message>
        <source>Belt grinding: set up</source>
        <translation>Bandschleifen: Einrichten</translation>
    </message>
    <message>
        <source>Examples</source>
        <translation>Beispiele</translation>
    </message>
    <message>
        <source>Exchange</source>
        <translation>Austausch</translation>
    </message>
</context>
</TS>
