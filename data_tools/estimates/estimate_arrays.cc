// SPDX-License-Identifier: Apache-2.0
#include "data_tools/estimates/estimate_arrays.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "data_tools/body/body_landmarks.h"
#include "data_tools/formats/ndarray.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"

namespace bodyloom {
namespace {

/// Size times time: Σ over the frames of a person's pixels a metre.
double WeightInView(const PersonEstimate& person, const Eigen::Vector3d& rest_pelvis) {
  double sum = 0;
  for (size_t i = 0; i < person.frames.size(); ++i) {
    if (const auto seen = PelvisOf(person, i, rest_pelvis)) sum += seen->px_per_metre;
  }
  return sum;
}

void SortFrames(const std::string& where, PersonEstimate* person) {
  const size_t n = person->frames.size();
  std::vector<size_t> order(n);
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return person->frames[a] < person->frames[b]; });
  PersonEstimate sorted = *person;
  for (size_t i = 0; i < n; ++i) {
    const auto from = static_cast<Eigen::Index>(order[i]), to = static_cast<Eigen::Index>(i);
    sorted.frames[i] = person->frames[order[i]];
    sorted.poses.row(to) = person->poses.row(from);
    sorted.trans.row(to) = person->trans.row(from);
    sorted.cameras[i] = person->cameras[order[i]];
    if (!sorted.landmarks.empty()) sorted.landmarks[i] = person->landmarks[order[i]];
    if (i > 0 && sorted.frames[i] == sorted.frames[i - 1]) {
      ThrowFileError(
          where, Concatenate("person ", PrintableText(person->name), ": frame ", sorted.frames[i], " occurs twice"));
    }
  }
  *person = std::move(sorted);
}

void AppendNumbers(const PickleValue& value, const std::string& place, const std::string& key,
                   std::vector<double>* numbers) {
  if (value.kind == PickleValue::Kind::kArray && value.array.is_number()) {
    const std::vector<double> of_array = value.array.ToDoubles();
    numbers->insert(numbers->end(), of_array.begin(), of_array.end());
  } else if (value.kind == PickleValue::Kind::kInt || value.kind == PickleValue::Kind::kFloat) {
    numbers->push_back(value.kind == PickleValue::Kind::kInt ? static_cast<double>(value.integer) : value.real);
  } else if (value.kind == PickleValue::Kind::kList || value.kind == PickleValue::Kind::kTuple) {
    for (const PicklePtr& item : value.items) AppendNumbers(*item, place, key, numbers);
  } else {
    ThrowFileError(place, key, "expected numbers");
  }
}

}  // namespace

RowMatrixXd RequireShape(const NdArray& array, const std::vector<int64_t>& shape, const std::string& where,
                         const std::string& key) {
  bool fits = array.is_number() && array.shape.size() == shape.size();
  std::string expected;
  for (size_t d = 0; d < shape.size(); ++d) {
    fits = fits && (shape[d] < 0 || array.shape[d] == shape[d]);
    expected += (d == 0 ? "" : "x") + (shape[d] < 0 ? std::string("n") : std::to_string(shape[d]));
  }
  if (!fits) {
    ThrowFileError(where, key,
                   (array.is_number() ? array.ShapeText() : "not numbers") + std::string(", expected ") + expected);
  }
  RowMatrixXd matrix = array.ToMatrix();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    if (!matrix.row(i).allFinite()) ThrowFileError(where, key, Concatenate("row ", i, " is not finite"));
  }
  return matrix;
}

std::vector<int> RequireFrameNumbers(const NdArray& array, int64_t count, const std::string& where,
                                     const std::string& key) {
  RequireShape(array, {count}, where, key);
  std::vector<int> frames;
  for (const int64_t number : WholeNumbers(array, key, where)) {
    if (number < 0 || number >= kMaxEstimateFrames) {
      ThrowFileError(where, key, Concatenate(number, ", expected frame numbers from 0 to ", kMaxEstimateFrames - 1));
    }
    frames.push_back(static_cast<int>(number));
  }
  return frames;
}

Eigen::VectorXd MeanBetas(const NdArray& array, int64_t n, const std::string& where) {
  constexpr Eigen::Index kMaxBetas = 300;
  const RowMatrixXd betas = RequireShape(array, {n, -1}, where, "betas");
  if (betas.cols() > kMaxBetas)
    ThrowFileError(where, "betas", Concatenate(betas.cols(), " a frame, expected ", kMaxBetas));
  return n > 0 ? Eigen::VectorXd(betas.colwise().mean().transpose()) : Eigen::VectorXd::Zero(betas.cols());
}

Eigen::Vector3d AxisAngleFromRows(const Eigen::Ref<const Eigen::RowVectorXd>& nine, const std::string& where,
                                  const std::string& key) {
  constexpr double kMaxOff = 1e-2;  // float16 and averaged matrices are off by less
  Eigen::Matrix3d matrix;
  for (int r = 0; r < 3; ++r) matrix.row(r) = nine.segment<3>(3 * r);
  if (!IsRotation(matrix, kMaxOff)) ThrowFileError(where, key, "expected rotation matrices, row by row");
  return AxisAngleFromRotation(NearestRotation(matrix));
}

