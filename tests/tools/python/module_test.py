"""The Python module: what it returns, what it refuses, and who owns the memory. Run with its folder in PYTHONPATH."""
import gc
import multiprocessing
import os
import threading
import unittest

import numpy as np

import insonate


def small_phantom():
    return insonate.phantom(voxel_mm=5)


def small(simulator):
    simulator.set(image_width=96, image_height=80, samples=128)
    return simulator


def draw_in_fork(results):
    try:
        insonate.Simulator(small_phantom())
        results.put("drawn")
    except insonate.InputError as error:
        results.put(str(error))


class Cases(unittest.TestCase):
    def test_a_case_shows_its_volumes_without_copies(self):
        case = small_phantom()
        self.assertEqual(case.ct.dtype, np.int16)
        self.assertEqual(case.ct.shape, case.labels.shape)
        self.assertTrue(np.shares_memory(case.ct, case.ct))
        with self.assertRaises(ValueError):
            case.ct[0, 0, 0] = 1
        ct = case.ct
        expected = ct.sum(dtype=np.int64)
        del case
        gc.collect()
        self.assertEqual(ct.sum(dtype=np.int64), expected)

    def test_names_and_positions_are_those_of_the_case(self):
        case = small_phantom()
        self.assertIn("hepatorenal", case.views)
        self.assertEqual(case.views["hepatorenal"].probe, "curvilinear")
        liver = next(value for value, name in case.label_names.items() if name == "liver")
        k, j, i = np.argwhere(case.labels == liver).mean(axis=0)
        position = case.patient_from_voxel @ [i, j, k, 1]
        self.assertLess(position[0], 0)  # on the patient's right

    def test_options_and_paths_that_cannot_be_used_are_refused(self):
        with self.assertRaisesRegex(insonate.InputError, "gallstnoe.*gallstone"):
            insonate.phantom(gallstnoe=True)
        with self.assertRaisesRegex(insonate.InputError, "there is no such file"):
            insonate.open_case("/nowhere.nii.gz")
        with self.assertRaisesRegex(TypeError, "the path is None, which names no file"):
            insonate.open_case(None)
        with self.assertRaisesRegex(insonate.InputError, r"phantom: 'gallstone' is \[True\], which cannot be used; give True"):
            insonate.phantom(gallstone=[True])
        for other in (None, "abdomen"):
            with self.assertRaisesRegex(TypeError, "not a Case; take one from open_case"):
                insonate.Simulator(other)
        with self.assertRaisesRegex(TypeError, "not a Case; take one from open_case"):
            insonate.ImageSimilarity("abdomen", np.zeros((96, 128)), "linear")


