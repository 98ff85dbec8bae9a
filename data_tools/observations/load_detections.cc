// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/load_detections.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/inflate.h"
#include "data_tools/formats/json_reader.h"
#include "data_tools/formats/npz.h"
#include "data_tools/formats/pickle.h"
#include "data_tools/formats/printable.h"
#include "data_tools/formats/zip.h"
#include "data_tools/motion/motion_readers.h"
#include "data_tools/observations/detection_readers.h"
#include "data_tools/observations/hand_and_face_points.h"
#include "data_tools/observations/json_folder.h"
#include "data_tools/observations/observations_npz.h"
#include "data_tools/observations/people.h"
#include "data_tools/observations/people_npz.h"
#include "geometry/base/check.h"
#include "geometry/scene/observations.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

constexpr double kUsualFps = 30;
/// A clip whose every landmark lies within this many units of the corner cannot be in pixels.
constexpr double kMaxNormalised = 3;
/// Share of landmarks that may lie outside the image (plus a tenth of its size) before the size is called wrong.
constexpr double kMaxOutside = 0.5;
constexpr size_t kMaxDetectionBytes = size_t{2} << 30;
constexpr const char* kExpectedDetections =
    "expected JSON or JSON Lines (a file, or a folder with one a frame) of OpenPose, MMPose, COCO, AlphaPose, "
    "Ultralytics, easy_ViTPose or BlazePose/MediaPipe, DeepLabCut's CSV, an AIST++ keypoints2d .pkl, landmarks in a "
    ".npy "
    "(FreeMoCap, COCO), VideoPose3D's .npz, or this project's .npz with 'keypoints'";

/// The folder itself when it holds JSON files, else its sub-folder of the chosen view ("cam01" finds "cam01_json").
std::string FolderOfView(const std::string& folder, const std::string& view) {
  if (!JsonFilesOf(folder).empty()) return folder;
  const std::vector<std::string> names = FoldersOf(folder);
  if (names.empty()) throw std::runtime_error(folder + ": no .json files in this folder; " + kExpectedDetections);
  for (const std::string& name : names) {
    if (name == view || name == view + "_json" || (view.empty() && names.size() == 1)) {
      return (fs::path(folder) / name).string();
    }
  }
  throw std::runtime_error(folder + ": " + (view.empty() ? "no view chosen" : "no view '" + view + "'") +
                           "; the folder has " + PrintableList(names));
}

bool StartsLikeJson(std::string_view text) {
  const std::string_view bytes = WithoutByteOrderMark(text);
  const size_t start = bytes.find_first_not_of(" \t\r\n");
  return start != std::string_view::npos && (bytes[start] == '[' || bytes[start] == '{');
}

bool StartsLikePickle(const std::string& bytes) {
  return LooksLikeZlib(bytes) || (bytes.size() > 2 && ((bytes[0] == '\x80' && bytes[1] >= 2 && bytes[1] <= 5) ||
                                                       bytes.compare(0, 2, "(d") == 0));
}

struct Bounds {
  double lowest = 0, highest = 0;
  size_t seen = 0;
};

Bounds CoordinateBounds(const KeypointSequence& sequence) {
  Bounds bounds{INFINITY, -INFINITY, 0};
  for (const Keypoint& p : sequence.points) {
    if (!(p.confidence > 0)) continue;
    bounds.lowest = std::min({bounds.lowest, double{p.x}, double{p.y}});
    bounds.highest = std::max({bounds.highest, double{p.x}, double{p.y}});
    ++bounds.seen;
  }
  return bounds;
}

/// Calls body(point) for all points of hands and faces.
template <typename Body>
void ForEachPoint(HandsAndFaceSequence* sequence, const Body& body) {
  ChangeHandsAndFaces(
      [&body](HandsAndFace* frame) {
        for (std::optional<HandObservation>& hand : frame->hands) {
          if (hand) std::for_each(hand->points.begin(), hand->points.end(), body);
        }
        if (frame->face) std::for_each(frame->face->points.begin(), frame->face->points.end(), body);
      },
      sequence);
}

template <typename Body>
void ForEachPoint(PersonDetections* person, const Body& body) {
  std::for_each(person->body.points.begin(), person->body.points.end(), body);
  ForEachPoint(&person->hands_and_face, body);
}

/// Fractions of the image → pixels, where the body's landmarks are fractions.
void ToPixels(PersonDetections* person, bool is_openpose, const std::string& where) {
  KeypointSequence* sequence = &person->body;
  const Bounds bounds = CoordinateBounds(*sequence);
  if (bounds.highest > kMaxNormalised || bounds.lowest < -kMaxNormalised) return;
  if (sequence->image_width <= 0 || sequence->image_height <= 0) {
    throw std::runtime_error(where + ": coordinates between " + std::to_string(bounds.lowest) + " and " +
                             std::to_string(bounds.highest) +
                             " are fractions of the image, whose size is not known; give its width and height");
  }
  const bool is_symmetric = is_openpose && bounds.lowest < -0.01;  // OpenPose --keypoint_scale 4: [−1, 1]
  ForEachPoint(person, [&](Keypoint& p) {
    if (!(p.confidence > 0)) return;
    const double u = is_symmetric ? 0.5 * (p.x + 1) : p.x, v = is_symmetric ? 0.5 * (p.y + 1) : p.y;
    p.x = static_cast<float>(u * sequence->image_width - 0.5);
    p.y = static_cast<float>(v * sequence->image_height - 0.5);
  });
}

