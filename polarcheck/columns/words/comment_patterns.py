r"""
The patterns of what comments state: the bar, the cutter, shape, size and depth of the part, and tools by their number.

Of each subject a Subject has the words without which a comment says nothing of it, the words with which it means
something else, the forms in which its size is written, and the sizes that it can have. They are for a comment in upper
case and of at most LONGEST characters (comment_reader.plain_text). `re` compiles a pattern at its first use and keeps
it: to compile all of them takes longer than a small check.

No text may cost more than its length: a repeat takes all it can and gives nothing back (`++`), and a number is tried at
the first of its digits only.
"""

from __future__ import annotations

from typing import Final

import msgspec

from polarcheck.foundation.states import MM_PER_INCH

#: No note is longer [characters]. Some patterns cost more than the length of their text, and so little of so much.
LONGEST: Final = 400
#: A number as a group: whole and fraction, fraction, decimals with a point or a comma.
NUMBER: Final = (
    r"((?<![\d.])\d++(?:\s++|\s*+-\s*+)\d++/\d++(?![\d/.])|(?<![\d/.])\d++\s*+/\s*+\d++(?![\d/])"
    r"|(?<!\d)(?<!\d[.,])\d++(?:[.,]\d++)?+(?![.,]\d|/)\.?+|(?<!\d)\.\d++)"
)
#: Its unit as a group, which may be missing.
UNIT: Final = r"(?:\s*+(\"|''|\u201d|INCH(?:ES)?+\b|IN\b\.?+|ZOLL\b|MM\b))?+"
#: Nothing may be written at the end of a number and its unit that would make it another one: 16H7, 4FL, 10%.
_ENDS = r"(?![\w%/#\u00b0])(?![.,]\d)"
_SIZE = NUMBER + UNIT
_VALUE = _SIZE + _ENDS
_IS = r"\s*+[=:-]?+\s*+"


class Form(msgspec.Struct, frozen=True):
    """
    A form in which a comment states a size.

    gives: of what the size is.
    pattern: has the number and its unit as groups 1 and 2.
    words: one of them stands in each comment of this form; empty for any. They spare the pattern of the others.
    """

    gives: str
    pattern: str
    words: tuple[str, ...] = ()


class Subject(msgspec.Struct, frozen=True):
    """
    What a comment may state the size of.

    words: one of them stands in each comment that states it; empty where any may.
    never: found in comments that mean something else.
    forms: in the order in which they are tried.
    least, largest: it is larger than the one and smaller than the other [mm].
    largest_in_inch: a number without a unit in a program in inch is none above it [mm].
    """

    words: tuple[str, ...]
    never: str
    forms: tuple[Form, ...]
    least: float
    largest: float
    largest_in_inch: float


# ---- the bar: BAR DIA 28, STOCK D50, RD 40, HEX BAR 32 ----

