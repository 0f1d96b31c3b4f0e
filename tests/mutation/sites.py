"""Finds the places in a C++ file where a small fault can be planted, and rewrites them so that the fault is chosen
when the program runs. In: source text. Out: sites, each with the edits of the text that make it switchable."""

import hashlib
import re
from dataclasses import dataclass, field

TOKEN = re.compile(
    r"""(?P<skip>\s+|//[^\n]*|/\*.*?\*/|^[ \t]*\#(?:[^\n\\]|\\.|\\\n)*)
    |(?P<raw>R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)")
    |(?P<string>(?:u8|L)?"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+')
    |(?P<number>(?:\d|\.\d)(?:[eEpP][+-]|[\w.]|'(?=\w))*)
    |(?P<name>[A-Za-z_]\w*)
    |(?P<mark_>::|->\*?|<<=|>>=|<=>|[-+*/%&|^=!<>]=|&&|\|\||\+\+|--|<<|\.\.\.|.)""",
    re.VERBOSE | re.DOTALL | re.MULTILINE)

SWAPS = {"<": ("Less", "<="), "<=": ("LessEqual", "<"), ">": ("Greater", ">="), ">=": ("GreaterEqual", ">"),
         "==": ("Equal", "!="), "!=": ("NotEqual", "=="), "+": ("Plus", "-"), "-": ("Minus", "+"),
         "*": ("Times", "/"), "/": ("Divided", "*")}
CLOSING = {"(": ")", "[": "]", "{": "}"}
NOT_A_CALL = {"if", "for", "while", "switch", "return", "catch", "sizeof", "assert", "static_assert", "throw", "do",
              "else", "case", "delete", "new", "using", "goto", "break", "continue", "default", "template"}
# Without effect by their nature: room taken ahead of time, checks that release builds leave out.
WITHOUT_EFFECT = re.compile(r"(reserve|shrink_to_fit|assert|static_assert|prefetch\w*)$")
KINDS = ("constant", "bound", "condition", "call", "arithmetic")


@dataclass
class Token:
    text: str
    kind: str
    begin: int
    end: int
    partner: int = -1  # index of the bracket that opens or closes with this one
    around: int = -1   # index of the innermost bracket that is open here


@dataclass
class Site:
    kind: str
    begin: int
    end: int
    mutated: str  # what the text from begin to end becomes; whole lines once the site is placed
    edits: list = field(default_factory=list)  # (begin, end, text); "ID" in text stands for the number
    path: str = ""
    line: int = 0
    original: str = ""
    key: str = ""  # names the place over changes elsewhere in the file
    id: int = -1


def tokens_of(text):
    tokens, stack = [], []
    for match in TOKEN.finditer(text):
        kind = match.lastgroup
        if kind == "mark":
            kind = "raw"
        if kind == "skip":
            continue
        token = Token(match.group(), "mark" if kind == "mark_" else kind, match.start(), match.end())
        token.around = stack[-1] if stack else -1
        if token.text in CLOSING:
            stack.append(len(tokens))
        elif token.text in CLOSING.values() and stack:
            token.partner = stack.pop()
            token.around = tokens[token.partner].around
            tokens[token.partner].partner = len(tokens)
        tokens.append(token)
    return tokens


def changed_number(text, choice):
    """Another value of the same type for a literal, or None where there is no sensible one."""
    match = re.fullmatch(r"(0[xX][0-9a-fA-F']+|[\d.']+(?:[eE][-+]?\d+)?)([a-zA-Z]*)", text)
    if not match:
        return None
    digits, suffix = match.groups()
    if digits.lower().startswith("0x"):
        return f"({text} ^ 4{suffix})"
    if not re.search(r"[.eE]", digits):
        value = int(digits.replace("'", ""))
        return f"{value - 1 if value and choice else value + 1}{suffix}"
    value = float(digits.replace("'", ""))
    if value == 0:
        return f"1.0{suffix}"
    return f"({text} * 1.5{suffix})" if choice else f"({text} * 0.5{suffix})"


