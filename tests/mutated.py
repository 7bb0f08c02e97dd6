"""Files changed at random: bytes, words, numbers and whole pieces."""

SPLIT = (b"\n", b"<", b" ", b'"', b",", b"{")
NUMBERS = tuple(
    b"0 -0 -1 1e308 -1e308 1e-320 nan inf -inf 1e999 9999999999999999999999 0x1p3 1_000".split()
)
TEXTS = (
    b"../../x",
    b"/etc/passwd",
    b"\0",
    b"\xff\xfe",
    b"\xc2\x9b2J",
    b"[bold]",
    b"<script>",
    b"&",
)


def mutated(seeds, words, draw):
    """Some seed with a few changes: of bytes, of words and numbers, of whole pieces."""
    content = draw.choice(seeds)
    for _ in range(draw.choice((1, 1, 1, 2, 3, 8))):
        content = draw.choice((_bytes, _word, _number, _number, _piece, _piece, _cut))(
            content, seeds, words, draw
        )
    return content


def _bytes(content, _seeds, _words, draw):
    changed = bytearray(content)
    for _ in range(draw.randint(1, 4)):
        if changed:
            changed[draw.randrange(len(changed))] = draw.randrange(256)
    return bytes(changed)


def _word(content, _seeds, words, draw):
    place = draw.randint(0, len(content))
    return content[:place] + draw.choice((*words, *TEXTS)) + content[place:]


def _number(content, _seeds, _words, draw):
    digits = [index for index, byte in enumerate(content) if chr(byte).isdigit()]
    if not digits:
        return content
    start = end = draw.choice(digits)
    while end < len(content) and content[end] in b"0123456789.eE+-":
        end += 1
    return content[:start] + draw.choice(NUMBERS) + content[end:]


def _piece(content, seeds, _words, draw):
    mark = draw.choice(SPLIT)
    pieces, others = content.split(mark), draw.choice(seeds).split(mark)
    place = draw.randrange(len(pieces))
    pieces[place : place + draw.randint(0, 2)] = [draw.choice(others)] * draw.choice(
        (0, 1, 1, 2, 50)
    )
    return mark.join(pieces)


def _cut(content, _seeds, _words, draw):
    return content[: draw.randint(0, len(content))]