_BAR = r"BAR(?:\s*+-?STOCK)?+\b"
_NOUN = (
    rf"\b(?:{_BAR}|STOCK\b|BLANK\b|BILLET\b|MATERIAL\b|MATL?\b\.?|ROHTEIL\b|ROHLING\b|STANGE\b|RUNDSTAHL\b"
    r"|RUNDMATERIAL\b)"
)
_ROUND = (
    r"(?:DIA(?:M(?:ETER|ETRE)?)?\b\.?|D(?=\s*[=:]?\s*[\d.])|O\.?D\b\.?|\u00d8|\u2300|ROUND\b(?:\s+BAR\b)?"
    r"|RD(?![A-Z])\.?|RUND\b)"
)
_ROUND_WORD = r"(?:DIA(?:M(?:ETER|ETRE)?)?\b\.?|O\.?D\b\.?|ROUND\b|RD\b)"
_BAR_AF = r"(?:AF\b|A/F\b|ACROSS\s+FLATS\b|SW(?![A-Z]))"
HEXAGON_BAR: Final = r"\b(?:HEX(?:AGON(?:AL)?)?(?![A-Z])|SECHSKANT|6-?KT|6-?KANT)"
_AT_HEAD = rf"^\s*+(?:{_NOUN}{_IS})?"
#: The form in which a hexagon that is cut from a bar may stand beside the bar.
BESIDE_HEXAGON: Final = Form("round", rf"{_NOUN}{_IS}{_ROUND}{_IS}{_VALUE}")  # BAR DIA 28, MATERIAL RD 40
#: Without a unit, a point or a fraction it may be a pressure: 1.25" BAR, 5" 6061 ALUMINUM BARSTOCK.
SIZE_BEFORE_BAR: Final = Form(
    "round", rf"{_AT_HEAD}{_SIZE}[\s-]+(?:[A-Z0-9]++[\s-]++){{0,4}}?(?:{_BAR})(?=\s*+(?:$|[,;.\d]))"
)
BAR: Final = Subject(
    words=("BAR", "STOCK", "RD", "MAT", "BLANK", "BILLET", "ROH", "STANGE", "RUND"),
    # Tools, pressures, tubes, bars that are neither round nor hexagons, and allowances.
    never=(
        r"\bBOR(?:ING|E|ED)\b|PRESSURE|COOLANT|\bPSI\b|\bTUB|\bPIPE|\bLARGER|\bOVERSIZE|\bSQUARE\b|\bSQ\b|\bFLAT\b|KNURL"
        r"|\bDRILL|\bTAP\b|REAM|\bINSERT|\bTOOL|\bHOLDER|\bSHANK|\b[CDVSTW][CNP][MG][GTNA]\b|\bI\.?D\b|\bMIN\b|\bMAX\b|\bOR\b"
        r"|\bLEAVE|\bALLOW|\bREMOV|\bGRIP|\bSTEADY|\bX\s*+(?:D|\u00d8|DIA)\s*+[\d.]|^\s*+T\s?\d"
    ),
    forms=(
        Form("hexagon", rf"{_NOUN}{_IS}{HEXAGON_BAR}\s*+(?:{_BAR_AF})?{_IS}{_VALUE}"),  # STOCK HEX 32, BAR HEX AF 32
        Form("hexagon", rf"{HEXAGON_BAR}[\s-]*+{_NOUN}\s*+(?:{_BAR_AF})?{_IS}{_VALUE}"),  # HEX BAR 32
        Form("hexagon", rf"{HEXAGON_BAR}{_IS}{_SIZE}\s*+(?:{_BAR_AF})?\s*+{_NOUN}"),  # HEX 32 BAR, HEX 32 AF STOCK
        Form("hexagon", rf"{_AT_HEAD}{_SIZE}\s*+(?:{_BAR_AF})?\s*+{HEXAGON_BAR}[\s-]*+{_NOUN}"),  # 1 1/4 AF HEX STOCK
        BESIDE_HEXAGON,
        Form("round", rf"{_NOUN}{_IS}{_SIZE}\s*+{_ROUND_WORD}"),  # STOCK 28 DIA
        Form("round", rf"^\s*+(?:(?:ROUND|RUND)\s++)?+{_BAR}{_IS}{_VALUE}\s*+(?:$|[,;])"),  # BAR 28, ROUND BAR: 28
        Form("round", rf"^\s*+ROUND\s++STOCK{_IS}{_VALUE}\s*+(?:$|[,;])"),
        Form("round", rf"{_AT_HEAD}{_SIZE}[\s-]*+{_ROUND_WORD}[\s-]*+(?:{_BAR}|STOCK\b)"),  # 28 DIA BAR
        Form("round", rf"{_AT_HEAD}{_ROUND}{_IS}{_VALUE}[\s-]*+(?:{_BAR}|STOCK\b|BLANK\b)"),  # DIA 28 BAR
        Form("round", rf"^\s*+RD(?![A-Z])\.?{_IS}{_VALUE}"),  # RD 40
        SIZE_BEFORE_BAR,
    ),
    least=2.99,
    largest=1000.01,
    largest_in_inch=20 * MM_PER_INCH,
)
#: In front of the bar these say that something else is meant.
NOT_BEFORE_BAR: Final = r"\bCHUCK|\bJAWS?\b|\bCLAMP|\bTURN|\bFACE|\bFINISH|\bROUGH|\bCUT|\bMILL|\bNOT?\b"

# ---- the part: HEX 24 AF, SQ 20, FLATS 22, DIA 30 BOSS, 5 DEEP ----

