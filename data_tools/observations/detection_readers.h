// SPDX-License-Identifier: Apache-2.0
/// Readers of keypoints that detectors and other programs write, one per format, which load_detections.h recognises.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "data_tools/formats/json_reader.h"
#include "data_tools/formats/ndarray.h"
#include "data_tools/formats/npz.h"
#include "data_tools/formats/pickle.h"
#include "data_tools/observations/people.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/observations.h"

namespace bodyloom {

// AIST++ keypoint files (pickles).
//
// keypoints2d/<seq>.pkl: `keypoints2d` V×T×17×3 (25×3 when made with OpenPose) with x, y in pixels of the 1920×1080
// video and a score, NaN where a frame has no detection; `det_scores` V×T; `timestamps` T, microseconds. Views are the
// cameras c01, c02, … in order. One person per frame. Some scores exceed 1 slightly and are clamped.
// keypoints3d/<seq>.pkl: `keypoints3d` and `keypoints3d_optim`, T×17×3 COCO, centimetres, y up.
// Source: google/aistplusplus_api, loader.py and run_preprocessing.py.

bool IsAistKeypoints2d(const PickleValue& file);
/// The detections of one view ("c01" …; "" means the only view, an error when there are several). `fps` is used when
/// the file has no timestamps. Throws std::runtime_error naming `where`, what was found and, for a missing view, the
/// views present.
KeypointSequence AistKeypoints2dFromPickle(const PickleValue& file, const std::string& where, const std::string& view,
                                           double fps);

/// Joints of every frame (17×3 metres, world frame with y up): keypoints3d_optim, or the raw triangulation.
std::vector<MatrixX3d> ReadAistKeypoints3d(const std::string& path, bool optimised = true);

// Reads BlazePose / MediaPipe landmarks from JSON dumps: a list of frames, each of which is
//   [[x, y, z], …]·33 or [{"x", "y", "z", "visibility", "presence", "name"}, …]·33 (17 entries: COCO),
//   {"nose": {"x", "y", "score"}, …} by landmark name,
//   {"keypoints" or "landmarks" or "pose_landmarks": either list, "score"}, or a list of such objects (several
//   people), null or an empty list when nobody was found.
// A top-level object with "frames" may hold this list. Beside the list of the body an object may have
// "left_hand_landmarks", "right_hand_landmarks" and "face_landmarks" (of Holistic), lists of 21, 21 and 468 or 478;
// all names also as JavaScript writes them ("leftHandLandmarks").
//
// x and y are pixels or fractions of the image (distinguished by load_detections.h, where the image size is known). z
// is relative depth and is not used. visibility and presence may be probabilities or logits: when one value of the
// file lies outside [0, 1], all are logits. Without either, a landmark has confidence 1.
// Source: MediaPipe pose landmarker docs, tfjs-models pose-detection README.

bool IsBlazePoseJson(const JsonNode& document);
/// Throws std::runtime_error naming the place.
PeopleSequence BlazePoseFromJson(const JsonNode& document, double fps);

// COCO keypoints: a results list [{"image_id", "category_id": 1, "keypoints": [x, y, c]·17, "score"}] as from most
// detectors and AlphaPose, or an annotation table {"images": […], "annotations": […]}.
//
// image_id is a number or a file name; its number is the frame. Several entries with one image_id are several people.
// AlphaPose's "idx" and PoseTrack's "track_id" are identities. Confidences above 1 (AlphaPose) count as 1; in
// annotations the third value is a flag: 0 missing, 1 labelled but hidden (confidence 0.5), 2 visible (confidence 1).
// 17, 23, 26, 133 (COCO-WholeBody) and 136 (Halpe) landmarks are read; the last 110 of 133 and 136, or the keys
// lefthand_kpts, righthand_kpts and face_kpts of COCO-WholeBody's annotations, are the person's hands and face.
// Source: cocodataset.org/#format-data, AlphaPose, "Output format".

bool IsCocoJson(const JsonNode& document);
/// Throws std::runtime_error naming the place.
PeopleSequence CocoFromJson(const JsonNode& document, double fps);

// Reads DeepLabCut's CSV of analysed videos: header rows `scorer`, `individuals` (of several animals or people),
// `bodyparts` and `coords`, then one row per frame: its number, and for each body part x and y in pixels and a
// `likelihood`, which is the confidence (1 where there is none, as in labelled frames).
//
// Empty cells and NaN are missing landmarks. Body parts are a person's by their names (LandmarkNameFrom(): "nose",
// "leftShoulder", "right_knee", "ankle_l"); others have a name of their own and constrain nothing. Individuals are
// identities; parts of the individual `single`, which belong to no one, are left out beside others. In labelled frames
// the number is that in the image's name.
// Source: DeepLabCut/DeepLabCut, user guides of single-animal and multi-animal projects,
// deeplabcut/pose_estimation_tensorflow/predict_videos.py.

/// Returns true if a text begins as DeepLabCut's CSV does.
bool IsDeepLabCutCsv(std::string_view text);
/// Throws std::runtime_error naming `where`, the line, what was found and what was expected.
PeopleSequence DeepLabCutFromCsv(std::string_view text, const std::string& where, double fps);

// Reads FreeMoCap's 2D landmarks:
// output_data/raw_data/<detector>_2dData_numCams_numFrames_numTrackedPoints_pixelXY.npy, an array cameras × frames ×
// points × 2 of pixels, NaN where nothing was detected; or one camera of it, frames × points × 2.
//
// 133 points are RTMPose's (COCO-WholeBody); any other number from 33 on begins with MediaPipe's 33 of the body (its
// holistic tracker has 543 or 553, hands and face behind them). There are no confidences: detected points get 1. Some
// versions have a third number per point, a confidence or a depth: it is ignored. FreeMoCap's 3D
// (frames × points × 3, millimetres, triangulated from all cameras in its own world) is not a detection and refused.
// Source: freemocap/freemocap, data_layer/recording_models; skellytracker; the file's name states its shape.

/// Index of the camera `view` ("0", "1", …; "" when there is one) of an array's. Throws std::runtime_error naming
/// `where` and the cameras.
int64_t FindArrayCamera(const std::string& view, int64_t num_cameras, const std::string& where);

/// Returns true for an array of 33 points or more with 2 or 3 numbers each, but for frames × points × 3 of COCO's or
/// Halpe's family, which may have confidences (KeypointsFromArray()).
bool IsFreeMocap(const NdArray& array);

/// `view` chooses the camera: "0", "1", … in the array's order, which is that of the videos' names; "" when there is
/// one.
/// Throws std::runtime_error naming `where`, what was found and what was expected.
KeypointSequence FreeMocapFromArray(const NdArray& array, const std::string& where, const std::string& view,
                                    double fps);

// Reads landmarks that people save as a bare array (.npy, or the only array of an .npz): frames × points × 3 with x, y
// in pixels and a confidence, or × 2 without one (then it is 1), NaN where a landmark is missing; or several of them,
// one for each camera or person.
//
// 17 points are COCO's, 23 or 133 COCO-WholeBody's, 26 or 136 Halpe's; a convention given by the caller is taken as it
// is. Without one the array must not be mistaken:
// - The third numbers must lie in [0, 1] and people must be 20 units tall or wide (the median frame): metres would not
//   reach that, and of centimetres or millimetres the depth of a person spans more than 1. Arrays that do not are 3D
//   points or fractions of the image.
// - Of 17 points the first five, COCO's face, must span less than 0.4 of all (the median frame); in Human3.6M's order
//   they are hips, knee and ankle.
// With a convention the third numbers must not be negative, and the numbers may be fractions (load_detections.h).

/// Returns the array of landmarks of an archive without the keys of this project's own form: `keypoints`, or the only
/// array of numbers. nullptr if there is none.
const NdArray* KeypointArrayOf(const NpzArrays& arrays);

/// `view` chooses one of N × frames × points: "0", "1", … in the array's order, "" when there is one. `convention` is
/// "" or the name of one of KnownConventions(). Throws std::runtime_error naming `where`, what was found and what to
/// give.
KeypointSequence KeypointsFromArray(const NdArray& array, const std::string& where, const std::string& view, double fps,
                                    const std::string& convention);

// Reads MMPose's JSON. A person is {"keypoints": [[x, y], …], "keypoint_scores": […], "bbox": …, "bbox_score": …},
// pixels.
//
// Three forms: a list of people (one image; a folder has one such file per image), a list of {"frame_id": n,
// "instances": [people]} with n from 0 (the inferencer on a video), and {"meta_info": {…}, "instance_info":
// [{"frame_id": n, "instances": […]}]} with n from 1 (the demo scripts). There is no identity. Scores may exceed 1
// slightly and count as 1. 17 (COCO), 23, 26 (Halpe, Body8), 133 (COCO-WholeBody) and 136 landmarks are read;
// `meta_info`, if present, identifies them, and an order of other landmarks is refused. Lifted keypoints [x, y, z] are
// refused, as they are not pixels.
// Source: open-mmlab/mmpose, mmpose/structures/utils.py, mmpose/apis/inferencers, demo/topdown_demo_with_mmdet.py.

bool IsMmposeJson(const JsonNode& document);
/// Throws std::runtime_error naming the place.
PeopleSequence MmposeFromJson(const JsonNode& document, double fps);

/// Reads files of one image each from a folder, with these names: frame numbers as in ReadOpenPoseFolder(), broken
/// files and warnings as in ReadJsonFrames(). Throws std::runtime_error naming file and place.
PeopleSequence ReadMmposeFolder(const std::string& folder, const std::vector<std::string>& names, double fps,
                                std::vector<std::string>* warnings = nullptr);

// Reads OpenPose's JSON: {"version": 1.3, "people": [{"person_id": [-1], "pose_keypoints_2d": [x, y, c, …], …}]} per
// frame.
//
// x and y are pixels, c is in [0, 1], 0,0,0 means missing. The order of people is arbitrary. `people` may be empty and
// may hold empty objects. The number of landmarks determines the model, except that BODY_25 and BODY_25B both have 25:
// in BODY_25 landmark 1 lies between landmarks 2 and 5 (a neck between shoulders), in BODY_25B the first three form a
// face. Also read: a list of such frames in one file, a table {"12.jpg": {"people": …}}, and the older key
// "pose_keypoints". hand_left_keypoints_2d, hand_right_keypoints_2d (21 each) and face_keypoints_2d (70) are the
// person's hands and face. Source: OpenPose doc/02_output.md.

/// Reads a folder with one JSON file per frame; frame numbers come from the file names (frame_numbers.h), or from their
/// order if a name has no number. `convention` is "" (detect), "body25", "body25b", "openpose_coco18", "coco17" or
/// "halpe26". Broken files and warnings as in ReadJsonFrames(). Throws std::runtime_error naming the file and place.
PeopleSequence ReadOpenPoseFolder(const std::string& folder, double fps, const std::string& convention = "",
                                  std::vector<std::string>* warnings = nullptr);

/// Returns true if a parsed file has one of OpenPose's forms.
bool IsOpenPoseJson(const JsonNode& document);
PeopleSequence OpenPoseFromJson(const JsonNode& document, double fps, const std::string& convention = "");

// Reads the JSON of Ultralytics' pose models, Results.to_json() (tojson() before 8.3): the list of an image's
// detections
//   {"name": "person", "class": 0, "confidence": 0.9, "box": {…}, "track_id": 3, "keypoints": {"x": […], "y": […],
//    "visible": […]}},
// alone (one image; a folder has one such file per image) or in a list of the frames, also as JSON Lines.
//
// x and y are pixels, or fractions of the image with normalize=True; `visible` is the confidence, 1 if it is not
// there. Landmarks at exactly (0, 0) are missing, as Ultralytics sets those below a confidence of 0.5 there.
// `track_id` is the identity, of model.track(). 17 landmarks (COCO) and other orders of ConventionOfCount() are read.
// Source: ultralytics/ultralytics, engine/results.py.

bool IsUltralyticsJson(const JsonNode& document);
/// Throws std::runtime_error naming the place.
PeopleSequence UltralyticsFromJson(const JsonNode& document, double fps);

/// Reads files of one image each from a folder, with these names: frame numbers as in ReadOpenPoseFolder(), broken
/// files and warnings as in ReadJsonFrames(). Throws std::runtime_error naming file and place.
PeopleSequence ReadUltralyticsFolder(const std::string& folder, const std::vector<std::string>& names, double fps,
                                     std::vector<std::string>* warnings = nullptr);

// Reads VideoPose3D's 2D landmarks (data_2d_h36m_*.npz, data_2d_custom_*.npz):
//   positions_2d  pickled table: subject (or video) → action ("custom") → list of cameras, each frames × 17 × 2 pixels
//   metadata      pickled table: layout_name "h36m" or "coco", num_joints, keypoints_symmetry, and of custom sets
//                 video_metadata: video → {"w", "h"}
// NaN is a missing landmark; there are no confidences, so others have 1.
//
// The order of the landmarks is that of the layout, else of keypoints_symmetry (left and right landmarks), else the
// caller's. There are no times; Human3.6M's videos have 50 frames a second.
// Source: facebookresearch/VideoPose3D, data/data_utils.py, data/prepare_data_2d_custom.py.

bool IsVideoPose3d(const NpzArrays& arrays);

/// Reads the archive in `bytes`. `view` chooses "subject/action/camera" ("S1/Walking 1/0"), or a part of it that only
/// one view has; of a single view it is not used. `convention` is "" (the file's), "coco17" or "human36m17". Throws
/// std::runtime_error naming `where`, what was found, and for a missing view the views present.
KeypointSequence VideoPose3dFromNpz(const std::string& bytes, const std::string& where, const std::string& view,
                                    double fps, const std::string& convention);

/// The same for the two tables.
KeypointSequence VideoPose3dFromObjects(const PickleValue& positions, const PickleValue& metadata,
                                        const std::string& where, const std::string& view, double fps,
                                        const std::string& convention);

// Reads the JSON of easy_ViTPose (inference.py --save-json):
//   {"keypoints": [{"0": [[y, x, confidence], …], "1": …}, …], "skeleton": {"0": "nose", …}}
// with one table per frame, people by their number, which is an identity in a video. y comes before x, pixels.
//
// `skeleton` names the landmarks: COCO's 17, easy_ViTPose's 25 (COCO with neck, hip and feet), COCO-WholeBody's 133,
// or any that have some of a person's landmarks. Without all names the order is COCO's of that number. Source:
// JunkyByte/easy_ViTPose, inference.py, easy_ViTPose/vit_utils/visualization.py (joints_dict).

bool IsVitPoseJson(const JsonNode& document);
/// Throws std::runtime_error naming the place.
PeopleSequence VitPoseFromJson(const JsonNode& document, double fps);

}  // namespace bodyloom