/// Throws if the image size contradicts the detections: a wrong file, a wrong video or swapped numbers.
void CheckImageSize(const KeypointSequence& sequence, const std::string& where) {
  const double w = sequence.image_width, h = sequence.image_height;
  if (w <= 0 || h <= 0) return;
  size_t seen = 0, outside = 0;
  double right = 0, bottom = 0;
  for (const Keypoint& p : sequence.points) {
    if (!(p.confidence > 0)) continue;
    ++seen;
    outside += !(p.x >= -0.1 * w && p.x <= 1.1 * w && p.y >= -0.1 * h && p.y <= 1.1 * h);
    right = std::max(right, double{p.x});
    bottom = std::max(bottom, double{p.y});
  }
  if (static_cast<double>(outside) > kMaxOutside * static_cast<double>(seen)) {
    throw std::runtime_error(where + ": " + std::to_string(outside) + " of " + std::to_string(seen) +
                             " landmarks (up to x = " + std::to_string(std::lround(right)) +
                             ", y = " + std::to_string(std::lround(bottom)) + ") lie outside an image of " +
                             std::to_string(sequence.image_width) + "x" + std::to_string(sequence.image_height) +
                             " pixels; is the image size right?");
  }
}

/// Everybody in a JSON document of any known kind.
PeopleSequence PeopleFromJson(const JsonNode& document, double fps, const std::string& convention) {
  if (IsOpenPoseJson(document)) return OpenPoseFromJson(document, fps, convention);
  if (IsMmposeJson(document)) return MmposeFromJson(document, fps);
  if (IsCocoJson(document)) return CocoFromJson(document, fps);
  if (IsUltralyticsJson(document)) return UltralyticsFromJson(document, fps);
  if (IsVitPoseJson(document)) return VitPoseFromJson(document, fps);
  if (IsBlazePoseJson(document)) return BlazePoseFromJson(document, fps);
  throw std::runtime_error(document.place() + ": JSON that holds no known detections" +
                           (document.size() == 0 ? " (it is empty)" : "") + "; " + kExpectedDetections);
}

/// Everybody in a folder with one JSON file per frame, whose kind the first file with a person shows; or in its only
/// file, of a whole clip.
PeopleSequence PeopleInFolder(const std::string& folder, const LoadDetectionsOptions& options,
                              std::vector<std::string>* warnings) {
  const double fps = options.fps > 0 ? options.fps : kUsualFps;
  const std::vector<std::string> names = JsonFilesOf(folder);
  bool is_mmpose = false, is_ultralytics = false;
  std::optional<PeopleSequence> clip;
  ReadFirstFrame(folder, names, [&](const JsonNode& document) {
    is_mmpose = IsMmposeJson(document);
    is_ultralytics = IsUltralyticsJson(document);
    if (names.size() == 1 && (IsCocoJson(document) || IsVitPoseJson(document))) {
      clip = PeopleFromJson(document, fps, options.convention);
    }
  });
  if (clip) return *std::move(clip);
  if (is_mmpose) return ReadMmposeFolder(folder, names, fps, warnings);
  if (is_ultralytics) return ReadUltralyticsFolder(folder, names, fps, warnings);
  return ReadOpenPoseFolder(folder, fps, options.convention, warnings);
}

PersonDetections Selected(const PeopleSequence& people, int number, const std::string& where) {
  const PersonTrack person = PersonOf(people, number, where);
  return {KeypointsOf(people, person), HandsAndFaceOf(people, person)};
}

/// Of formats that have the body alone.
PersonDetections BodyAlone(KeypointSequence body) { return {std::move(body), {}}; }

PersonDetections PersonOfNpz(const std::string& bytes, const std::string& path, double fps,
                             const LoadDetectionsOptions& options) {
  const NpzArrays arrays = ReadNpzBytes(bytes, path);
  if (IsVideoPose3d(arrays)) return BodyAlone(VideoPose3dFromNpz(bytes, path, options.view, fps, options.convention));
  if (HasPeople(arrays)) return Selected(PeopleFromNpz(arrays, path), options.person, path);
  if (const NdArray* array = KeypointArrayOf(arrays)) {
    return BodyAlone(KeypointsFromArray(*array, path, options.view, fps, options.convention));
  }
  if (HasKeypoints(arrays)) return BodyAlone(KeypointsFromNpz(arrays, path));
  throw std::runtime_error(path + ": an .npz without 'keypoints'" +
                           (HasDense(arrays) ? " (it holds dense keypoints)" : "") + "; " + kExpectedDetections);
}