_AF = r"(?:A/?F\b|A\.F\.?|ACROSS\s++(?:THE\s++)?FLATS\b|SW(?![A-Z]))"
ACROSS_FLATS: Final = rf"(?<![A-Z]){_AF}"
_PART_DIAMETER = r"(?:DIA(?:M(?:ETER)?)?\b\.?|D(?=\s*+=?\s*+[\d.])|\u00d8|\u2300)"
#: A number that is followed by one of these is another size, or counts.
_NOT_AFTER = (
    r"(?!\s*+-?(?:X|BY\b|/|BAR|STOCK|DEEP|LONG|WIDE|HIGH|THICK|SIDES|POINT"
    r"|PL[AC]|OFF\b|P[CT]S|DEG|TIMES|OF\b|FL\b|TPI|PITCH))"
)
_ROUND_PART = r"(?:BOSS\b|PIN\b(?!\s*+HOLE)|ECC(?:ENTRIC)?\b)"
_ROUND_PARTS = "BOSS", "PIN", "ECC"
_AF_WORDS = "AF", "A/F", "A.F", "ACROSS", "SW"
_WHOLE = r"(?<![\w.,/-])"


def _polygon(name: str, word: str, *words: str) -> tuple[Form, ...]:
    return (
        Form(name, rf"{_WHOLE}{word}{_IS}(?:{_AF}{_IS})?{_VALUE}{_NOT_AFTER}", words),  # HEX 24 AF, SQUARE 20
        Form(name, rf"{_WHOLE}{_SIZE}[\s-]*+{_AF}[\s-]*+{word}", words),  # 24 AF HEX
        Form(name, rf"^{_SIZE}[\s-]++{word}\s*+$", words),  # 24MM HEX
    )