class Pictures(unittest.TestCase):
    def setUp(self):
        self.case = small_phantom()
        self.view = self.case.views["hepatorenal"]
        self.simulator = insonate.Simulator(self.case)
        self.simulator.set_probe(self.view.probe, self.view.depth_mm)
        self.simulator.pose = self.view.pose
        small(self.simulator)

    def tearDown(self):
        self.simulator.close()

    def test_a_batch_equals_single_pictures(self):
        poses = np.array([self.view.pose] * 3)
        poses[1][:3, 3] += 4
        batch = self.simulator.images(poses, labels=True)
        self.assertEqual(batch["image"].shape, (3, 80, 96))
        for i in range(3):
            self.simulator.pose = poses[i]
            np.testing.assert_array_equal(batch["image"][i], self.simulator.image())
            truth = self.simulator.truth()
            for name in ("label", "visible_label", "reach", "skin_mm"):
                np.testing.assert_array_equal(batch[name][i], truth[name])
        np.testing.assert_array_equal(batch["image"], self.simulator.images(poses))
        self.assertTrue((batch["image"][0] != batch["image"][1]).any())
        self.assertEqual(self.simulator.images(np.zeros((0, 4, 4))).shape, (0, 80, 96))

    def test_labels_lie_where_the_matrix_says(self):
        truth = self.simulator.truth()
        voxel_from_pixel = np.linalg.inv(self.case.patient_from_voxel) @ self.simulator.patient_from_pixel
        compared = 0
        for row, column in zip(*np.nonzero(truth["label"])):
            i, j, k = (voxel_from_pixel @ [column, row, 0, 1])[:3]
            border = np.abs(np.array([i, j, k]) % 1 - 0.5).min()
            if border > 1e-6:
                compared += 1
                self.assertEqual(truth["label"][row, column], self.case.labels[round(k), round(j), round(i)])
        self.assertGreater(compared, 1000)
        self.assertEqual(truth["skin_mm"].shape, (self.simulator.probe.lines,))

    def test_the_marker_is_on_the_left(self):
        left = self.simulator.patient_from_pixel @ [0, 40, 0, 1]
        self.assertGreater((np.linalg.inv(self.view.pose) @ left)[0], 10)
        np.testing.assert_array_equal(self.simulator.stages()["image"], self.simulator.image())
        np.testing.assert_array_equal(self.simulator.stages()["inside"] != 0, self.simulator.truth()["reach"] != 0)

    def test_stages_have_their_shapes(self):
        stages = self.simulator.stages()
        self.assertEqual(stages["intensity"].shape, (128, self.simulator.probe.lines))
        self.assertEqual(stages["fused"].shape, (80, 96))
        self.assertTrue((stages["intensity"][0] > stages["intensity"][-1]).all())
        always, lines = {"fused", "inside", "image"}, {"intensity", "repeated"}
        of_waves = lines | {"scattered", "echo_re", "echo_im", "wave_re", "wave_im"}
        self.assertEqual(set(stages), always | of_waves)
        self.assertEqual({stages[name].shape for name in of_waves}, {stages["intensity"].shape})
        self.simulator.set(waves=False)
        of_sums = lines | {"reflection", "reflection_beam", "transmission", "speckle"}
        self.assertEqual(set(self.simulator.stages()), always | of_sums)

    def test_settings_change_the_picture_or_are_refused_as_a_whole(self):
        before = self.simulator.image()
        self.simulator.set(gain_db=6, grey_map="s_curve", speckle=False, tgc_db=[0] * 8, samples=100)
        self.assertEqual(self.simulator.settings["gain_db"], 6)
        self.assertEqual(self.simulator.settings["grey_map"], "s_curve")
        self.assertTrue((self.simulator.image() != before).any())
        for bad, sentence in (({"gian_db": 1}, "there is no setting 'gian_db'; did you mean 'gain_db'?"),
                              ({"gain_db": 99}, "'gain_db' is 99, not a number from -60 to 60"),
                              ({"grey_map": "soggy"}, "'grey_map' is 'soggy'"), ({"samples": 1.5}, "'samples' is 1.5")):
            with self.assertRaisesRegex(insonate.InputError, sentence.replace("?", r"\?")):
                self.simulator.set(dynamic_range_db=33, **bad)
            self.assertNotEqual(self.simulator.settings["dynamic_range_db"], 33)

    def test_poses_that_cannot_be_used_are_refused_and_the_pose_stays(self):
        mirrored = self.view.pose.copy()
        mirrored[:, 0] *= -1
        for bad, sentence in ((mirrored, "mirrors"), (np.eye(3), "an array of 3 x 3, not of 4 x 4"),
                              (np.full((4, 4), np.nan), "pose: ")):
            with self.assertRaisesRegex(insonate.InputError, sentence):
                self.simulator.pose = bad
        for bad in ("abc", [[1, 0], [0]], None, self.view.pose * 1j):
            with self.assertRaisesRegex(insonate.InputError, "^pose: it is not an array of real numbers; give"):
                self.simulator.pose = bad
            with self.assertRaisesRegex(insonate.InputError, "^poses: it is not an array of real numbers; give"):
                self.simulator.images(bad)
        np.testing.assert_array_equal(self.simulator.pose, self.view.pose)
        with self.assertRaisesRegex(insonate.InputError, "number 1: "):
            self.simulator.images(np.array([self.view.pose, mirrored]))
        with self.assertRaisesRegex(insonate.InputError, "not of N x 4 x 4"):
            self.simulator.images(self.view.pose)

    def test_probes_by_name_and_changed(self):
        with self.assertRaisesRegex(insonate.InputError, "did you mean 'linear'"):
            self.simulator.set_probe("linaer")
        with self.assertRaisesRegex(insonate.InputError, "a probe has no 'width'"):
            insonate.Probe("linear", width=3)
        for like, other in (("linear", "radius_mm"), ("linear", "field_of_view_deg"), ("curvilinear", "width_mm"),
                            ("phased", "radius_mm")):
            with self.assertRaisesRegex(insonate.InputError, f"a {like} probe has no '{other}'; give "):
                insonate.Probe(like, **{other: 30})
        with self.assertRaises(ValueError):
            insonate.Probe("linear", lines=0)
        with self.assertRaisesRegex(insonate.InputError, "Probe: 'lines' is 64.5, which is not a count"):
            insonate.Probe("linear", lines=64.5)
        with self.assertRaisesRegex(insonate.InputError, "Probe: 'width_mm' is None, which cannot be used; give a number"):
            insonate.Probe("linear", width_mm=None)
        with self.assertRaisesRegex(insonate.InputError, "number of scan lines is 1e.06; give a number from 1 to 4096"):
            insonate.Probe("linear", lines=2000000)
        for width_mm in (np.float32(50), np.array(50.0)):
            self.assertEqual(insonate.Probe("linear", width_mm=width_mm).width_mm, 50)
        with self.assertRaisesRegex(insonate.InputError, "the depth in mm is 5000; give a number from 0.1 to 1000"):
            self.simulator.set_probe("linear", 5000)

    def test_settings_take_the_numbers_of_numpy(self):
        before = self.simulator.settings["samples"]
        self.simulator.set(samples=np.int64(128), gain_db=np.float32(3))
        self.assertEqual(self.simulator.settings["samples"], 128)
        self.assertEqual(self.simulator.settings["gain_db"], 3)
        with self.assertRaisesRegex(insonate.InputError, "None cannot be the value of a setting"):
            self.simulator.set(gain_db=None)
        self.simulator.set(tgc_db=np.arange(8))
        self.assertEqual(self.simulator.settings["tgc_db"], list(range(8)))
        with self.assertRaisesRegex(insonate.InputError, "cannot be the value of a setting"):
            self.simulator.set(tgc_db=np.zeros((2, 4)))
        with self.assertRaisesRegex(insonate.InputError, "Simulator: 'depth_mm' is 'deep', which cannot be used"):
            self.simulator.set_probe("linear", "deep")
        self.simulator.set(samples=before, gain_db=0)

    def test_threads_that_share_a_simulator_get_whole_pictures(self):
        import concurrent.futures
        poses = np.repeat(self.simulator.pose[None], 3, axis=0)
        def draw(width):
            self.simulator.set(image_width=width)
            images = self.simulator.images(poses, labels=True)
            return images["image"].shape == images["label"].shape and (images["image"] == images["image"][0]).all()
        width = self.simulator.settings["image_width"]
        with concurrent.futures.ThreadPoolExecutor(4) as threads:
            self.assertTrue(all(threads.map(draw, [64, 512] * 6)))
        self.simulator.set(image_width=width)
        with self.assertRaises(TypeError):
            self.simulator.set_probe(3)
        self.simulator.set_probe(insonate.Probe("linear", lines=64, width_mm=50), 60)
        self.assertEqual(self.simulator.truth()["skin_mm"].shape, (64,))
        self.assertEqual(self.simulator.image().shape, (80, 96))
        self.assertEqual(insonate.probe_names(), ["curvilinear", "linear", "phased"])

    def test_closed_simulators_say_so(self):
        with insonate.Simulator(self.case) as other:
            pass
        with self.assertRaisesRegex(RuntimeError, "the simulator is closed"):
            other.image()
        for use in (other.truth, lambda: other.set(gain_db=1), lambda: other.set_probe("linear"),
                    lambda: setattr(other, "pose", np.eye(4))):
            with self.assertRaisesRegex(RuntimeError, "the simulator is closed"):
                use()
        other.close()
        small(self.simulator).image()  # which goes on

    def test_threads_share_a_process(self):
        expected, results = self.simulator.image(), []

        def draw():
            with insonate.Simulator(self.case) as own:
                own.set_probe(self.view.probe, self.view.depth_mm)
                own.pose = self.view.pose
                results.append(small(own).image())

        threads = [threading.Thread(target=draw) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(len(results), 3)
        for result in results:
            np.testing.assert_array_equal(result, expected)

    def test_a_forked_process_is_told_what_to_do(self):
        self.simulator.image()
        context = multiprocessing.get_context("fork")
        results = context.Queue()
        child = context.Process(target=draw_in_fork, args=(results,))
        child.start()
        self.assertIn("start processes by spawn", results.get(timeout=60))
        child.join()

    def test_results_outlive_the_simulator(self):
        picture = self.simulator.image()
        copy = picture.copy()
        self.simulator.close()
        gc.collect()
        np.testing.assert_array_equal(picture, copy)
        self.assertTrue(picture.flags.writeable)


class Registrations(unittest.TestCase):
    def test_lc2_is_highest_at_the_pose_of_the_picture(self):
        case = insonate.phantom(voxel_mm=2)
        for name in ("gallbladder_long", "hepatorenal"):
            view = case.views[name]
            with insonate.Simulator(case) as simulator:
                simulator.set_probe(view.probe, view.depth_mm)
                simulator.pose = view.pose
                simulator.set(image_width=128, image_height=96)
                picture = simulator.image()
            for axis in range(3):
                poses = np.array([view.pose] * 5)
                for i, moved in enumerate((-12, -6, 0, 6, 12)):
                    poses[i][:3, 3] += moved * view.pose[:3, axis]
                with insonate.ImageSimilarity(case, picture, view.probe, view.depth_mm) as comparison:
                    similarity = comparison.similarity(poses)
                    self.assertEqual(similarity.dtype, np.float32)
                    self.assertEqual(similarity.argmax(), 2, f"{name}, axis {axis}: {similarity}")
        with self.assertRaisesRegex(RuntimeError, "the comparison is closed"):
            comparison.similarity(poses)
        # Attenuation and shadows differ over a whole image, but little within a patch.
        with insonate.ImageSimilarity(case, picture, view.probe, view.depth_mm, patch=0) as whole:
            self.assertLess(whole.similarity(poses[2:3])[0], similarity[2])
        with self.assertRaisesRegex(insonate.InputError, "^patch: a patch is 2 pixels wide, .*give 0, or 4 to 128"):
            insonate.ImageSimilarity(case, picture, view.probe, view.depth_mm, patch=2)
        with insonate.ImageSimilarity(case, picture[:, ::-1], view.probe, view.depth_mm) as mirrored:
            self.assertLess(mirrored.similarity(poses[2:3])[0], similarity[2])
        with self.assertRaisesRegex(insonate.InputError, "not an array of rows by columns"):
            insonate.ImageSimilarity(case, picture[0], view.probe)
        with self.assertRaisesRegex(insonate.InputError, "it has infinite values"):
            insonate.ImageSimilarity(case, np.full(picture.shape, -np.inf), view.probe)
        for nothing in (np.full(picture.shape, np.nan), np.zeros(picture.shape)):
            with self.assertRaisesRegex(insonate.InputError, "its pixels have one grey level or none"):
                insonate.ImageSimilarity(case, nothing, view.probe)
        with self.assertRaisesRegex(insonate.InputError, "there is no such file"):
            insonate.ImageSimilarity(case, picture, view.probe, settings="/nowhere.toml")


if __name__ == "__main__":
    assert os.path.isfile(insonate.__file__)
    unittest.main(verbosity=1)