/// One person's landmarks as in the file.
PersonDetections ReadBytes(const std::string& bytes, const std::string& path, const LoadDetectionsOptions& options,
                           std::vector<std::string>* warnings) {
  const double fps = options.fps > 0 ? options.fps : kUsualFps;
  if (bytes.empty()) throw std::runtime_error(path + ": the file is empty; " + kExpectedDetections);
  if (StartsLikeJson(bytes)) {
    const nlohmann::json json = ParseJsonLines(bytes, path, {.nan_is_null = true}, warnings);
    return Selected(PeopleFromJson(JsonNode(json, path), fps, options.convention), options.person, path);
  }
  if (LooksLikeZip(bytes)) return PersonOfNpz(bytes, path, fps, options);
  if (bytes.compare(0, 6, "\x93NUMPY") == 0) {
    const NdArray array = ReadNpyBytes(bytes, path);
    return BodyAlone(IsFreeMocap(array) && options.convention.empty()
                         ? FreeMocapFromArray(array, path, options.view, fps)
                         : KeypointsFromArray(array, path, options.view, fps, options.convention));
  }
  if (StartsLikePickle(bytes)) {
    const PicklePtr file = ReadPickle(bytes, path);
    if (IsAistKeypoints2d(*file)) {
      return BodyAlone(AistKeypoints2dFromPickle(*file, path, options.view, options.fps > 0 ? options.fps : kAistFps));
    }
    throw std::runtime_error(path + ": a pickle without 'keypoints2d'; " + kExpectedDetections);
  }
  if (IsDeepLabCutCsv(bytes)) return Selected(DeepLabCutFromCsv(bytes, path, fps), options.person, path);
  throw std::runtime_error(path + ": unknown kind of file; " + kExpectedDetections);
}

/// Applies the caller's options and the checks common to all formats.
PersonDetections Finish(PersonDetections person, const std::string& path, const LoadDetectionsOptions& options) {
  KeypointSequence& sequence = person.body;
  const bool has_other_size = options.other_width > 0 && sequence.image_width == options.other_width &&
                              sequence.image_height == options.other_height;
  if (options.image_width > 0 && !has_other_size) {
    if (sequence.image_width > 0 &&
        (sequence.image_width != options.image_width || sequence.image_height != options.image_height)) {
      throw std::runtime_error(path + ": made on images of " + std::to_string(sequence.image_width) + "x" +
                               std::to_string(sequence.image_height) + ", expected " +
                               std::to_string(options.image_width) + "x" + std::to_string(options.image_height));
    }
    sequence.image_width = options.image_width;
    sequence.image_height = options.image_height;
  }
  DropUnsure(options.min_confidence, &sequence);
  DropUnsure(options.min_confidence, &person.hands_and_face);
  if (CoordinateBounds(sequence).seen == 0) {
    throw NoPersonFound(path + ": nobody was detected in any of " + std::to_string(sequence.num_frames()) + " frames");
  }
  const bool is_openpose =
      sequence.convention == "body25" || sequence.convention == "body25b" || sequence.convention == "openpose_coco18";
  ToPixels(&person, is_openpose, path);
  CheckImageSize(sequence, path);
  person.hands_and_face.image_width = sequence.image_width;
  person.hands_and_face.image_height = sequence.image_height;
  return person;
}

void CheckOptions(const LoadDetectionsOptions& options) {
  BODYLOOM_CHECK(options.person >= 0, "person ", options.person, " must not be negative");
  BODYLOOM_CHECK(options.fps >= 0 && options.fps < 1e6, "frame rate ", options.fps, " must not be negative");
  BODYLOOM_CHECK(
      options.image_width >= 0 && options.image_height >= 0 && (options.image_width > 0) == (options.image_height > 0),
      "image size ", options.image_width, "x", options.image_height, ": give both or neither");
}

}  // namespace

void DropUnsure(double min_confidence, KeypointSequence* sequence) {
  for (Keypoint& p : sequence->points) {
    if (!(p.confidence >= min_confidence)) p = {};
  }
}

void DropUnsure(double min_confidence, HandsAndFaceSequence* sequence) {
  if (min_confidence <= 0) return;
  ForEachPoint(sequence, [min_confidence](Keypoint& p) {
    if (!(p.confidence >= min_confidence)) p = {};
  });
}

KeypointSequence DetectionsFromBytes(const std::string& bytes, const std::string& where,
                                     const LoadDetectionsOptions& options, std::vector<std::string>* warnings) {
  CheckOptions(options);
  return Finish(ReadBytes(bytes, where, options, warnings), where, options).body;
}

PersonDetections LoadPersonDetections(const std::string& path, const LoadDetectionsOptions& options,
                                      std::vector<std::string>* warnings) {
  CheckOptions(options);
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) {
    return Finish(ReadBytes(ReadFileBytes(path, kMaxDetectionBytes), path, options, warnings), path, options);
  }
  const std::string folder = FolderOfView(path, options.view);
  const PeopleSequence people = PeopleInFolder(folder, options, warnings);
  return Finish(Selected(people, options.person, folder), path, options);
}

KeypointSequence LoadDetections(const std::string& path, const LoadDetectionsOptions& options,
                                std::vector<std::string>* warnings) {
  return LoadPersonDetections(path, options, warnings).body;
}

}  // namespace bodyloom