#: Sizes across flats, or diameters; `gives` is empty where any shape has such a size: it counts where no other does.
PART_SIZE: Final = Subject(
    words=("HEX", "SQ", "OCT", "PENT", "FLATS", "BOSS", "PIN", "ECC", "KEYWAY", "AF", "A/F", "A.F", "SW", "KANT", "KT"),
    # What is not cut here, or not to its size.
    never=(
        r"SOCKET|\bKEY\b|\bNUT\b|\bBOLT|SCREW|WRENCH|SPANNER|BROACH|\bBUSH|\bJAW|COLLET|CHUCK|\bGRIP|\bHOLD|\bCLAMP"
        r"|\bBEFORE\b|\bPRE-?|\bA/?C\b|CORNERS|\bINSIDE\b|INTERNAL|\bNOT\b|\bWAS\b|\bOLD\b|\bDONE\b|\bLATER\b|\bOTHER\b"
        r"|\bNEXT\b|\bOP\s?\d|\bMIN\b|\bMAX\b|\bOR\b|\bM\d"
    ),
    forms=(
        *_polygon("hexagon", r"(?:HEX(?:AGON)?|SECHSKANT|6-?KT|6-?KANT)(?![A-Z])", "HEX", "SECHSKANT", "6K", "6-K"),
        *_polygon("square", r"(?:SQ(?:UARE)?|VIERKANT|4-?KT|4-?KANT)(?![A-Z])", "SQ", "VIERKANT", "4K", "4-K"),
        *_polygon("octagon", r"OCT(?:AGON)?(?![A-Z])", "OCT"),
        *_polygon("pentagon", r"PENT(?:AGON)?(?![A-Z])", "PENT"),
        Form("flats", rf"{_WHOLE}FLATS{_IS}(?:AT\s++|{_AF}{_IS})?{_VALUE}{_NOT_AFTER}", ("FLATS",)),
        Form("boss", rf"{_WHOLE}{_PART_DIAMETER}{_IS}{_VALUE}\s*+(?:ROUND\s++)?{_ROUND_PART}", _ROUND_PARTS),
        Form("boss", rf"{_WHOLE}{_ROUND_PART}{_IS}{_PART_DIAMETER}{_IS}{_VALUE}{_NOT_AFTER}", _ROUND_PARTS),
        Form("boss", rf"{_WHOLE}{_SIZE}\s*+{_PART_DIAMETER}\s*+{_ROUND_PART}", _ROUND_PARTS),
        Form("keyway", rf"{_WHOLE}KEYWAY{_IS}{_VALUE}(?!\s*+-?(?:DEEP|LONG|PL[AC]|OFF\b|P[CT]S|DEG))", ("KEYWAY",)),
        Form("", rf"{_WHOLE}{_SIZE}\s*+{_AF}", _AF_WORDS),
        Form("", rf"{_WHOLE}(?:A/?F|SW){_IS}{_VALUE}{_NOT_AFTER}", _AF_WORDS),
    ),
    least=2.0,
    largest=500.0,
    largest_in_inch=12 * MM_PER_INCH,
)
#: Behind FROM, and behind the name of a bar, stands the size of the bar; it counts to the next comma.
FROM_BAR: Final = r"\b(?:FROM|AUS)\b"
NAME_OF_BAR: Final = rf"{_NOUN}|\bROH\b"
#: The diameter of a part in its title.
TITLE_DIAMETER: Final = Form(
    "round", rf"{_WHOLE}(?:DIA(?:M(?:ETER)?)?\b\.?|\u00d8|\u2300){_IS}{_VALUE}", ("DIA", "\u00d8", "\u2300")
)
PART_DEPTH: Final = Subject(
    words=("DEPTH", "DEEP"),
    # Depths of cuts, and of what this section does not cut.
    never=(
        r"OF\s++CUT|\bCUT\b|\bPASS|\bPER\b|\bSTEP|\bPECK|DRILL|\bHOLE|\bTAP\b|THREAD|\bCHUCK|\bJAW|\bBORE|\bBORING|\bGRIP"
        r"|\bGROOVE|\bFLATS?\b|\bKEY|\bMIN\b|\bMAX\b|\bOR\b|\bNOT\b|\bWAS\b|\bOLD\b|\bDONE\b|\bOP\s?\d|CHAMF|REAM|SPOT|\bEACH\b|\bFEED\b|\bTOTAL\b"
    ),
    forms=(
        Form("depth", rf"{_WHOLE}DEPTH(?:\s++OF(?=\s++[\d.]))?{_IS}{_VALUE}{_NOT_AFTER}"),  # DEPTH 5, DEPTH OF 5MM
        Form("depth", rf"{_WHOLE}{_SIZE}\s*+(?:DEEP|DEPTH)\b"),  # 5 DEEP
    ),
    least=0.0,
    largest=500.0,
    largest_in_inch=12 * MM_PER_INCH,
)

# ---- metal that is left: ROUGH, LEAVE 0.3, SCHRUPPEN ----

_LEAVES = (
    r"(?:\bLEAV(?:E|ES|ING)\b|\bALLOWANCE\b|\bSTOCK\b|AUFMA(?:SS|\u00df)\b|\bUEBERMASS\b|\bSUR.PAISSEUR\b"
    r"|\bSOVRAMETALLO\b)"
)
#: Words by which a tool leaves metal for another one, by language: English, German, French, Italian, Spanish. Each has
#: one of the words of ALLOWANCE.
ROUGHING: Final = (
    r"\bROUGH|\bSEMI-?\s?FIN|\bLEAV(?:E|ES|ING)\b|\bALLOW|SCHRUPP|AUFMA(?:SS|\u00df)\b|\bUEBERMASS\b|BAUCHE"
    r"|\bSUR.PAISSEUR\b|SGROSS|\bSOVRAMETALLO\b|DESBAST"
)
#: STOCK of 2 mm and more is a bar.
ALLOWANCE: Final = Subject(
    words=(
        *("ROUGH", "SEMI", "LEAV", "ALLOW", "STOCK", "LEFT", "SCHRUPP", "AUFMA", "UEBERMASS", "BAUCHE", "PAISSEUR"),
        *("SGROSS", "SOVRAMETALLO", "DESBAST"),
    ),
    never=r"(?!)",
    forms=(
        Form(
            "allowance", rf"{_LEAVES}(?:\s++(?:STOCK|FOR|ON|OF|SIDE|WALLS?|FINISH\w*+)\b){{0,4}}{_IS}{_VALUE}"
        ),  # LEAVE 0.3
        Form("allowance", rf"{_WHOLE}{_SIZE}\s*+(?:{_LEAVES}|LEFT\b)"),  # 0.3 STOCK
    ),
    least=0.0,
    largest=2.0,
    largest_in_inch=2.0,
)

