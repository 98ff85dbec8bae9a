# SPDX-License-Identifier: Apache-2.0
"""Ctrl-C, progress functions and other threads during long jobs."""
import functools
import os
import pathlib
import signal
import tempfile
import threading
import time
import unittest

import numpy as np

import bodyloom
from support import clip


@functools.lru_cache(maxsize=None)
def long_clip():
    return bodyloom.synthetic_clip(3000, image_size=(320, 240))


def interrupt_after(seconds):
    timer = threading.Timer(seconds, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    return timer


class Interrupts(unittest.TestCase):
    def expect_interrupt(self, work):
        """It stops in the middle, soon after the signal, and raises KeyboardInterrupt."""
        timer = interrupt_after(0.3)
        begun, finished = time.process_time(), False  # of this process: others may be busy
        with self.assertRaises(KeyboardInterrupt):
            work()
            finished = True
            timer.join()
            time.sleep(1)
        timer.join()
        self.assertFalse(finished, "the work was over before the signal came")
        self.assertLess(time.process_time() - begun, 8)

    def test_track(self):
        keypoints, truth = long_clip()
        self.expect_interrupt(lambda: bodyloom.track(keypoints, camera=truth.camera))
        # Afterwards everything works as before.
        self.assertEqual(len(bodyloom.track(clip()[0])), 40)

    def test_nothing_half_written_is_left(self):
        _, truth = long_clip()
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder)
            for work in (lambda: bodyloom.describe(truth, out=out / "maps.npy", size=256),
                         lambda: bodyloom.render(truth, out=out / "overlay.mp4"),
                         lambda: bodyloom.export(truth, out / "vertices.npy", "vertices")):
                self.expect_interrupt(work)
                self.assertEqual(list(out.iterdir()), [])

    def test_in_memory(self):
        _, truth = long_clip()
        self.expect_interrupt(lambda: [bodyloom.describe(truth, past=1, every=2) for _ in range(20)])


class Progress(unittest.TestCase):
    def test_calls(self):
        calls = []
        bodyloom.track(clip()[0], progress=lambda stage, fraction: calls.append((stage, fraction)))
        self.assertGreater(len(calls), 3)
        self.assertEqual(calls[-1][1], 1)
        self.assertTrue(all(isinstance(stage, str) and 0 <= fraction <= 1 for stage, fraction in calls))

    def test_false_cancels(self):
        calls = []

        def progress(stage, fraction):
            calls.append(fraction)
            return len(calls) < 3

        with self.assertRaisesRegex(bodyloom.Cancelled, "^cancelled$"):
            bodyloom.track(clip()[0], progress=progress)
        self.assertEqual(len(calls), 3)
        self.assertTrue(issubclass(bodyloom.Cancelled, RuntimeError))

    def test_what_it_raises_is_raised(self):
        def progress(stage, fraction):
            raise LookupError("mine")

        with self.assertRaisesRegex(LookupError, "mine"):
            bodyloom.track(clip()[0], progress=progress)
        with self.assertRaisesRegex(LookupError, "mine"):
            bodyloom.describe(clip()[1], size=16, progress=progress)


class Threads(unittest.TestCase):
    def test_another_thread_goes_on(self):
        keypoints, truth = long_clip()
        counted, running = [0], True

        def count():
            while running:
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        try:
            before, begun = counted[0], time.monotonic()
            bodyloom.track(keypoints, camera=truth.camera, threads=1)
            seconds, steps = time.monotonic() - begun, counted[0] - before
        finally:
            running = False
            thread.join()
        self.assertGreater(seconds, 0.3)
        self.assertGreater(steps, 20 * seconds)  # of some 900 a second where nothing else runs; none while the lock is held

    def test_two_tracks_at_once(self):
        keypoints, truth = clip()
        expected = bodyloom.track(keypoints, camera=truth.camera)
        results = [None] * 4

        def work(i):
            results[i] = bodyloom.track(keypoints, camera=truth.camera)

        threads = [threading.Thread(target=work, args=(i,)) for i in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for track in results:
            np.testing.assert_array_equal(track.poses, expected.poses)

    def test_shared_objects_take_turns(self):
        _, truth = clip()
        frames = bodyloom.DescriptorFrames(truth, size=32)
        renderer = bodyloom.Renderer(truth)
        expected = [frames[t] for t in range(8)], [renderer.image(t) for t in range(8)]
        faults = []

        def work():
            for t in range(8):
                if (frames[t] != expected[0][t]).any() or (renderer.image(t) != expected[1][t]).any():
                    faults.append(t)

        threads = [threading.Thread(target=work) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(faults, [])


if __name__ == "__main__":
    unittest.main()