def constant_sites(tokens, text, shared):
    for i, token in enumerate(tokens):
        if token.text in ("true", "false"):
            mutated = "false" if token.text == "true" else "true"
        elif token.kind == "number":
            before = text[max(0, token.begin - 30):token.end]
            mutated = changed_number(token.text, hashlib.sha256(before.encode()).digest()[0] & 1)
        else:
            continue
        if not mutated or (i and tokens[i - 1].text in ("case", "operator")):
            continue
        edits = [(token.begin, token.end, f"(ASTROSPLAT_MUTANT(ID) ? {mutated} : {token.text})")]
        if not shared:
            edits += no_longer_constexpr(text, token.begin)
        yield Site("constant", token.begin, token.end, mutated, edits)


def no_longer_constexpr(text, position):
    """A constant whose value is chosen at run time is const; those that must be constexpr fail to compile."""
    begin = text.rfind("\n", 0, position) + 1
    match = re.match(r"(\s*(?:static |inline )*)(constexpr) [\w:<> ]+ \w+(?:\[\w*\])? =", text[begin:position])
    if not match:
        return []
    in_class = match.group(1).startswith(" ") and "static" in match.group(1) and "inline" not in match.group(1)
    return [(begin + match.start(2), begin + match.end(2), "inline const" if in_class else "const")]


def operator_sites(tokens, text, shared):
    for i, token in enumerate(tokens):
        if shared or token.text not in SWAPS or text[token.begin - 1] != " " or text[token.end] not in " \n":
            continue
        if token.text in "+-*/" and "string" in (tokens[i - 1].kind, tokens[i + 1].kind):
            continue  # joins texts or paths
        name, mutated = SWAPS[token.text]
        kind = "arithmetic" if token.text in "+-*/" else "bound" if token.text[0] in "<>" else "condition"
        proxy = f"{token.text} ::astrosplat_mutation::{name}<ID>{{}} {token.text}"
        yield Site(kind, token.begin, token.end, mutated, [(token.begin, token.end, proxy)])


def inverted(text, begin, end):
    edits = [(begin, begin, "(ASTROSPLAT_MUTANT(ID) != bool("), (end, end, "))")]
    return Site("condition", begin, end, f"!({text[begin:end]})", edits)


def condition_sites(tokens, text, shared):
    for i, token in enumerate(tokens):
        if token.text in ("if", "while") and i + 1 < len(tokens) and tokens[i + 1].text == "(":
            closing = tokens[tokens[i + 1].partner]
            inside = text[tokens[i + 1].end:closing.begin]
            if tokens[i + 1].partner > 0 and ";" not in inside:
                yield inverted(text, tokens[i + 1].end, closing.begin)
        if token.text == "?":
            begin = operand_begin(tokens, i)
            if begin is not None:
                yield inverted(text, tokens[begin].begin, tokens[i - 1].end)
        if token.text in ("&&", "||") and text[token.begin - 1] == " " and not shared:
            end = operand_end(tokens, i)
            if end is None or end <= i:
                continue
            begin_text, end_text = tokens[i + 1].begin, tokens[end].end
            neutral = "ASTROSPLAT_MUTANT(ID) || " if token.text == "&&" else "!ASTROSPLAT_MUTANT(ID) && "
            edits = [(begin_text, begin_text, f"({neutral}bool("), (end_text, end_text, "))")]
            yield Site("condition", token.begin, end_text, "", edits)


def operand_begin(tokens, i):
    """First token of the condition that ends before the `?` at i."""
    j = i - 1
    while j > 0 and tokens[j].around == tokens[i].around or tokens[j].partner > i:
        text = tokens[j].text
        if text in ("return", "=", ",", ";", ":", "?", "<<") or re.fullmatch(r"[-+*/|&]=", text):
            return j + 1
        if text in (")", "]", "}"):
            j = tokens[j].partner
        j -= 1
    return j + 1 if tokens[j].text in ("(", "[") else None