# ---- the cutter: EM10, 8MM DIA. CUTTER, T9 END MILL D12 ----

_EQUALS = r"\s*+[=:]?+\s*+"
#: The rest of a word such as DIAMETER; digits behind it are the number, as in DIA16.
_LETTERS = r"[^\W\d]*+"
_DIAMETER = rf"(?:\bDIA{_LETTERS}\.?+|(?<![\w/-])D|\u00d8|\u2300)"
_OF_OTHERS = r"(?:FREZA|FRESA|FRAISE|\b\w*+(?<=FRAESER)|\b\w*+(?<=FR\u00c4SER))"
#: Words that name a cutter and are no verbs, and MILL, which may be one: MILL 2 FLATS.
#: EM is a word of other languages: it counts at the end, before what an end mill may have, and glued to its size.
_EM = r"(?:E/M|E\.M\.?|EM)(?![A-Z])"
_EM_LAST = rf"{_EM}(?=\s*+(?:$|[,;:()#-]|\d++\s?-?F|R\s?[\d.]|CARB|HSS|SOLID|COATED|ROUGH|FINISH|FOR\b|X\s?[\d.]))"
_EM_FIRST = (
    rf"(?:(?:^|[,;:-]|\bT\s?\d{{1,8}}+|ROUGH(?:ING)?|FINISH(?:ING)?|CARB(?:IDE)?|FLAT|HSS|MM)\s*+{_EM}"
    r"|EM(?=-?\d|-?\.\d))"
)
_NAMED = (
    r"END\s*+-?MILL|(?:FACE|SHELL|BALL|SLOT)\s*+MILL|SLOT\s*+DRILL|CUTTER(?![A-Z])"
    rf"|{_OF_OTHERS}"
)
#: What may stand between the size of a cutter and its name.
_KIND = (
    r"(?:DIA(?:M(?:ETER)?)?\b\.?|\u00d8|FLAT|SQUARE|BALL|BULL|NOSED?|ROUGH(?:ING|ER)?|FINISH(?:ING|ER)?|SOLID|CARB(?:IDE)?\.?"
    r"|HSS|VHM|HM|COBALT|COATED|STUB|LONG|SHORT|\d\s*-?FL(?:UTED?|T)?|\dF)"
)
_KINDS = rf"(?:[\s-]*+{_KIND}(?![A-Z])){{0,5}}"
#: A number behind the name of a cutter that counts something.
_COUNTS = (
    r"(?!\s*+-?\s*+(?:FL|F\b|TEETH|TOOTH|Z\b|EDGE|X|DEG|PASS|PL[AC]|TIMES|OFF\b|P[CT]S|CUTS?\b|MIN|HRS?\b|DEEP|LONG|LOC\b|OF\b"
    r"|AF\b|A/F|SIDE|FLATS|HOLE|SLOT|POCKET|PART|TOOL))"
)
#: A size before MILL, which may be a verb; the third group says that it is a diameter.
MILL: Final = Form("diameter", rf"{_SIZE}({_KINDS})[\s-]*+MILL\b")
#: Number before name, name before number, each with what says that it is a diameter between.
CUTTER: Final = Subject(
    words=(),
    # Tools that are no mills, and mills whose size says nothing of R.
    never=(
        r"DRILL|BROCA|\bFUR[AO]|FORET|BOHR|BORR|REAM|\bTAP\b|BOR(?:ING|E|ED)\b|CHAMF|SPOT|SINK|ENGRAV|DEBURR|INSERT\b|\bTURN"
        r"|\b[CDVSTW][CNP][MG][GTNA]\b|\bID\b|\bOD\b|THREAD\s*+TURN"
    ),
    forms=(
        Form("diameter", rf"(?:{_DIAMETER}{_EQUALS})?{_SIZE}{_KINDS}[\s-]*+(?<![A-Z])(?:{_NAMED}|{_EM_LAST})"),
        Form(
            "diameter",
            rf"(?<![A-Z])(?:{_NAMED}|{_EM_FIRST})[\s:=-]*+(?:{_DIAMETER}{_EQUALS})?{_VALUE}{_COUNTS}",
        ),
        Form("diameter", rf"(?<![A-Z])(?:{_NAMED}|{_EM}){_KINDS}[\s,:=-]*+{_DIAMETER}{_EQUALS}{_SIZE}"),
        MILL,
    ),
    least=0.0,
    largest=200.0,
    largest_in_inch=3 * MM_PER_INCH,
)
#: Sizes in a comment that names no cutter; diameters before radii: posts write both, as in `D=12. CR=0.`, where CR is
#: the radius of the corner.
SIZE_ALONE: Final = (
    Form("diameter", rf"{_DIAMETER}{_EQUALS}{_SIZE}"),
    Form("diameter", rf"{_SIZE}[\s-]*+DIA"),
    Form("radius", rf"(?:(?<![A-Z])R|\bRAD{_LETTERS}){_EQUALS}{_SIZE}"),
)
ANY_CUTTER: Final = rf"(?<![A-Z])(?:{_NAMED}|{_EM})"
#: What stands before a number that counts tools, operations, sides.
COUNTED: Final = (
    r"(?:\b(?:TOOL|T|NO|NR|NUMBER|OP|OPER\w*|STEP|STATION|POS\w*|TURRET|SIDE|PART|PASS|N|O|M|G|H|REV|OFFSET|PROG\w*|HEX"
    r"|SQ|SQUARE|FLATS?)\.?|#)[\s:#=-]*+$|[A-Z]$|=\s?-?$"
)
#: What is milled, where MILL is a verb.
MILLED: Final = r"\bHEX|\bSQ|\bFLATS?\b|\bA/?F\b|\bSLOT|\bKEY|\bPOCKET|\bBOSS|\bDEEP|\bDEPTH|\bWIDE"
#: Words beside the size of a cutter without a name. With any other the size may be that of anything.
BESIDE_SIZE: Final = (
    r"T|TOOL|D|DIA|DIAM|DIAMETER|R|RAD|RADIUS|CR|ZMIN|ZMAX|L|LOC|LIVE|DRIVEN|AXIAL|RADIAL|HSS|VHM|HM|CARBIDE|SOLID|MM|INCH"
    r"|IN|FL|FLUTES?|Z|ROUGH|ROUGHING|FINISH|FINISHING|MILLING|MILL|FLAT|PROFILE|X|NO|OFFSET"
)
#: Radii that are not those of the cutter.
OTHER_RADIUS: Final = r"NOSE|CORNER|FILLET|\bTIP|\bEDGE|\bEND\s*+-?MILL|\bBULL|\bE/?M\b"

