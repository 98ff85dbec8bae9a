// SPDX-License-Identifier: Apache-2.0
#include "data_tools/estimates/estimate_readers.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <utility>

#include "data_tools/estimates/estimate_arrays.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/csv_lines.h"
#include "data_tools/formats/printable.h"
#include "data_tools/observations/frame_numbers.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

/// COCO's 17, big toes and heels among MHR's 70.
constexpr std::array<int, 21> kMhrOfLandmark = {0, 1,  2,  3,  4,  5,  6,  7,  8,  62, 41,
                                                9, 10, 11, 12, 13, 14, 15, 18, 17, 20};
constexpr int kLeftHip = 11;
constexpr double kMaxResidual_px = 1;
constexpr std::string_view kCsvHeader = "frame,skeleton_id,nose_x,nose_y,nose_z,";
constexpr std::string_view kPersonCsvHeader = "nose_3DX,nose_3DY,nose_3DZ,";

/// x = f X/Z + cx, y = f Y/Z + cy by least squares.
Camera CameraOf(const RowMatrixXd& points, const RowMatrixXd& pixels, const std::string& where) {
  const Eigen::Index n = points.rows();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 3);
  Eigen::VectorXd b(2 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    if (!(points(k, 2) > Camera::kMinDepth)) ThrowFileError(where, "pred_cam_t", "a landmark behind the camera");
    for (int c = 0; c < 2; ++c) {
      A(2 * k + c, 0) = points(k, c) / points(k, 2);
      A(2 * k + c, 1 + c) = 1;
      b[2 * k + c] = pixels(k, c);
    }
  }
  const Eigen::VectorXd solution = A.colPivHouseholderQr().solve(b);
  const double worst = (A * solution - b).cwiseAbs().maxCoeff();
  if (!solution.allFinite() || !(solution[0] > 0) || !(worst < kMaxResidual_px)) {
    ThrowFileError(where, "pred_keypoints_2d",
                   Concatenate("is up to ", worst,
                               " px off a projection of pred_keypoints_3d + pred_cam_t, expected the same "
                               "person in one pinhole camera"));
  }
  Camera camera;
  camera.fx = camera.fy = solution[0];
  camera.cx = solution[1];
  camera.cy = solution[2];
  // The principal point is the middle of the image.
  camera.width = static_cast<int>(std::lround(std::clamp(2 * camera.cx, 0.0, 1e6)));
  camera.height = static_cast<int>(std::lround(std::clamp(2 * camera.cy, 0.0, 1e6)));
  return camera;
}

/// The landmarks that the fit takes among MHR's 70.
MatrixX3d LandmarksAmong(const RowMatrixXd& points) {
  MatrixX3d landmarks(static_cast<Eigen::Index>(kMhrOfLandmark.size()), 3);
  for (Eigen::Index k = 0; k < landmarks.rows(); ++k) {
    landmarks.row(k) = points.row(kMhrOfLandmark[static_cast<size_t>(k)]);
  }
  return landmarks;
}

void AppendLandmarks(const MatrixX3d& landmarks, const std::string& where, int frame, const Camera& camera,
                     PersonEstimate* person) {
  constexpr double kFarthest_m = 1e4;
  if (!(landmarks.cwiseAbs().maxCoeff() < kFarthest_m)) ThrowFileError(where, "landmarks farther than 10 km");
  const Eigen::RowVector3d hips = 0.5 * (landmarks.row(kLeftHip) + landmarks.row(kLeftHip + 1));
  person->cameras.push_back(camera);
  person->frames.push_back(frame);
  person->landmarks.emplace_back(landmarks.rowwise() - hips);
  person->trans.conservativeResize(person->trans.rows() + 1, Eigen::NoChange);
  person->trans.bottomRows<1>() = hips;
  person->poses.resize(person->trans.rows(), 0);
}