Camera CentredCamera(int width, int height, double focal_px) {
  Camera camera = MakePinhole(width, height, focal_px);
  camera.cx = 0.5 * width;
  camera.cy = 0.5 * height;
  return camera;
}

Camera CameraFromK(const Eigen::Ref<const Eigen::RowVectorXd>& k, const std::string& where, const std::string& key) {
  if (!(k[0] > 0) || !(k[4] > 0) || k[8] != 1 || k[1] != 0 || k[3] != 0) {
    ThrowFileError(where, key, "expected [fx 0 cx; 0 fy cy; 0 0 1]");
  }
  Camera camera;
  camera.fx = k[0];
  camera.fy = k[4];
  camera.cx = k[2];
  camera.cy = k[5];
  // The principal point is the middle of the image.
  camera.width = static_cast<int>(std::lround(std::min(2 * std::abs(k[2]), 1e6)));
  camera.height = static_cast<int>(std::lround(std::min(2 * std::abs(k[5]), 1e6)));
  return camera;
}

const NdArray& RequireTensor(const WeightsFile& file, const std::string& name, const std::string& where) {
  const auto found = file.tensors.find(name);
  if (found == file.tensors.end()) ThrowFileError(where, "no tensor '" + name + "'");
  return found->second;
}

void SetInCameraMotion(const WeightsFile& file, const std::string& prefix, int64_t L, const std::string& where,
                       PersonEstimate* person) {
  const auto matrix = [&](const std::string& name, const std::vector<int64_t>& shape) {
    return RequireShape(RequireTensor(file, name, where), shape, where, name);
  };
  person->name = "0";
  person->poses.setZero(L, 72);
  person->poses.leftCols<3>() = matrix(prefix + "global_orient", {L, 3});
  person->trans = matrix(prefix + "transl", {L, 3});
  const RowMatrixXd k = matrix("K_fullimg", {L, 3, 3});
  for (Eigen::Index i = 0; i < k.rows(); ++i) {
    person->cameras.push_back(CameraFromK(k.row(i), where, Concatenate("K_fullimg: frame ", i)));
  }
  person->frames.resize(static_cast<size_t>(L));
  std::iota(person->frames.begin(), person->frames.end(), 0);
}

Eigen::RowVectorXd RequireCount(const PickleValue* value, size_t count, const std::string& place,
                                const std::string& key) {
  if (value == nullptr) ThrowFileError(place, key, "is not there");
  std::vector<double> numbers;
  AppendNumbers(*value, place, key, &numbers);
  if (numbers.size() != count ||
      !std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); })) {
    ThrowFileError(place, key, Concatenate(numbers.size(), " numbers, expected ", count, " finite ones"));
  }
  return Eigen::Map<const Eigen::RowVectorXd>(numbers.data(), static_cast<Eigen::Index>(count));
}

BodyEstimate SmplPeople(
    const PickleValue& file, const std::string& where, const std::string& system,
    const std::function<void(const PickleValue& values, const std::string& place, PersonEstimate* person)>& rest) {
  BodyEstimate estimate;
  estimate.system = system;
  estimate.body = "smpl";
  estimate.rest_pelvis = MeanPelvis(estimate.body);
  for (const auto& [name, value] : file.dict) {
    const std::string place = where + ": person " + PrintableText(name);
    PersonEstimate& person = estimate.people.emplace_back();
    person.name = name;
    person.poses = RequireShape(RequireNumbers(*value, "pose", place), {-1, 72}, place, "pose");
    const int64_t n = person.poses.rows();
    person.trans.setZero(n, 3);
    person.betas = MeanBetas(RequireNumbers(*value, "betas", place), n, place);
    person.frames = RequireFrameNumbers(RequireNumbers(*value, "frame_ids", place), n, place, "frame_ids");
    rest(*value, place, &person);
  }
  SortEstimate(where, &estimate);
  return estimate;
}

void SortEstimate(const std::string& where, BodyEstimate* estimate) {
  std::erase_if(estimate->people, [](const PersonEstimate& person) { return person.frames.empty(); });
  if (estimate->people.empty()) ThrowFileError(where, estimate->system + ": nobody in any frame");
  std::vector<std::pair<double, size_t>> order;
  for (size_t p = 0; p < estimate->people.size(); ++p) {
    SortFrames(where, &estimate->people[p]);
    order.emplace_back(-WeightInView(estimate->people[p], estimate->rest_pelvis), p);
  }
  std::sort(order.begin(), order.end());
  std::vector<PersonEstimate> people;
  people.reserve(order.size());
  for (const auto& [weight, p] : order) people.push_back(std::move(estimate->people[p]));
  estimate->people = std::move(people);
}

}  // namespace bodyloom
