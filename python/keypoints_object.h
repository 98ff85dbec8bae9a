// SPDX-License-Identifier: Apache-2.0
/// Python's objects of one person's 2D landmarks: Keypoints, and PersonKeypoints where hands or a face were found.
#pragma once

#include <pybind11/pybind11.h>

#include "data_tools/observations/load_detections.h"

namespace bodyloom::python {

/// Bound as PersonKeypoints, a kind of Keypoints.
struct PersonKeypoints : KeypointSequence {
  HandsAndFaceSequence hands_and_face;
};

/// A PersonKeypoints if the person has hands or a face in any frame, else a Keypoints. Needs the interpreter's lock.
pybind11::object KeypointsObject(PersonDetections person);

}  // namespace bodyloom::python
