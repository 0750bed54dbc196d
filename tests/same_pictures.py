"""Fails unless two folders have the same SVG pictures, but for the last digit of coordinates: processors round differently.

    same_pictures.py KEPT DRAWN
"""
import pathlib
import re
import sys

NUMBER = re.compile(r"\d+\.\d+")


def same(kept, drawn):
    one, other = kept.read_text(), drawn.read_text()
    pairs = zip(NUMBER.findall(one), NUMBER.findall(other))
    return NUMBER.sub("", one) == NUMBER.sub("", other) and all(abs(float(a) - float(b)) < 0.05 for a, b in pairs)


kept, drawn = ({path.name: path for path in pathlib.Path(folder).glob("*.svg")} for folder in sys.argv[1:3])
wrong = sorted(kept.keys() ^ drawn.keys()) + [name for name in sorted(kept.keys() & drawn.keys()) if not same(kept[name], drawn[name])]
if wrong:
    sys.exit(f"{', '.join(wrong)} in {sys.argv[1]} is not what the notebooks draw; compare with {sys.argv[2]}")
