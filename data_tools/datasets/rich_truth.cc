// SPDX-License-Identifier: Apache-2.0
#include "data_tools/datasets/video_truth.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "data_tools/estimates/estimate_arrays.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/printable.h"
#include "data_tools/observations/json_folder.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

constexpr Eigen::Index kRichPose = 66, kRichFixed = 69;
constexpr int kMaxRichFrames = 100'000;

bool IsNumber(const std::string& name) {
  return !name.empty() && name.size() < 9 &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::vector<std::string> FramesOf(const std::string& folder) {
  std::vector<std::string> names = FoldersOf(folder);
  std::erase_if(names, [](const std::string& name) { return !IsNumber(name); });
  return names;
}

/// Names of the files of a folder with this extension, without it.
std::set<std::string> StemsOf(const std::string& folder, const char* extension) {
  std::set<std::string> stems;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == extension) stems.insert(it->path().stem().string());
  }
  if (error) ThrowFileError(folder, "cannot list the folder: " + error.message());
  return stems;
}

/// Numbers of <NAME …><data>…</data></NAME>.
std::vector<double> NumbersOf(std::string_view text, const std::string& name, const std::string& where) {
  const auto fail = [&](const std::string& message) { ThrowFileError(where, name, message); };
  const size_t begin = text.find("<" + name), end = text.find("</" + name + ">");
  if (begin == std::string_view::npos || end == std::string_view::npos || end < begin) fail("is not there");
  const std::string_view inside = text.substr(begin, end - begin);
  const size_t open = inside.find("<data>"), close = inside.find("</data>");
  if (open == std::string_view::npos || close == std::string_view::npos || close < open) fail("has no <data>");
  std::string_view rest = inside.substr(open + 6, close - open - 6);
  std::vector<double> numbers;
  for (;;) {
    const size_t first = rest.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return numbers;
    rest = rest.substr(first);
    const size_t length = std::min(rest.find_first_of(" \t\r\n"), rest.size());
    double value = 0;
    const auto [stop, error] = std::from_chars(rest.data(), rest.data() + length, value);
    if (error != std::errc() || stop != rest.data() + length || !std::isfinite(value)) {
      fail("found '" + PrintableText(rest.substr(0, length)) + "', expected a number");
    }
    numbers.push_back(value);
    if (numbers.size() > 100) fail("more than 100 numbers, expected those of a camera");
    rest = rest.substr(length);
  }
}

std::vector<double> NumbersOf(std::string_view text, const std::string& name, size_t count, const std::string& where) {
  std::vector<double> numbers = NumbersOf(text, name, where);
  if (numbers.size() != count) {
    ThrowFileError(where, name, Concatenate(numbers.size(), " numbers, expected ", count));
  }
  return numbers;
}

/// Entry `key`, n or 1×n numbers; −1: any number of them.
Eigen::RowVectorXd RowOf(const PickleValue& file, const std::string& key, Eigen::Index n, const std::string& where) {
  const NdArray& array = RequireNumbers(file, key, where);
  const RowMatrixXd numbers = RequireShape(array, array.shape, where, key);
  if (numbers.size() == 0 || numbers.size() > 300 || (n >= 0 && numbers.size() != n)) {
    ThrowFileError(where, key,
                   array.ShapeText() + ", expected " + (n < 0 ? "1 to 300" : std::to_string(n)) + " numbers");
  }
  return Eigen::Map<const Eigen::RowVectorXd>(numbers.data(), numbers.size());
}

}  // namespace

bool IsRichSequence(const std::string& folder) { return !FramesOf(folder).empty(); }

Eigen::RowVectorXd RichBodyFromPickle(const PickleValue& file, const std::string& where) {
  const Eigen::RowVectorXd betas = RowOf(file, "betas", -1, where);
  Eigen::RowVectorXd body(kRichFixed + betas.size());
  body << RowOf(file, "global_orient", 3, where), RowOf(file, "body_pose", 63, where), RowOf(file, "transl", 3, where),
      betas;
  return body;
}

