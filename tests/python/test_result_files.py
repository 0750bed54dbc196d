"""Files of results as other programs read them: the same numbers in each format."""

import csv
import os
import tempfile
import unittest
from typing import Any, Dict, List

import detp
import numpy as np

TYPES = {"int": "<i4", "double": "<f8"}


def of_csv(path: str) -> Dict[str, List[str]]:
    with open(path, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {name: [row[name] for row in rows] for name in rows[0]}


def of_ply(path: str, element: str) -> Any:
    """The rows of an element, of which a list has three numbers."""
    with open(path, "rb") as file:
        data = file.read()
    header, body = data.split(b"end_header\n", 1)
    offset = 0
    sizes: List[Any] = []
    current: List[Any] = []
    for line in header.decode().splitlines() + ["element end 0"]:
        words = line.split()
        if words[0] == "element":
            if current:
                sizes.append(current)
            current = [words[1], int(words[2]), []]
        elif words[0] == "property":
            name = words[-1]
            current[2] += [("count", "u1"), (name, "<i4", 3)] if words[1] == "list" else [(name, TYPES[words[1]])]
    for name, count, columns in sizes:
        found = np.frombuffer(body, np.dtype(columns), count, offset)
        if name == element:
            return found
        offset += found.nbytes
    raise AssertionError(f"{path} has no element {element}")


class ResultFiles(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def files(self, option: str, suffixes: List[str]) -> Dict[str, str]:
        paths = {suffix: os.path.join(self.folder, option + suffix) for suffix in suffixes}
        for path in paths.values():
            options: Dict[str, Any] = {option: path}
            detp.run("@cornell", rays=20_000, seed=3, standard_error=True, **options)
        return paths

    def check(self, option: str, element: str) -> Dict[str, List[str]]:
        paths = self.files(option, [".csv", ".npy", ".ply", ".vtp"])
        table = of_csv(paths[".csv"])
        array, ply = np.load(paths[".npy"]), of_ply(paths[".ply"], element)
        for name, texts in table.items():
            if name in ("material", "group"):
                continue
            expected = np.array([float(text) if text else np.nan for text in texts])
            for found in (array[name], ply[name]):
                known = ~np.isnan(expected)
                np.testing.assert_array_equal(found[known], expected[known])
                self.assertFalse(np.isfinite(found[~known]).any())
        np.testing.assert_array_equal(array["hits"], ply["hits"])
        self.assertEqual(array["hits"].dtype.kind, "i")
        return table

    def test_discs_at_vertices_are_a_mesh(self) -> None:
        table = self.check("per_disc", "vertex")
        faces = of_ply(os.path.join(self.folder, "per_disc.ply"), "face")
        self.assertEqual(len(faces), 9696)
        self.assertLess(faces["vertex_indices"].max(), len(table["disc"]))

    def test_results_in_memory_are_the_same_mesh(self) -> None:
        found = detp.run("@cornell", rays=20_000, seed=3, standard_error=True)
        self.files("per_disc", [".ply"])
        by_command = os.path.join(self.folder, "per_disc.ply")
        path = os.path.join(self.folder, "memory.ply")
        found.to_ply(path)
        for element, names in (("vertex", ["x", "nz", "radius", "hits", "irradiance", "standard_error"]),
                               ("face", ["vertex_indices"])):
            for name in names:
                np.testing.assert_array_equal(of_ply(path, element)[name], of_ply(by_command, element)[name])
        assert found.faces is not None
        np.testing.assert_array_equal(found.faces, of_ply(path, "face")["vertex_indices"])
        np.testing.assert_array_equal(found.positions[:, 1], of_ply(path, "vertex")["y"])
        found.to_vtk(os.path.join(self.folder, "memory.vtp"))
        with self.assertRaises(ValueError):
            found.to_vtk(path)
        with self.assertRaises(OSError):
            found.to_ply(os.path.join(self.folder, "no", "memory.ply"))
        self.assertIsNone(detp.run("@cornell", rays=1000, samples=50).faces)

    def test_light_on_faces(self) -> None:
        table = self.check("per_face", "face")
        self.assertEqual(len(table["face"]), 9696)
        self.assertTrue(set(table["material"]) - {""})

    def test_paraview_reads_them(self) -> None:
        try:
            from vtkmodules.util.numpy_support import vtk_to_numpy  # type: ignore[import]
            from vtkmodules.vtkIOXML import vtkXMLPolyDataReader  # type: ignore[import]
        except ImportError:
            self.skipTest("python3-vtk9 is not installed")
        for option, cells in (("per_disc", False), ("per_face", True)):
            paths = self.files(option, [".vtp", ".npy"])
            expected = np.load(paths[".npy"])
            reader = vtkXMLPolyDataReader()
            reader.SetFileName(paths[".vtp"])
            reader.Update()
            found = reader.GetOutput()
            self.assertEqual(found.GetNumberOfPolys(), 9696)
            data = found.GetCellData() if cells else found.GetPointData()
            for name in ("hits", "irradiance", "standard_error", "upper_bound", "face" if cells else "vertex"):
                np.testing.assert_array_equal(vtk_to_numpy(data.GetArray(name)), expected[name])
            normals = vtk_to_numpy(data.GetNormals())
            np.testing.assert_array_equal(normals, np.stack([expected[axis] for axis in ("nx", "ny", "nz")], axis=1))
            if not cells:
                points = vtk_to_numpy(found.GetPoints().GetData())
                np.testing.assert_array_equal(points, np.stack([expected[axis] for axis in "xyz"], axis=1))


if __name__ == "__main__":
    unittest.main()
