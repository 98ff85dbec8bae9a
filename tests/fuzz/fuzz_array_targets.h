// SPDX-License-Identifier: Apache-2.0
/// Fuzz targets for files of named arrays other than bodies and tracks (observations, part labels, pose prior, lifter,
/// clothes parser, the built-in body's own arrays), and for readers that detect the format by its content. Each returns
/// true if the input was accepted; accepted data must be consistent.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "data_tools/avatar/avatar_file.h"
#include "data_tools/body_making/make_builtin_body.h"
#include "data_tools/datasets/video_truth.h"
#include "data_tools/estimates/estimate_readers.h"
#include "data_tools/estimates/load_estimate.h"
#include "data_tools/formats/zip.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/parser_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/motion/load_motion.h"
#include "data_tools/observations/detection_readers.h"
#include "data_tools/observations/load_detections.h"
#include "data_tools/observations/observations_npz.h"
#include "data_tools/observations/part_labels.h"
#include "tests/fuzz/fuzz_targets.h"

namespace bodyloom::fuzz {

/// An uncompressed archive of the framed arrays, for readers that take a whole file.
inline std::string ArchiveOf(const NpzArrays& arrays) {
  std::vector<ZipMember> members;
  for (const auto& [name, array] : arrays) members.push_back({name + ".npy", NpyBytes(array)});
  return MakeZip(members, 0);
}

inline void CheckTimes(const std::vector<double>& times) {
  for (size_t t = 0; t < times.size(); ++t) {
    if (!std::isfinite(times[t]) || (t > 0 && !(times[t] > times[t - 1])))
      throw std::logic_error("a clock that stands");
  }
}

inline void CheckKeypoints(const KeypointSequence& keypoints) {
  CheckTimes(keypoints.timestamps);
  if (keypoints.points.size() != keypoints.timestamps.size() * keypoints.names.size()) {
    throw std::logic_error("joints of another number");
  }
  for (const Keypoint& point : keypoints.points) {
    if (!(point.confidence >= 0 && point.confidence <= 1)) throw std::logic_error("a confidence out of range");
  }
}

inline bool AcceptsObservations(const std::string& bytes) {
  const NpzArrays arrays = FramedArrays(bytes);
  const bool sparse = Accepts([&] { CheckKeypoints(KeypointsFromNpz(arrays, "fuzz.npz")); });
  const bool dense = Accepts([&] {
    const DenseSequence sequence = DenseFromNpz(arrays, "fuzz.npz");
    CheckTimes(sequence.timestamps);
    if (sequence.timestamps.size() != sequence.frames.size()) throw std::logic_error("frames without a time");
  });
  return sparse || dense;
}

/// VideoPose3D's two tables as consecutive pickles: positions_2d, metadata.
inline bool AcceptsVideoPose3d(const std::string& bytes) {
  return Accepts([&] {
    size_t offset = 0;
    const PicklePtr positions = ReadPickleAt(PickleDialect::kPlain, bytes, &offset, "fuzz.npz");
    const PicklePtr metadata = ReadPickleAt(PickleDialect::kPlain, bytes, &offset, "fuzz.npz");
    CheckKeypoints(VideoPose3dFromObjects(*positions, *metadata, "fuzz.npz", "", 30, ""));
  });
}

inline bool AcceptsPartLabels(const std::string& bytes) {
  return Accepts([&] {
    const PartLabelSequence labels = PartLabelsFromNpz(FramedArrays(bytes), "fuzz.npz");
    CheckTimes(labels.timestamps);
    for (const PackedLabels& packed : labels.frames) {
      const LabelImage image = packed.Unpacked();
      const bool empty = image.width <= 0 || image.height <= 0;
      const size_t expected = empty ? 0 : static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
      if (image.labels.size() != expected) throw std::logic_error("labels of another number than pixels");
    }
  });
}

/// A Gaussian avatar, and its training state if the file has one.
inline bool AcceptsAvatar(const std::string& bytes) {
  const NpzArrays arrays = FramedArrays(bytes);
  const auto check = [](const GaussianBody& body, const AvatarFile& avatar) {
    if (std::string why; !body.IsValid(avatar.num_bones(), avatar.num_faces, &why)) throw std::logic_error(why);
    for (int c = 0; c < GaussianBody::kNumParameters; ++c) {
      for (const float value : body.parameters.values(c)) {
        if (!std::isfinite(value)) throw std::logic_error("a parameter that is no number");
      }
    }
  };
  const bool person = Accepts([&] {
    const AvatarFile avatar = AvatarFromArrays(arrays, "fuzz.npz");
    check(avatar.body, avatar);
  });
  const bool training = Accepts([&] {
    const AvatarCheckpoint checkpoint = AvatarCheckpointFromArrays(arrays, "fuzz.npz");
    check(checkpoint.state.body, checkpoint.avatar);
    if (checkpoint.state.adam.first.rows() != checkpoint.state.body.size() ||
        checkpoint.state.pull.size() != checkpoint.state.adam.steps.size()) {
      throw std::logic_error("moments of another number than Gaussians");
    }
  });
  return person || training;
}

inline bool AcceptsPosePrior(const std::string& bytes) {
  return Accepts([&] {
    const PosePrior prior = ReadPosePriorBytes(ArchiveOf(FramedArrays(bytes)), "fuzz.npz");
    if (prior.means.rows() != prior.num_components() || prior.means.cols() != prior.dim() || !prior.means.allFinite()) {
      throw std::logic_error("means of another size");
    }
  });
}

inline bool AcceptsLifter(const std::string& bytes) {
  return Accepts([&] {
    std::string why;
    const LifterWeights weights = ReadLifterWeightsBytes(ArchiveOf(FramedArrays(bytes)), "fuzz.npz");
    if (!weights.IsValid(&why)) throw std::logic_error(why);
  });
}

inline bool AcceptsParser(const std::string& bytes) {
  return Accepts([&] {
    std::string why;
    const ParserWeights weights = ReadParserWeightsBytes(ArchiveOf(FramedArrays(bytes)), "fuzz.npz");
    if (!weights.IsValid(&why)) throw std::logic_error(why);
  });
}

/// The built-in body's arrays, with its own cage.
inline bool AcceptsLeftHalf(const std::string& bytes) {
  static const BuiltinBodySources embedded = EmbeddedBuiltinBodySources();
  return Accepts([&] {
    CheckBody(MakeBuiltinBody({embedded.cage_text, "fuzz.txt", ArchiveOf(FramedArrays(bytes)), "fuzz.npz"}));
  });
}

/// Motion files of any format.
inline bool AcceptsMotion(const std::string& bytes) {
  return Accepts([&] {
    const Motion motion = MotionFromBytes(bytes, "fuzz.motion");
    CheckTimes(motion.timestamps);
    if (static_cast<int>(motion.timestamps.size()) != motion.num_frames() ||
        motion.trans.rows() != motion.poses.rows()) {
      throw std::logic_error("frames disagree");
    }
  });
}

inline void CheckEstimate(const BodyEstimate& estimate) {
  if (estimate.people.empty()) throw std::logic_error("an estimate of nobody");
  for (const PersonEstimate& person : estimate.people) {
    const auto n = static_cast<Eigen::Index>(person.frames.size());
    if (n == 0 || person.poses.rows() != n || person.poses.cols() != (estimate.has_landmarks ? 0 : 72) ||
        person.trans.rows() != n || static_cast<Eigen::Index>(person.cameras.size()) != n ||
        static_cast<Eigen::Index>(person.landmarks.size()) != (estimate.has_landmarks ? n : 0)) {
      throw std::logic_error("frames disagree");
    }
    for (const MatrixX3d& landmarks : person.landmarks) {
      if (landmarks.rows() != 21 || !landmarks.allFinite()) throw std::logic_error("landmarks that are none");
    }
    if (!person.poses.allFinite() || !person.trans.allFinite() || !person.betas.allFinite()) {
      throw std::logic_error("a pose that is no number");
    }
    for (size_t i = 0; i < person.frames.size(); ++i) {
      if (person.frames[i] < 0 || (i > 0 && person.frames[i] <= person.frames[i - 1])) {
        throw std::logic_error("frames out of order");
      }
    }
    if (person.frames.back() < 1000 && estimate.has_landmarks) {
      LandmarksInCamera(person, MakePinhole(640, 480, 500), 1000);
    } else if (person.frames.back() < 1000) {
      EstimateInCamera(person, MakePinhole(640, 480, 500), 1000, estimate.rest_pelvis, Eigen::Vector3d::Zero());
    }
  }
}

/// Results of any other system; GVHMR's and GEM's without the archive, whose checksums no mutation passes.
inline bool AcceptsEstimate(const std::string& bytes) {
  if (Accepts([&] { CheckEstimate(EstimateFromBytes(bytes, "fuzz.pkl", {640, 480})); })) return true;
  WeightsFile file;
  for (const auto& [name, array] : FramedArrays(bytes)) file.tensors[name] = array;
  return Accepts(
      [&] { CheckEstimate(IsGem(file) ? GemFromTensors(file, "fuzz.pt") : GvhmrFromTensors(file, "fuzz.pt")); });
}

inline void CheckVideoTruth(const VideoTruth& truth) {
  const Track& track = truth.track;
  for (int t = 0; t < track.num_frames(); ++t) {
    const bool is_lost = track.frame_status.at(size_t(t)) == FrameStatus::kLost;
    if (track.motion.HasPose(t) == is_lost) throw std::logic_error("a pose that is no number, or of a lost frame");
    if (!track.camera_from_scene.at(size_t(t)).camera_from_world_rotation.allFinite()) {
      throw std::logic_error("a camera that is nowhere");
    }
  }
  if (FramesNearTimes(track.num_frames(), truth.fps, {0.0}, "fuzz").at(0) != 0) throw std::logic_error("no frame 0");
}

/// Sequences of EMDB and 3DPW.
inline bool AcceptsVideoTruth(const std::string& bytes) {
  return Accepts([&] { CheckVideoTruth(VideoTruthFromPickle(*ReadPickle(bytes, "fuzz.pkl"), 0, "fuzz.pkl")); });
}

/// A camera of RICH and the body of a frame.
inline bool AcceptsRich(const std::string& bytes) {
  const bool camera = Accepts([&] {
    const NamedCamera named = RichCameraFromXml(bytes, "fuzz.xml");
    if (!named.pose.camera_from_world_rotation.allFinite() || !(named.camera.fx > 0) || named.camera.width < 1) {
      throw std::logic_error("a camera that shows nothing");
    }
  });
  const bool body = Accepts([&] {
    const Eigen::RowVectorXd row = RichBodyFromPickle(*ReadPickle(bytes, "fuzz.pkl"), "fuzz.pkl");
    if (row.size() < 70 || !row.allFinite()) throw std::logic_error("a body that is none");
  });
  return camera || body;
}

/// Joints and SMPL fits of Human3.6M as JSON, and positions_3d as a pickle.
inline bool AcceptsHuman36m(const std::string& bytes) {
  const auto check = [](const Human36mClip& clip) {
    if (clip.joints.empty()) throw std::logic_error("a clip without frames");
    for (const MatrixX3d& joints : clip.joints) {
      if ((joints.rows() != 0 && joints.rows() != 17) || !joints.allFinite()) throw std::logic_error("not 17 joints");
    }
  };
  bool taken =
      Accepts([&] { check(Human36mFromPositions(*ReadPickle(bytes, "fuzz.npz"), "S9/Directions 1", "fuzz.npz")); });
  taken |= Accepts([&] {
    const nlohmann::json json = ParseJson(bytes, "fuzz.json");
    const JsonNode document(json, "fuzz.json");
    if (HasHuman36mSmpl(document)) {
      CheckVideoTruth(Human36mSmplFromJson(document, "2/1", {}));
    } else {
      check(Human36mFromJson(document, "2/1"));
    }
  });
  return taken;
}

/// Files of detections of any format, with the person selected and missing times filled in.
inline bool AcceptsDetectionsFile(const std::string& bytes) {
  return Accepts([&] { CheckKeypoints(DetectionsFromBytes(bytes, "fuzz.json", {})); });
}

}  // namespace bodyloom::fuzz