def operand_end(tokens, i):
    """Last token of the operand that follows the && or || at i."""
    j = i + 1
    while j < len(tokens):
        text = tokens[j].text
        if text in ("&&", "||", ")", "]", "}", ";", ",", "?", ":"):
            return j - 1
        if text in CLOSING:
            if tokens[j].partner < 0:
                return None
            j = tokens[j].partner
        j += 1
    return None


def starts_statement(tokens, i):
    if tokens[i].around < 0 or tokens[tokens[i].around].text != "{":
        return False
    before = tokens[i - 1]
    if before.text in (";", "{", "}", "else"):
        return True
    return before.text == ")" and tokens[before.partner - 1].text in ("if", "for", "while")


def call_sites(tokens, text, shared):
    """Statements that call a function or change a variable, each of them left out."""
    for i, token in enumerate(tokens):
        if token.kind != "name" or token.text in NOT_A_CALL or not starts_statement(tokens, i):
            continue
        j, called = i, token.text
        while j + 1 < len(tokens):
            following = tokens[j + 1]
            if following.text in (".", "->", "::"):
                called, j = tokens[j + 2].text, j + 2
            elif following.text in ("[", "(") and following.partner > 0:
                j = following.partner
            else:
                break
        if j == i or WITHOUT_EFFECT.match(called):
            if not (j == i and re.fullmatch(r"[-+*/|&^]?=|<<=|>>=", tokens[i + 1].text)):
                continue
        end = j + 1
        if re.fullmatch(r"[-+*/|&^]?=|<<=|>>=", tokens[end].text):
            while tokens[end].text != ";":
                end = tokens[end].partner if tokens[end].text in CLOSING else end
                end += 1
        if tokens[end].text != ";" or shared and tokens[i - 1].text in (")", "else"):
            continue
        edits = [(token.begin, token.begin, "if (ASTROSPLAT_MUTANT(ID)) {} else ")]
        yield Site("call", token.begin, tokens[end].end, "", edits)


def in_assertion(text, position):
    line_begin = text.rfind("\n", 0, position) + 1
    return bool(re.search(r"assert\(", text[line_begin:position]))


def sites_of(path, text):
    """All sites of a file, in order."""
    shared = path.endswith(".glsl")
    tokens = tokens_of(text)
    found = []
    for finder in (constant_sites, operator_sites, condition_sites, call_sites):
        found += finder(tokens, text, shared)
    found = [site for site in found if not in_assertion(text, site.begin)]
    seen = {}
    for site in sorted(found, key=lambda site: (site.begin, site.end, site.kind)):
        site.path, site.line = path, text.count("\n", 0, site.begin) + 1
        line_begin, line_end = text.rfind("\n", 0, site.begin) + 1, text.find("\n", site.end)
        line = text[line_begin:text.find("\n", site.begin)].strip()
        mutated = text[line_begin:site.begin] + site.mutated + text[site.end:line_end]
        site.original, site.mutated = " ".join(text[line_begin:line_end].split()), " ".join(mutated.split())
        name = f"{site.kind}|{path.rsplit('/', 1)[-1]}|{line}|{site.begin - line_begin}|{site.end - site.begin}"
        seen[name] = seen.get(name, -1) + 1
        site.key = hashlib.sha256(f"{name}|{seen[name]}".encode()).hexdigest()[:12]
        yield site


def apply_sites(text, sites):
    """The text with all of its chosen sites made switchable."""
    edits = [(begin, end, new.replace("ID", str(site.id))) for site in sites for begin, end, new in site.edits]
    for begin, end, new in sorted(edits, key=lambda edit: (edit[0], edit[1]), reverse=True):
        text = text[:begin] + new + text[end:]
    return text
