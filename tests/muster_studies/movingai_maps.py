"""Maps of movingai.com, as text."""


def map_text(blocked):
    """The `.map` of a grid."""
    rows, columns = blocked.shape
    cells = "\n".join("".join("@" if cell else "." for cell in row) for row in blocked)
    return f"type octile\nheight {rows}\nwidth {columns}\nmap\n{cells}\n"