# ---- tools by their number ----

#: What a comment says of a tool behind its number. With anything else T6 may be a temper, and T10 a wrench.
KIND_OF_TOOL: Final = (
    r"\bEND\s?-?MILL|\bE[./]?M\b|\bEM\d|MILL\b|CUTTER|DRILL|\bTAP\b|REAM|\bTURN|\bBOR(?:E|ING)\b|GROOV|THREAD|\bFACE\b|FACING"
    r"|\bSPOT\b|CHAMF|\bPART(?:ING|\s?OFF)|CUT\s?-?OFF|KNURL|FREZA|FRESA|FRAISE|FR(?:AE|\u00c4)SER|BOHR|BROCA|FORET"
    r"|\bD\s*=?\s*[\d.]|\bDIA|\bROUGH|\bFINISH|\b[CDVSTW][CNP][MG][GTNA]\b|\bLIVE\b|\bTOOL\b"
)
#: Words by which a comment speaks of a tool that need not be the one beside it.
OTHER_TOOL: Final = (
    r"\bNEXT\b|PRESELECT|\bREADY\b|\bWAS\b|\bOLD\b|\bALT|\bSPARE\b|SISTER|BACK-?UP|REPLAC|\bOR\b|\bSAME\b|\bSEE\b|\bAFTER\b"
    r"|\bBEFORE\b|\bDONE\b|\bOFFSET|\bTORX|\bPREV|\bLIKE\b|\bUSED\b|\bINSTEAD|->|\bTO\b|\bFROM\b"
)
