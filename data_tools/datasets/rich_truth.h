// SPDX-License-Identifier: Apache-2.0
/// True motions of RICH: SMPL-X bodies in a scanned scene, seen by cameras that stand still.
///
///   bodies/SET/SEQUENCE/FRAME/SUBJECT.pkl   (also train_body/…) of each frame, five digits, and subject, three digits:
///                                           betas 1×10, global_orient 1×3, body_pose 1×63 axis-angle, transl 1×3
///                                           metres, in the frame of the calibration; hands and face are not read
///   scan_calibration/SCENE/calibration/NNN.xml   a camera as OpenCV stores it: CameraMatrix 3×4 [R|t], camera from
///                                           world, metres; Intrinsics 3×3; Distortion, of which eight are used.
///                                           The image's size is not told; it is twice the principal point.
/// 30 frames a second, the first at time 0. Frames without the subject's file are lost.
/// Source: github.com/paulchhuang/rich_toolkit (README, smplx2images.py, utils.py).
#pragma once

#include <string>

#include "data_tools/datasets/video_truth.h"
#include "data_tools/observations/load_cameras.h"

namespace bodyloom {

/// Returns true for a folder of frames: one whose folders have numbers for names.
bool IsRichSequence(const std::string& folder);

/// The motion of one of the sequence's subjects, counted from 0 in the order of their numbers, 66 columns of SMPL-X's
/// body in the world, with `camera` standing still in it. Throws std::runtime_error naming the file, the key and what
/// was found.
VideoTruth ReadRichTruth(const std::string& folder, int person, const NamedCamera& camera);

/// A camera of `path`, a file or a scene's folder; `view` is its number ("3", "003"), "" the only one. Throws
/// std::runtime_error naming the file and the place.
NamedCamera ReadRichCamera(const std::string& path, const std::string& view);

/// The same of a file's text.
NamedCamera RichCameraFromXml(const std::string& text, const std::string& where);

/// Body of one frame: a row of 66 numbers of the pose, then 3 of transl, then betas.
Eigen::RowVectorXd RichBodyFromPickle(const PickleValue& file, const std::string& where);

}  // namespace bodyloom