/// One image's person, appended as that frame.
void Append(const NpzArrays& arrays, const std::string& where, int frame, int width, int height,
            PersonEstimate* person) {
  const auto matrix = [&](const char* key, const std::vector<int64_t>& shape) {
    return RequireShape(RequireArray(arrays, key, where), shape, where, key);
  };
  RowMatrixXd points = matrix("pred_keypoints_3d", {70, 3});
  const RowMatrixXd place = matrix("pred_cam_t", {3});
  points.rowwise() += Eigen::RowVector3d(place(0), place(1), place(2));
  const auto focal = arrays.find("focal_length");
  const bool has_pixels = arrays.count("pred_keypoints_2d") > 0 || focal == arrays.end() || width <= 0 || height <= 0;
  Camera camera;
  if (has_pixels) {
    camera = CameraOf(points, matrix("pred_keypoints_2d", {70, 2}), where);
  } else {
    const RowMatrixXd number = RequireShape(focal->second, focal->second.shape, where, "focal_length");
    if (number.size() != 1 || !(number(0) > 0)) ThrowFileError(where, "focal_length", "expected one above 0 px");
    camera = CentredCamera(width, height, number(0));
  }
  AppendLandmarks(LandmarksAmong(points), where, frame, camera, person);
}

/// The arrays of a JSON person that are read.
NpzArrays ArraysOf(const JsonNode& node) {
  NpzArrays arrays;
  for (const auto& [key, shape] : {std::pair<const char*, std::vector<int64_t>>{"pred_keypoints_3d", {70, 3}},
                                   {"pred_keypoints_2d", {70, 2}},
                                   {"pred_cam_t", {3}}}) {
    if (!node.Has(key) || node.At(key).is_null()) continue;
    const int count = static_cast<int>(shape[0] * (shape.size() > 1 ? shape[1] : 1));
    arrays[key] = NdArray::FromDoubles(node.At(key).Numbers(count).data(), shape);
  }
  if (node.Has("focal_length") && !node.At("focal_length").is_null()) {
    const JsonNode focal = node.At("focal_length");
    arrays["focal_length"] = NdArray::FromDouble(focal.is_array() ? focal.Numbers(1)[0] : focal.Number());
  }
  return arrays;
}

/// Calls take(index, person) for an object's one person or a list's.
template <typename Take>
void ForEachPerson(const JsonNode& document, const Take& take) {
  if (!document.is_array()) return take(size_t{0}, document);
  for (size_t i = 0; i < document.size(); ++i) take(i, document.At(i));
}

BodyEstimate Empty() {
  BodyEstimate estimate;
  estimate.system = "SAM 3D Body";
  estimate.body = "mhr";
  estimate.has_landmarks = true;
  return estimate;
}

}  // namespace

bool IsSam3dBody(const NpzArrays& arrays) {
  return arrays.count("pred_keypoints_3d") > 0 && arrays.count("pred_cam_t") > 0;
}

BodyEstimate Sam3dBodyFromNpz(const NpzArrays& arrays, const std::string& where, int image_width, int image_height) {
  BodyEstimate estimate = Empty();
  estimate.people.emplace_back().name = "0";
  Append(arrays, where, 0, image_width, image_height, &estimate.people[0]);
  return estimate;
}

bool IsSam3dBody(const JsonNode& document) {
  if (document.is_array()) return document.size() > 0 && IsSam3dBody(document.At(0));
  return document.Has("pred_keypoints_3d") && document.Has("pred_cam_t");
}

BodyEstimate Sam3dBodyFromJson(const JsonNode& document, int image_width, int image_height) {
  BodyEstimate estimate = Empty();
  ForEachPerson(document, [&](size_t i, const JsonNode& node) {
    estimate.people.emplace_back().name = std::to_string(i);
    Append(ArraysOf(node), node.place(), 0, image_width, image_height, &estimate.people.back());
  });
  SortEstimate(document.place(), &estimate);
  return estimate;
}

bool IsSam3dBodyCsv(std::string_view text) {
  text = WithoutByteOrderMark(text);
  return text.starts_with(kCsvHeader) || text.starts_with(kPersonCsvHeader);
}

