// SPDX-License-Identifier: Apache-2.0
/// True motions of people in videos, as EMDB and 3DPW publish them: SMPL's pose, shape and place in a world, and the
/// path of the camera. The files are Python pickles, read without executing code (data_tools/formats/pickle.h).
///
///   EMDB  P*/*_data.pkl          one person: smpl {poses_root T×3, poses_body T×69, trans T×3, betas 10}, camera
///                                {intrinsics 3×3, extrinsics T×4×4 world to camera, width, height},
///                                good_frames_mask T, gender, name
///   3DPW  sequenceFiles/*/*.pkl  several people: lists poses T×72, trans T×3, betas ≥ 10, genders ('m', 'f'),
///                                campose_valid T; cam_intrinsics 3×3, cam_poses T×4×4 world to camera, sequence. The
///                                image's size is not told; it is twice the principal point.
/// Both at 30 frames a second. Sources: the data sets' own descriptions (github.com/eth-ait/emdb, dataset.md; 3DPW's
/// readme.txt).
#pragma once

#include <string>
#include <vector>

#include "data_tools/formats/pickle.h"
#include "data_tools/observations/load_cameras.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct VideoTruth {
  std::string dataset;   ///< "EMDB" or "3DPW"; of rich_truth.h and human36m.h "RICH", "Human3.6M"
  std::string protocol;  ///< the evaluation's: "emdb", "3dpw", "rich", "h36m-smpl"
  std::string sequence;  ///< the file's own name of it
  std::string gender;    ///< of the body: "female", "male" or "neutral"; empty: not told
  std::string subject;   ///< who it is, where the data set numbers them
  int num_people = 1;    ///< in the file
  double fps = 30;       ///< of the frames, the first at time 0
  /// Of SMPL's body (72 columns), without joints, in the data set's world, which is the scene of its moving camera.
  /// Frames that the data set calls invalid are lost.
  Track track;
};

/// The motion of one of the file's people, counted from 0. Throws std::runtime_error naming `where`, the key, what it
/// holds and what was expected, also when there are fewer people.
VideoTruth VideoTruthFromPickle(const PickleValue& file, int person, const std::string& where);

/// Sets T frames that are all lost, at `truth->fps` from time 0, with `columns` of poses, seen by a camera that stands
/// still in the world.
void SetLostFrames(int T, Eigen::Index columns, const NamedCamera& camera, VideoTruth* truth);

/// The frames of `num_frames` at `fps` from time 0 that are nearest to these times, seconds. Throws std::runtime_error
/// naming `where` when one of them is before the first or after the last.
std::vector<int> FramesNearTimes(int num_frames, double fps, const std::vector<double>& times_s,
                                 const std::string& where);

}  // namespace bodyloom
