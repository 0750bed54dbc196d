"""Python on the pages of the repository runs."""

import re
import unittest
from pathlib import Path
from typing import Any, Dict

import numpy as np
from problems import some_discs, some_rays

top = Path(__file__).resolve().parents[2]


class Pages(unittest.TestCase):
    def test_programs_on_pages_run(self) -> None:
        centres, normals = some_discs(40)
        origins, directions = some_rays(2000)
        names: Dict[str, Any] = {"centres": centres, "normals": normals, "radii": np.full(40, 0.2), "origins": origins,
                                 "directions": directions, "lengths": np.full(2000, 3.0), "powers": np.ones(2000)}
        for page in ("README.md", "validate/python/README.md"):
            programs = re.findall(r"^```python\n(.*?)^```", (top / page).read_text(encoding="utf-8"), flags=re.M | re.S)
            self.assertTrue(programs, page)
            for program in programs:
                with self.subTest(page):
                    exec(program.replace("scene.obj", "@cornell").replace('"--target-noise", "5%"', '"--target-noise", "20%", "--effort", "quick"'), dict(names))


if __name__ == "__main__":
    unittest.main()
