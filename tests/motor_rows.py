"""One motor as a user writes it: what is None is not stated."""


def toml(cells):
    stated = {key: value for key, value in cells.items() if value is not None}
    return "[[motor]]\n" + "\n".join(f"{key} = {value!r}" for key, value in stated.items())


def csv(cells):
    stated = {key: value for key, value in cells.items() if value is not None}
    texts = (f'"{value}"' if "," in str(value) else str(value) for value in stated.values())
    return f"{','.join(stated)}\n{','.join(texts)}\n"