BodyEstimate Sam3dBodyFromCsv(std::string_view text, const std::string& where) {
  constexpr size_t kValues = 3 * 70;
  CsvLines lines(text, where);
  CsvCells cells;
  lines.Next(&cells);
  const size_t first = cells[0] == "frame" ? 2 : 0;
  const auto require_cells = [&] {
    if (cells.size() != first + kValues) {
      lines.Fail(Concatenate(cells.size(), " cells, expected ", first + kValues, ", those of MHR's 70 landmarks"));
    }
  };
  require_cells();
  BodyEstimate estimate = Empty();
  estimate.system = "SAM3DBody-cpp";
  estimate.has_places = false;
  std::map<int64_t, PersonEstimate> people;
  const auto whole = [&](std::string_view cell, int64_t lowest) {
    const double number = lines.Number(cell);
    if (!(number >= lowest && number < kMaxEstimateFrames && number == std::floor(number))) {
      lines.Fail("found '" + PrintableText(cell) + Concatenate("', expected a whole number from ", lowest));
    }
    return static_cast<int64_t>(number);
  };
  for (int64_t row = 0; lines.Next(&cells); ++row) {
    require_cells();
    if (row >= kMaxEstimateFrames) lines.Fail("too many rows");
    const int64_t frame = first > 0 ? whole(cells[0], 1) - 1 : row;
    const int64_t skeleton = first > 0 ? whole(cells[1], 0) : 0;
    RowMatrixXd points(70, 3);
    for (size_t i = 0; i < kValues; ++i) points.data()[i] = lines.Number(cells[first + i]);
    if (points.isZero(0)) continue;
    if (!points.allFinite()) lines.Fail("a coordinate that is no number");
    PersonEstimate& person = people[skeleton];
    person.name = std::to_string(skeleton);
    // A stand-in until it is placed.
    points.col(2).array() += 1 - 0.5 * (points(kMhrOfLandmark[kLeftHip], 2) + points(kMhrOfLandmark[kLeftHip + 1], 2));
    AppendLandmarks(LandmarksAmong(points), where, static_cast<int>(frame), Camera(), &person);
  }
  for (auto& [id, person] : people) estimate.people.push_back(std::move(person));
  SortEstimate(where, &estimate);
  return estimate;
}

BodyEstimate ReadSam3dBodyFolder(const std::string& folder, int image_width, int image_height) {
  static const std::regex person_ending("_(?:subj|person|p)([0-9]{1,6})$");
  std::map<std::string, PersonEstimate> people;
  for (const std::string& path : FilesBelow(folder)) {
    std::string stem = fs::path(path).stem().string(), person = "0";
    if (std::smatch match; std::regex_search(stem, match, person_ending)) {
      person = match[1].str();
      stem = std::string(match.prefix());
    }
    const int64_t number = FrameNumberFromName(stem);
    const auto append = [&](const std::string& name, const NpzArrays& arrays, const std::string& where) {
      if (number >= kMaxEstimateFrames) ThrowFileError(path, "the number of its frame is too large");
      people[name].name = name;
      Append(arrays, where, static_cast<int>(std::max<int64_t>(number, 0)), image_width, image_height, &people[name]);
    };
    if (path.ends_with(".npz")) {
      const NpzArrays arrays = ReadNpz(path);
      if (IsSam3dBody(arrays)) append(person, arrays, path);
    } else if (path.ends_with(".json")) {
      const nlohmann::json json = ReadJsonFile(path);
      const JsonNode document(json, path);
      if (!IsSam3dBody(document)) continue;
      ForEachPerson(document, [&](size_t i, const JsonNode& node) {
        append(document.is_array() ? std::to_string(i) : person, ArraysOf(node), node.place());
      });
    }
  }
  BodyEstimate estimate = Empty();
  for (auto& [name, person] : people) estimate.people.push_back(std::move(person));
  SortEstimate(folder, &estimate);
  return estimate;
}

}  // namespace bodyloom
