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

#include "data_tools/formats/json_reader.h"
#include "data_tools/formats/npz.h"
#include "data_tools/formats/pickle.h"
#include "data_tools/observations/load_cameras.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct VideoTruth {
  std::string dataset;   ///< "EMDB" or "3DPW"; of the readers below "RICH", "Human3.6M"
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

// True motions of Human3.6M in the forms in which its owners pass them on, 50 frames a second, in the world of its
// cameras (data_tools/observations/load_cameras.h, form 4):
//
//   Human36M_subject*_joint_3d.json     action → subaction → frame → 17×3 mm
//   Human36M_subject*_smpl_param.json   the same with {pose 72 axis-angle, shape 10, trans 3 metres} of neutral SMPL,
//                                       fitted to every fifth frame
//   data_3d_h36m.npz                    positions_3d, a pickled table: subject → action → frames × 32 × 3 metres
//
// Actions are numbers from 2 ("2" Directions, "3" Discussion, … "16" WalkTogether), subactions "1", "2". The 17 are
// the joints 0–3, 6–8, 12–15, 17–19, 25–27 of the 32, in the order of Human36m17() (keypoint_conventions.h). Source:
// mks0601/3DMPPE_POSENET_RELEASE, tool/Human36M/h36m2coco.py, data/Human36M/Human36M.py; mks0601's I2L-MeshNet for the
// SMPL fits; facebookresearch/VideoPose3D, data/prepare_data_h36m.py, common/h36m_dataset.py.

inline constexpr double kHuman36mFps = 50;

struct Human36mClip {
  std::string sequence;
  std::vector<MatrixX3d> joints;  ///< T of 17×3 metres in the world; without rows where they are not told
};

/// Returns true for data_3d_h36m.npz.
bool IsHuman36mPositions(const NpzArrays& arrays);

/// `sequence`: "SUBJECT/ACTION" as in the file ("S9/Directions 1"). Throws std::runtime_error naming `where`, what was
/// found and, for a missing sequence, those present.
Human36mClip Human36mFromPositions(const PickleValue& positions_3d, const std::string& sequence,
                                   const std::string& where);

/// Returns true if the entries of frames are SMPL's parameters, not joints.
bool HasHuman36mSmpl(const JsonNode& document);

/// `sequence`: "ACTION/SUBACTION" ("2/1", or "Directions/1"). Throws as above.
Human36mClip Human36mFromJson(const JsonNode& document, const std::string& sequence);

/// SMPL's motion in the world, with `camera` standing still in it. Frames without a fit are lost, also the four after
/// the last one.
VideoTruth Human36mSmplFromJson(const JsonNode& document, const std::string& sequence, const NamedCamera& camera);

// True motions of RICH: SMPL-X bodies in a scanned scene, seen by cameras that stand still.
//
//   bodies/SET/SEQUENCE/FRAME/SUBJECT.pkl   (also train_body/…) of each frame, five digits, and subject, three digits:
//                                           betas 1×10, global_orient 1×3, body_pose 1×63 axis-angle, transl 1×3
//                                           metres, in the frame of the calibration; hands and face are not read
//   scan_calibration/SCENE/calibration/NNN.xml   a camera as OpenCV stores it: CameraMatrix 3×4 [R|t], camera from
//                                           world, metres; Intrinsics 3×3; Distortion, of which eight are used.
//                                           The image's size is not told; it is twice the principal point.
// 30 frames a second, the first at time 0. Frames without the subject's file are lost.
// Source: github.com/paulchhuang/rich_toolkit (README, smplx2images.py, utils.py).

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
