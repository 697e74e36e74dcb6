"""The keywords of a high-level language that turn the flow or define something: GOTOF, IF, FOR, CASE, DEF, CALL."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final

from msgspec.structs import replace

from polarcheck.program.execution.arithmetic import UNKNOWN
from polarcheck.program.execution.expression import Expression, Step, constant
from polarcheck.program.execution.language_tokens import Token
from polarcheck.program.execution.programs import Search
from polarcheck.program.execution.spoken_block import SpokenBlock
from polarcheck.program.execution.statement import Kind, Parameter, Statement, Word

#: Where each jump looks for its label.
SEARCHES: Final = {
    "GOTO": Search.ROUND,
    "GOTOF": Search.FORWARD,
    "GOTOB": Search.BACKWARD,
    "GOTOC": Search.IF_THERE,
}
#: A variable or a program may have a name of one letter, where it is defined.
_NAMES: Final = ("name", "letter")
_SCOPES: Final = {"NCK", "CHAN", "SYNR", "SYNW", "SYNRW", "VAR"}
#: Types of variables, and the value before the first assignment.
TYPES: Final = {
    "REAL": 0.0,
    "INT": 0.0,
    "BOOL": 0.0,
    "CHAR": 0.0,
    "STRING": UNKNOWN,
    "AXIS": UNKNOWN,
    "FRAME": UNKNOWN,
}


def _jump(block: SpokenBlock, kind: Kind, first: Token, condition: Expression | None = None) -> None:
    """GOTOF and its like with what they name; the keyword is the next token."""
    search = SEARCHES[block.token.text]
    block.at += 1
    token = block.token
    statement = Statement(kind, first.start, token.end, condition=condition, search=search)
    if token.kind == "name" and not (block.is_sign("(", 1) or block.is_sign("[", 1)):
        block.at += 1
        if block.names.is_declared(token.text):  # a text that names the label
            block.leave_unread(token.text, token)
            return
        block.add(replace(statement, label=token.text))
        return
    if token.text in ("N", ":") and block.tokens[min(block.at + 1, len(block.tokens) - 1)].text.isdigit():
        block.at += 1
        number = block.take_token()
        block.add(replace(statement, end=number.end, jump=constant(float(number.text), token.start, number.end)))
        return
    block.leave_rest(first)


def _goto(block: SpokenBlock, first: Token) -> None:
    block.at -= 1
    _jump(block, Kind.GOTO, first)


def _structure(
    block: SpokenBlock, first: Token, condition: Expression | None = None, **more: Expression | None
) -> None:
    block.add(
        Statement(Kind.STRUCTURE, first.start, block.last_end, structure=first.text, condition=condition, **more)  # type: ignore[arg-type]
    )


def _if(block: SpokenBlock, first: Token) -> None:
    condition = block.expression()
    if block.token.text in SEARCHES:
        _jump(block, Kind.IF_GOTO, first, condition)
    else:
        _structure(block, first, condition)


def _with_condition(block: SpokenBlock, first: Token) -> None:
    _structure(block, first, block.expression())


def _for(block: SpokenBlock, first: Token) -> None:
    """FOR R1=1 TO 5: the variable, its first value, and the condition under which it goes on."""
    if block.token.kind == "name":
        block.names.declare(block.token.text)
    variable = block.expression()
    if variable is None or variable.steps[-1].name != "#" or not block.take_sign("="):
        block.leave_rest(first)
        return
    start = block.expression()
    is_whole = block.token.text == "TO"
    block.at += is_whole
    last = block.expression() if is_whole else None
    if start is None or last is None:
        block.wrong("format", first, block.token)
        return
    span = first.start, last.end
    condition = Expression((*variable.steps, *last.steps, Step("LE", 0.0, *span)), *span)
    target = replace(variable, steps=variable.steps[:-1])
    _structure(block, first, condition, target=target, value=start)


def _repeat(block: SpokenBlock, first: Token) -> None:
    """REPEAT alone begins a loop up to UNTIL; REPEAT BEGIN END P=3 runs what stands between labels again."""
    if block.token.kind == "end":
        _structure(block, first)
        return
    labels: list[str] = []
    while block.token.kind == "name" and len(labels) < 2:
        labels.append(block.token.text)
        block.at += 1
    times = None
    if block.token.text == "P":
        block.at += 1
        block.take_sign("=")
        times = block.expression()
    if not labels or block.token.kind != "end":
        block.leave_rest(first)
        return
    until = labels[-1] if len(labels) > 1 or first.text == "REPEATB" else ""
    block.add(Statement(Kind.REPEAT, first.start, block.last_end, label=labels[0], until=until, value=times))


def _case(block: SpokenBlock, first: Token) -> None:
    """CASE R1 OF 1 GOTOF A 2 GOTOF B DEFAULT GOTOF C: one jump behind the other."""
    selector = block.expression()
    if selector is None or block.token.text != "OF":
        block.leave_rest(first)
        return
    block.at += 1
    while block.token.kind != "end":
        begin = block.token
        if begin.text == "DEFAULT":
            block.at += 1
            condition = None
        else:
            label = block.expression()
            if label is None:
                return
            steps = (*selector.steps, *label.steps, Step("EQ", 0.0, begin.start, label.end))
            condition = Expression(steps, begin.start, label.end)
        if block.token.text not in SEARCHES:
            block.leave_rest(first)
            return
        _jump(block, Kind.GOTO if condition is None else Kind.IF_GOTO, begin, condition)


def _type(block: SpokenBlock) -> str:
    """The type that follows, with its scope before it; "" where there is none."""
    while block.token.text in _SCOPES:
        block.at += 1
    name = block.token.text
    if name not in TYPES:
        return ""
    block.at += 1
    block.arguments()
    return name


def _define(block: SpokenBlock, first: Token) -> None:
    """DEF REAL A, B=5: each variable takes its first value."""
    kind = _type(block)
    while kind and block.token.kind in _NAMES:
        token = block.take_token()
        if block.is_sign("["):
            block.arguments()
            block.leave_unread(f"{token.text}[]", token, matters=False)
            if block.take_sign("="):
                block.leave_unread(f"{token.text}[]=", token, matters=False)
                block.at = len(block.tokens) - 1
        else:
            block.names.declare(token.text)
            value = None if block.take_sign("=") else constant(TYPES[kind], token.start, token.end)
            block.assign(block.variable(token), token, value)
        if not block.take_sign(","):
            break
    if not kind or block.token.kind != "end":
        block.leave_rest(first)


def _procedure(block: SpokenBlock, first: Token) -> None:
    """PROC NAME(REAL A, INT B=3): what a call hands over."""
    parameters = []
    block.at += block.token.kind in _NAMES
    if block.take_sign("("):
        while block.token.kind == "name":
            if block.token.text == "VAR":
                block.leave_unread("VAR", block.token)
            if not _type(block) or block.token.kind not in _NAMES:
                break
            token = block.take_token()
            block.arguments()
            default = block.expression() if block.take_sign("=") else None
            parameters.append(Parameter(block.names.declare(token.text), default))
            block.take_sign(",")
        if not block.take_sign(")"):
            block.leave_rest(first)
    block.add(Statement(Kind.PROCEDURE, first.start, block.last_end, parameters=tuple(parameters)))


def call_by_name(block: SpokenBlock, name: str, first: Token) -> None:
    """A call with its arguments and repeats, all behind the name."""
    parameters: list[Parameter] = []
    if block.take_sign("("):
        while block.token.kind != "end" and not block.is_sign(")"):
            given = None if block.is_sign(",") else block.expression()
            parameters.append(Parameter(0, given))
            if not block.take_sign(",") and not block.is_sign(")"):
                break
        if not block.take_sign(")"):
            block.wrong("missing-close-bracket", first, block.token)
    span = first.start, block.last_end
    words = [Word("<", Expression((), *span), name, *span)]
    if block.token.text == "P":
        token = block.take_token()
        block.take_sign("=")
        times = block.expression()
        if times is not None:
            words.append(Word("L", times, None, token.start, times.end))
    if block.token.kind != "end":
        block.leave_rest(first)
        return
    code = block.machine.macro.subprogram_calls[0]
    block.add(Statement(Kind.CALL, *span, words=tuple(words), call=code, parameters=tuple(parameters)))


def _call(block: SpokenBlock, first: Token) -> None:
    """CALL "NAME", also with a path before it."""
    if block.token.text == "BLOCK":
        _call_block(block, first)
        return
    if block.token.kind != "string":
        block.leave_rest(first)
        return
    name = block.token.text.rpartition("/")[2].upper().removeprefix("_N_")
    block.at += 1
    call_by_name(block, name.removesuffix("_SPF").removesuffix("_MPF"), first)


def _call_block(block: SpokenBlock, first: Token) -> None:
    """CALL BLOCK ONE TO TWO: the blocks between two labels of this program."""
    names = block.tokens[block.at + 1 : block.at + 5]
    if [token.kind for token in names] != ["name", "name", "name", "end"] or names[1].text != "TO":
        block.leave_rest(first)
        return
    block.at += 4
    block.add(Statement(Kind.REPEAT, first.start, block.last_end, label=names[0].text, until=names[2].text))


def _return(block: SpokenBlock, first: Token) -> None:
    if block.arguments():
        block.leave_unread("RET( )", first)
    code = block.machine.macro.program_returns[0]
    block.add(Statement(Kind.CALL, first.start, first.end, call=code))


#: What an action sets that changes the feed on the path, or the path itself.
_FEEDS: Final = ("F", "$AC_OVR", "$AC_VC", "$AC_PATHOVR", "$AC_PATHFEED", "OVR", "$AA_OFF", "$AA_TOFF")
#: Independent moves of axes: POS[U]=10, MOV[X]=1.
_AXIS_MOVES: Final = ("POS", "POSA", "MOV", "OS", "FXS", "MEAWA", "MEAC")


def _synchronized(block: SpokenBlock, first: Token) -> None:
    """WHENEVER condition DO actions: it runs beside the blocks, and no condition of it is evaluated here."""
    tokens = block.tokens[block.at - 1 :]
    do = next((index for index, token in enumerate(tokens) if token.text == "DO"), -1)
    block.at = len(block.tokens) - 1
    effects = {_action(block, tokens, index): tokens[index].text for index in range(len(tokens) - 2, do, -1)}
    for effect in ("moves", "path"):
        if effect in effects:
            block.leave_unread(f"synchronized action with {effects[effect]}", first, effect, tokens[-1])
            return


def _action(block: SpokenBlock, tokens: list[Token], index: int) -> str:
    """The effect of what begins with a token of the actions."""
    token, following = tokens[index], tokens[index + 1]
    is_set = following.text in ("=", "[") or following.kind == "number"
    if token.text in _FEEDS and is_set:
        return "path"
    if token.kind == "letter":
        axes = ("X", "Y", "Z", block.machine.polar.rotary_address)
        inside = tokens[max(index - 2, 0)].text in _AXIS_MOVES and tokens[index - 1].text == "["
        return "moves" if (token.text in axes and is_set) or (inside and token.text in axes) else "none"
    if token.kind != "name" or token.text in _AXIS_MOVES:
        return "none"
    name = token.text
    names = (f"{name}=", name, f"{name}[0]=")
    if name.startswith("$"):
        return "none"
    return next((effect for listed in names if (effect := block.effect(listed)) is not None), "none")


def _pass_over(block: SpokenBlock, first: Token) -> None:
    """EXTERN NAME(REAL): tells a name beforehand, and does nothing."""
    block.at = len(block.tokens) - 1


#: What reads each keyword, behind it.
KEYWORDS: Final[Mapping[str, Callable[[SpokenBlock, Token], None]]] = {
    **dict.fromkeys(SEARCHES, _goto),
    "IF": _if,
    **dict.fromkeys(("ELSE", "ENDIF", "ENDWHILE", "ENDFOR", "LOOP", "ENDLOOP"), _structure),
    **dict.fromkeys(("WHILE", "UNTIL"), _with_condition),
    "FOR": _for,
    "REPEAT": _repeat,
    "REPEATB": _repeat,
    "CASE": _case,
    "DEF": _define,
    "PROC": _procedure,
    "EXTERN": _pass_over,
    **dict.fromkeys(("WHEN", "WHENEVER", "EVERY", "FROM", "DO"), _synchronized),
    "CALL": _call,
    "RET": _return,
}
