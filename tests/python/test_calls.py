"""Plans, stops, threads, questions."""

import gc
import os
import signal
import sys
import threading
import time
import unittest
from typing import Any, Callable, Dict, List, Optional

import detp
import numpy as np
from problems import same, some_discs, some_rays

try:
    import pandas
except ImportError:
    pandas = None


class Calls(unittest.TestCase):
    def test_a_plan_keeps_what_it_needs(self) -> None:
        centres, normals = some_discs(400)
        rays = detp.Rays(*some_rays(3000))
        plan = detp.plan(detp.Discs(centres, normals, 0.1), rays)
        expected = plan.search(rays)
        centres[:] = np.nan
        del centres, normals
        gc.collect()
        self.assertTrue(same(plan.search(rays), expected))
        smaller = plan.with_radius(0.05)
        del plan
        gc.collect()
        self.assertTrue(0 < smaller.search(rays).total_hits < expected.total_hits)
        self.assertGreater(smaller.predicted_seconds, 0)
        with self.assertRaisesRegex(ValueError, "radius"):
            smaller.with_radius(-1)

    def test_a_run_finds_what_the_command_finds(self) -> None:
        options: Dict[str, Any] = {"rays": 20000, "technique": "grid", "threads": 1, "seed": 3}
        found = detp.run("@cornell", standard_error=True, **options)
        answer = detp.ask("run", "@cornell", *(f"--{name}={value}" for name, value in options.items()))
        self.assertEqual(int(found.hits.sum()), answer["hits"])
        self.assertEqual(found.answer["mean_irradiance"], answer["mean_irradiance"])
        self.assertAlmostEqual(float(np.mean(found.irradiance)) / answer["mean_irradiance"], 1, 12)
        self.assertEqual(found.centres.shape, (len(found.hits), 3))
        self.assertTrue(np.allclose(np.linalg.norm(found.normals, axis=1), 1))
        self.assertTrue((found.radii == found.answer["inputs"]["disc_radius"]).all())
        assert found.standard_error is not None and found.upper_bound is not None
        self.assertTrue((found.upper_bound >= found.irradiance).all())
        self.assertIsNone(detp.run("@cornell", rays=1000).standard_error)
        wrong: List[Dict[str, Any]] = [{"rays": "1k,2k"}, {"leaf": 8, "estimator": "gather"}, {"unknown": 1}]
        for one in wrong:
            with self.assertRaises(ValueError):
                detp.run("@cornell", **one)

    def test_threads_search_one_plan_at_once(self) -> None:
        rays = detp.Rays(*some_rays(20000))
        plan = detp.plan(detp.Discs(*some_discs(2000), 0.05), rays)
        expected = plan.search(rays, pairs=True)
        wrong: List[int] = []

        def work() -> None:
            for _ in range(5):
                found = plan.search(rays, pairs=True)
                if not same(found, expected) or not found.rays_of(7).tolist() == expected.rays_of(7).tolist():
                    wrong.append(1)

        threads = [threading.Thread(target=work) for _ in range(4)]
        for one in threads:
            one.start()
        for one in threads:
            one.join()
        self.assertEqual(wrong, [])

    def test_progress_is_shown_and_what_it_raises_arrives(self) -> None:
        rays = detp.Rays(*some_rays(400_000))
        seen: List[float] = []
        plan = detp.plan(detp.Discs(*some_discs(2000), 0.02), rays, progress=lambda what, share: seen.append(share))
        self.assertGreater(len(seen), 0)
        seen.clear()
        plan.search(rays, progress=lambda what, share: seen.append(share))
        self.assertEqual(seen, sorted(seen))
        self.assertEqual(seen[-1], 1)

        def stop(what: str, share: float) -> None:
            raise LookupError(what)

        for call in (lambda: plan.search(rays, progress=stop), lambda: detp.ask("validate", progress=stop),
                     lambda: detp.plan(detp.Discs(*some_discs(2000), 0.02), rays, progress=stop)):
            with self.assertRaises(LookupError):
                call()

        def bad(wanted: int) -> Optional[detp.Rays]:
            raise LookupError("rays")

        with self.assertRaises(LookupError):
            plan.search_until(bad, 0.05)
        with self.assertRaisesRegex(ValueError, "noise|error"):
            plan.search_until(lambda wanted: None, 2)

    def test_ctrl_c_ends_long_work_at_once(self) -> None:
        def seconds_after_ctrl_c(after: float, work: Callable[[], object]) -> float:
            sent: List[float] = []

            def send() -> None:
                sent.append(time.monotonic())
                os.kill(os.getpid(), signal.SIGINT)

            timer = threading.Timer(after, send)
            with self.assertRaises(KeyboardInterrupt):
                timer.start()
                work()
            timer.join()
            return time.monotonic() - sent[0]

        for after, work in [(0.5, lambda: detp.ask("validate")), (0.3, lambda: detp.Costs.measured(10))]:
            # Another job may delay an end, but not each of three.
            self.assertTrue(any(seconds_after_ctrl_c(after, work) < 2 for attempt in range(3)))

    def test_irradiance_by_paths_in_a_scene(self) -> None:
        floor = detp.Discs([[0.5, 0, 0.5], [0.3, 0, 0.6]], [[0, 1, 0], [0, 3, 0]], 1)
        found = detp.gather("@furnace", floor, paths=500, threads=1)
        self.assertTrue((abs(found.irradiance - 2 * np.pi) < 4 * found.standard_error).all())
        self.assertTrue((found.upper_bound > found.irradiance).all())
        self.assertEqual(found.hits.tolist(), [500, 500])  # none outside of the box
        self.assertEqual((found.missed_share, found.missed_bound), (0, 0))
        self.assertEqual(detp.gather("@furnace", floor, paths=500).irradiance.tolist(), found.irradiance.tolist())
        self.assertEqual(detp.gather("@furnace", floor, paths=500, front_facing=True).irradiance.tolist(),
                         found.irradiance.tolist())
        colours = detp.gather("@cornell", detp.Discs([[0.5, 0.01, 0.5]], [[0, 1, 0]], 1), paths=500, rgb=True)
        self.assertEqual(colours.irradiance.shape, (1, 3))
        self.assertEqual(list(colours.to_pandas())[:3], ["hits", "irradiance_0", "irradiance_1"])
        missing = detp.gather("@caustic", floor)
        self.assertTrue(0.01 < missing.missed_share < missing.missed_bound < 1)
        self.assertIn("missed", repr(missing))
        for scene, paths, kind in [("@uniform", 1, ValueError), ("none.obj", 1, OSError), ("@furnace", 0, ValueError)]:
            with self.assertRaises(kind):
                detp.gather(scene, floor, paths=paths)

        def stop(what: str, share: float) -> None:
            raise LookupError(what)

        with self.assertRaises(LookupError):
            detp.gather("@furnace", floor, paths=2**30, progress=stop)

    def test_a_search_until_an_error_ends_there(self) -> None:
        discs = detp.Discs(*some_discs(500), 0.2)
        plan = detp.plan(discs, detp.Rays(*some_rays(1000)))
        seeds = iter(range(10, 10_000))

        def batch(wanted: int) -> detp.Batch:
            return detp.Batch(detp.Rays(*some_rays(wanted, seed=next(seeds)), 2.0), scale=1 / wanted)

        estimate = plan.search_until(batch, 0.05)
        self.assertTrue(estimate.reached)
        self.assertLess(estimate.noise_high, 0.0501)
        self.assertLess(estimate.noise_low, estimate.noise)
        self.assertIsNone(estimate.share_bound)
        batches = iter([batch(5000)])
        few = plan.search_until(lambda wanted: next(batches, None), 0.001)
        self.assertFalse(few.reached)
        far = plan.search_until(lambda wanted: detp.Rays(np.full((wanted, 3), 50.0), np.ones((wanted, 3)), 1.0), 0.05,
                                most_rays=20000)
        self.assertFalse(far.reached)
        self.assertGreater(far.share_bound or 0, 0)
        again = iter(range(10, 10_000))

        def in_colours(wanted: int) -> detp.Batch:
            powers = np.tile([2.0, 6.0, 0.5], (wanted, 1))
            return detp.Batch(detp.Rays(*some_rays(wanted, seed=next(again)), 2.0, powers), scale=1 / wanted)

        green = plan.search_until(in_colours, 0.05, bands=3, noise_of=1)
        self.assertEqual(green.rays, estimate.rays)
        self.assertAlmostEqual(green.noise, estimate.noise, places=12)
        np.testing.assert_allclose(green.irradiance, np.outer(estimate.irradiance, [2, 6, 0.5]), rtol=1e-12)
        self.assertEqual(list(green.to_pandas()), ["irradiance_0", "irradiance_1", "irradiance_2"])
        with self.assertRaisesRegex(ValueError, "noise_of is 3, but bands are numbered from 0 to 2"):
            plan.search_until(in_colours, 0.05, bands=3, noise_of=3)

    def test_numbers_that_a_function_returns_are_checked(self) -> None:
        rays = detp.Rays(*some_rays(1000))
        plan = detp.plan(detp.Discs(*some_discs(500), 0.2), rays)
        for wrong in (-1.0, 0.0, float("nan"), float("inf")):
            with self.assertRaisesRegex(ValueError, "scale"):
                plan.search_until(lambda wanted: detp.Batch(rays, scale=wrong), 0.05)
        for wrong in (-5.0, float("nan"), float("inf")):
            with self.assertRaisesRegex(ValueError, "photons"):
                plan.search_until(lambda wanted: detp.Batch(rays, photons=wrong), 0.05)
            with self.assertRaisesRegex(ValueError, "most rays"):
                plan.search_until(lambda wanted: rays, 0.05, most_rays=wrong)
        with self.assertRaises(TypeError):
            plan.search_until(lambda wanted: detp.Batch(rays, scale="one"), 0.05)  # type: ignore[arg-type]
        with self.assertRaisesRegex(ValueError, "for the command alone"):
            detp.ask("--help")

    def test_numbers_alone(self) -> None:
        numbers: Dict[str, Any] = {"rays": 1e5, "samples": 1e4, "disc_radius": 0.02, "scene_side": 2}
        words = ["--rays", "100000", "--samples", "10000", "--disc-radius", "0.02", "--scene-side", "2"]
        choice = detp.choose(**numbers, threads=1)
        again = detp.predict(choice.technique, **numbers, **choice.parameters)
        self.assertEqual(again.seconds, choice.predicted_seconds)
        for form in ("published", "corrected"):
            found = detp.predict("sphere-cache", ratio=0.65, spheres=9, published=form == "published", **numbers)
            expected = detp.ask("model", *words, "--ratio", 0.65, "--spheres", 9, "--form", form)
            self.assertEqual(found.counts, expected["counts"])
            self.assertEqual(list(found.spheres["rebuilds"]), [one["rebuilds"] for one in expected["spheres"]])
            self.assertEqual(list(found.spheres["rays"]), [one["rays"] for one in expected["spheres"]])
        for text, wrong in [("no technique", lambda: detp.predict("sphere-cash", **numbers)),
                            ("no parameter", lambda: detp.predict("octree", ratio=0.5, **numbers)),
                            ("radius", lambda: detp.choose(rays=1, samples=1, disc_radius=0, scene_side=1)),
                            ("--nope", lambda: detp.ask("model", "--nope"))]:
            with self.subTest(text), self.assertRaisesRegex(ValueError, text):
                wrong()
        with self.assertRaises(OSError):
            detp.ask("run", "/nowhere/scene.obj")
        self.assertIn("built", repr(detp.Costs.built_in()))

    def test_results_look_like_tables(self) -> None:
        rays = detp.Rays(*some_rays(3000))
        plan = detp.plan(detp.Discs(*some_discs(40), 0.3), rays, costs=detp.Costs.stored())
        found = plan.search(rays, standard_error=True, counts=True)
        shown: List[Any] = [plan, found, detp.choose(rays=10, samples=10, disc_radius=0.1, scene_side=2)]
        for one in shown:
            self.assertIn("<table>", one._repr_html_())
            self.assertIn(type(one).__name__, repr(one))
        self.assertEqual((found.counts or {})["hits"], found.total_hits)
        with self.assertRaisesRegex(ValueError, "pairs=True"):
            found.rays_of(0)
        with self.assertRaises(IndexError):
            plan.search(rays, pairs=True).rays_of(40)
        if pandas is None:
            self.skipTest("no pandas")
        self.assertEqual(list(found.to_pandas().columns), ["hits", "irradiance", "standard_error", "upper_bound"])


if __name__ == "__main__":
    unittest.main()
