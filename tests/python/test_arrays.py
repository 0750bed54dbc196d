"""Arrays of all kinds are read in place, and give the same bytes."""

import subprocess
import sys
import unittest
from typing import Any, List, Tuple

import detp
import numpy as np
from problems import same, some_discs, some_rays


class Arrays(unittest.TestCase):
    def test_layouts_of_the_same_numbers_give_the_same_bytes(self) -> None:
        centres, normals = some_discs(300, np.float32)
        origins, directions = some_rays(2000, np.float32)
        expected = detp.find_hits(detp.Discs(centres, normals, 0.1), detp.Rays(origins, directions, 2.0))
        self.assertGreater(expected.total_hits, 100)
        wide = np.zeros((2000, 11), np.float32)
        wide[:, 1:4], wide[:, 5:8], wide[:, 9] = origins, directions, 2
        reversed_twice = np.ascontiguousarray(origins[::-1])[::-1]
        locked = origins.copy()
        locked.flags.writeable = False
        unaligned = np.frombuffer(b"x" + origins.tobytes(), np.float32, offset=1).reshape(origins.shape)
        layouts: List[Tuple[str, Any, Any, Any]] = [
            ("columns of a table", wide[:, 1:4], wide[:, 5:8], wide[:, 9]),
            ("coordinates one after another", np.asfortranarray(origins), np.asfortranarray(directions), 2),
            ("doubles", origins.astype(float), directions.astype(np.float64), np.full(2000, 2)),
            ("big-endian", origins.astype(">f8"), directions.astype(">f4"), 2.0),
            ("from the last to the first", reversed_twice, directions, 2.0),
            ("read only", locked, directions, 2.0),
            ("unaligned", unaligned, directions, 2.0),
            ("lists", origins.tolist(), directions.tolist(), [2] * 2000),
        ]
        for name, o, d, lengths in layouts:
            with self.subTest(name):
                found = detp.find_hits(detp.Discs(centres, normals, np.full(300, 0.1)), detp.Rays(o, d, lengths))
                self.assertTrue(same(found, expected))
        every_other = detp.find_hits(detp.Discs(centres, normals, 0.1), detp.Rays(origins[::2], directions[::2], 2.0))
        copied = detp.find_hits(detp.Discs(centres, normals, 0.1),
                                detp.Rays(origins[::2].copy(), directions[::2].copy(), 2.0))
        self.assertTrue(same(every_other, copied))
        one_direction = np.broadcast_to(np.array([0, 0, 1.0]), origins.shape)
        self.assertTrue(same(detp.find_hits(detp.Discs(centres, normals, 0.1), detp.Rays(origins, one_direction)),
                             detp.find_hits(detp.Discs(centres, normals, 0.1), detp.Rays(origins, one_direction.copy()))))

    def test_pairs_are_those_of_the_definition_each_once(self) -> None:
        centres, normals = some_discs(60)
        origins, directions = some_rays(500)
        lengths = np.random.default_rng(3).uniform(0.2, 3, 500)
        found = detp.find_hits(detp.Discs(centres, normals, 0.3), detp.Rays(origins, directions, lengths))
        d = directions / np.linalg.norm(directions, axis=1)[:, None]
        n = normals / np.linalg.norm(normals, axis=1)[:, None]
        along = ((centres[None] - origins[:, None]) * n[None]).sum(-1) / (d @ n.T)  # rays × discs
        points = origins[:, None] + along[..., None] * d[:, None]
        inside = np.linalg.norm(points - centres[None], axis=-1) <= 0.3
        expected = inside & (along >= 0) & (along <= lengths[:, None])
        self.assertEqual(found.total_hits, expected.sum())
        for disc in range(60):
            np.testing.assert_array_equal(found.rays_of(disc), np.flatnonzero(expected[:, disc]))
        np.testing.assert_array_equal(found.hits, expected.sum(axis=0))

    def test_photons_make_errors_of_whole_paths(self) -> None:
        centres, normals = some_discs(20)
        origins, directions = some_rays(5000)
        plan = detp.plan(detp.Discs(centres, normals, 0.5), detp.Rays(origins, directions))
        alone = plan.search(detp.Rays(origins, directions), standard_error=True)
        paths = plan.search(detp.Rays(origins, directions, photons=np.arange(5000) // 5), standard_error=True)
        np.testing.assert_array_equal(alone.irradiance, paths.irradiance)
        assert alone.standard_error is not None and paths.standard_error is not None
        self.assertFalse(np.array_equal(alone.standard_error, paths.standard_error))

    def test_powers_in_bands_are_as_many_searches(self) -> None:
        centres, normals = some_discs(300)
        origins, directions = some_rays(2000)
        plan = detp.plan(detp.Discs(centres, normals, 0.2), detp.Rays(origins, directions))
        powers = np.random.default_rng(3).random((2000, 3)).astype(np.float32)
        one_by_one = [plan.search(detp.Rays(origins, directions, powers=powers[:, band]), standard_error=True)
                      for band in range(3)]
        for name, layout in (("rows", powers), ("columns", np.asfortranarray(powers)), ("lists", powers.tolist())):
            with self.subTest(name):
                found = plan.search(detp.Rays(origins, directions, powers=layout), standard_error=True)
                self.assertEqual(found.irradiance.shape, (300, 3))
                for band, one in enumerate(one_by_one):
                    np.testing.assert_array_equal(found.hits, one.hits)
                    np.testing.assert_array_equal(found.irradiance[:, band], one.irradiance)
                    assert found.standard_error is not None and one.standard_error is not None
                    np.testing.assert_array_equal(found.standard_error[:, band], one.standard_error)

    def test_rays_are_not_copied(self) -> None:
        program = (
            "import detp, numpy as np, resource\n"
            "peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss\n"
            "random = np.random.default_rng(1)\n"
            "rays = np.empty((3_000_000, 8), np.float32)\n"  # 96 MB
            "for i in range(30): rays[i * 100_000:(i + 1) * 100_000] = random.uniform(-1, 1, (100_000, 8))\n"
            "discs = random.uniform(-1, 1, (1000, 6))\n"
            "before = peak()\n"
            "r = detp.Rays(rays[:, :3], rays[:, 3:6], 2.0)\n"
            "plan = detp.plan(detp.Discs(discs[:, :3], discs[:, 3:], 0.01), r, threads=2)\n"
            "plan.search(r, threads=2)\n"
            "print((peak() - before) / 1024)\n")
        answer = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
        self.assertLess(float(answer.stdout), 80)  # MiB; a copy of the rays alone takes 183

    def test_what_is_no_array_of_numbers_is_refused_by_name(self) -> None:
        origins, directions = some_rays(10)
        cases: Tuple[Tuple[type, str, Any], ...] = (
            (ValueError, "origins must have the shape", lambda: detp.Rays(origins[:, :2], directions)),
            (ValueError, "origins must have the shape", lambda: detp.Rays(origins.ravel(), directions)),
            (ValueError, "directions must have 10 elements", lambda: detp.Rays(origins, directions[:9])),
            (TypeError, "directions must be numbers", lambda: detp.Rays(origins, directions.astype(str))),
            (TypeError, "origins must be numbers", lambda: detp.Rays(origins.astype(complex), directions)),
            (ValueError, "lengths must have 10", lambda: detp.Rays(origins, directions, [1.0, 2.0])),
            (ValueError, "lengths must not be 0", lambda: detp.Rays(origins, directions, 0)),
            (ValueError, "powers must be one number", lambda: detp.Rays(origins, directions, 1, origins.reshape(1, 10, 3))),
            (ValueError, "powers must have 10 elements", lambda: detp.Rays(origins, directions, 1, origins[:9])),
            (ValueError, "powers must have one band", lambda: detp.Rays(origins, directions, 1, origins[:, :0])),
            (ValueError, "photons must be whole", lambda: detp.Rays(origins, directions, photons=np.zeros(10))),
            (ValueError, "photons must not be negative", lambda: detp.Rays(origins, directions, photons=-np.arange(10))),
            (ValueError, "normals must have 10", lambda: detp.Discs(origins, directions[1:], 1)),
        )
        for kind, text, wrong in cases:
            with self.subTest(text), self.assertRaisesRegex(kind, text):
                wrong()

    def test_malformed_elements_are_refused_by_number(self) -> None:
        origins, directions = some_rays(10)
        centres, normals = some_discs(5)
        discs = detp.Discs(centres, normals, 0.1)
        good = detp.Rays(origins, directions)
        plan = detp.plan(discs, good)
        for column, value, text in [(origins, np.nan, "ray 7: origin must be finite"),
                                    (directions, np.inf, "ray 7: direction must be finite")]:
            kept = column[7, 1]
            column[7, 1] = value
            with self.assertRaisesRegex(ValueError, text):
                plan.search(good)
            column[7, 1] = kept
        plan.search(good)
        with self.assertRaisesRegex(ValueError, "ray 0: length"):
            plan.search(detp.Rays(origins, directions, -1))
        with self.assertRaisesRegex(ValueError, "ray 1: its photon has the number 3"):
            plan.search(detp.Rays(origins, directions, photons=np.array([5] + [3] * 9)))
        with self.assertRaisesRegex(ValueError, "at least one ray"):
            plan.search(detp.Rays(origins[:0], directions[:0]))
        with self.assertRaisesRegex(ValueError, "at least one disc"):
            detp.plan(detp.Discs(centres[:0], normals[:0], 0.1), good)
        with self.assertRaisesRegex(ValueError, "radius"):
            detp.plan(detp.Discs(centres, normals, -0.1), good)


if __name__ == "__main__":
    unittest.main()