NamedCamera RichCameraFromXml(const std::string& text, const std::string& where) {
  constexpr double kNotRigid = 1e-3, kLargestImage_px = 1e5;
  const std::vector<double> pose = NumbersOf(text, "CameraMatrix", 12, where);
  const std::vector<double> k = NumbersOf(text, "Intrinsics", 9, where);
  const std::vector<double> distortion = NumbersOf(text, "Distortion", where);
  NamedCamera named;
  named.has_pose = true;
  Camera& camera = named.camera;
  camera.model = CameraModel::kPinhole;
  camera.fx = k[0], camera.fy = k[4], camera.cx = k[2], camera.cy = k[5];
  if (!(k[0] > 0 && k[4] > 0 && k[8] == 1 && k[2] >= 1 && k[5] >= 1 && std::max(k[2], k[5]) < kLargestImage_px)) {
    ThrowFileError(where, "Intrinsics", "expected [fx 0 cx; 0 fy cy; 0 0 1] with focal lengths above 0, in pixels");
  }
  camera.width = int(std::lround(2 * camera.cx)), camera.height = int(std::lround(2 * camera.cy));
  for (size_t i = 0; i < distortion.size(); ++i) {
    if (i < camera.distortion.size()) {
      camera.distortion[i] = distortion[i];
    } else if (distortion[i] != 0) {
      ThrowFileError(where, "Distortion", Concatenate(distortion.size(), " numbers, expected 8 at most other than 0"));
    }
  }
  const Eigen::Matrix<double, 3, 4> matrix =
      Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(pose.data());
  if (!IsRotation(matrix.leftCols<3>(), kNotRigid))
    ThrowFileError(where, "CameraMatrix", "expected [R|t], R a rotation");
  named.pose = {NearestRotation(matrix.leftCols<3>()), matrix.col(3)};
  return named;
}

NamedCamera ReadRichCamera(const std::string& path, const std::string& view) {
  constexpr size_t kLargestXml = size_t{1} << 20;
  std::string file = path;
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    const fs::path inner = fs::path(path) / "calibration";
    const fs::path folder = fs::is_directory(inner, ignored) ? inner : fs::path(path);
    const std::set<std::string> names = StemsOf(folder.string(), ".xml");
    const auto is_view = [&](const std::string& name) {
      return name == view || (IsNumber(name) && IsNumber(view) && std::stoi(name) == std::stoi(view)) ||
             (view.empty() && names.size() == 1);
    };
    const auto found = std::find_if(names.begin(), names.end(), is_view);
    if (found == names.end()) {
      ThrowFileError(path, (view.empty() ? std::string("no view chosen") : "no camera '" + PrintableText(view) + "'") +
                               "; it has " + PrintableList({names.begin(), names.end()}));
    }
    file = (folder / (*found + ".xml")).string();
  }
  NamedCamera camera = RichCameraFromXml(ReadFileBytes(file, kLargestXml), file);
  camera.name = fs::path(file).stem().string();
  return camera;
}

VideoTruth ReadRichTruth(const std::string& folder, int person, const NamedCamera& camera) {
  BODYLOOM_CHECK(person >= 0, "person ", person, " must not be negative");
  const std::vector<std::string> frames = FramesOf(folder);
  std::map<int, std::set<std::string>> subjects_of;
  std::set<std::string> subjects;
  for (const std::string& frame : frames) {
    std::set<std::string>& present = subjects_of[std::stoi(frame)];
    present = StemsOf((fs::path(folder) / frame).string(), ".pkl");
    subjects.insert(present.begin(), present.end());
  }
  if (size_t(person) >= subjects.size()) {
    ThrowFileError(folder, Concatenate(subjects.size(), " people (", PrintableList({subjects.begin(), subjects.end()}),
                                       "), expected one with number ", person));
  }
  const std::string subject = *std::next(subjects.begin(), person);
  const int first = subjects_of.begin()->first, T = subjects_of.rbegin()->first - first + 1;
  if (T > kMaxRichFrames) ThrowFileError(folder, Concatenate(T, " frames, expected ", kMaxRichFrames, " at most"));

  VideoTruth truth;
  truth.dataset = "RICH";
  truth.protocol = "rich";
  truth.sequence = fs::path(folder).filename().string();
  truth.subject = subject;
  truth.num_people = int(subjects.size());
  Track& track = truth.track;
  track.motion.body = "smplx";
  SetLostFrames(T, kRichPose, camera, &truth);
  int seen = 0;
  for (const std::string& frame : frames) {
    if (subjects_of[std::stoi(frame)].count(subject) == 0) continue;
    const std::string path = (fs::path(folder) / frame / (subject + ".pkl")).string();
    const Eigen::RowVectorXd body = RichBodyFromPickle(*ReadPickleFile(path), path);
    const Eigen::VectorXd betas = body.tail(body.size() - kRichFixed).transpose();
    if (seen == 0) track.motion.betas.setZero(betas.size());
    if (betas.size() != track.motion.betas.size()) {
      ThrowFileError(
          path, "betas",
          Concatenate(betas.size(), ", expected ", track.motion.betas.size(), " as in the subject's first frame"));
    }
    const int t = std::stoi(frame) - first;
    track.motion.betas += betas;
    track.motion.poses.row(t) = body.head(kRichPose);
    track.motion.trans.row(t) = body.segment<3>(kRichPose);
    track.frame_status[size_t(t)] = FrameStatus::kTracked;
    ++seen;
  }
  track.motion.betas /= seen;
  return truth;
}

}  // namespace bodyloom
