// SPDX-License-Identifier: Apache-2.0
#include "data_tools/avatar/avatar_file.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

static_assert(std::endian::native == std::endian::little, "floats are written as they lie in memory");

constexpr double kSh0 = 0.28209479177387814;
constexpr std::array<const char*, 17> kPlyProperties = {"x",       "y",      "z",      "nx",      "ny",      "nz",
                                                        "f_dc_0",  "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1",
                                                        "scale_2", "rot_0",  "rot_1",  "rot_2",   "rot_3"};
using PlyRow = std::array<float, kPlyProperties.size()>;

bool PlyRowOf(const FloatColumns& table, int row, PlyRow* values) {
  for (int c = 0; c < CameraGaussians::kNumColumns; ++c) {
    if (!std::isfinite(table(row, c))) return false;
  }
  Eigen::Matrix3d factor;
  for (int k = 0; k < 9; ++k) factor(k / 3, k % 3) = table(row, CameraGaussians::kFactor + k);
  // Smallest first; largest first with the middle one kept in place is a mirror, undone below.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(factor * factor.transpose());
  Eigen::Matrix3d axes;
  for (int k = 0; k < 3; ++k) {
    axes.col(k) = solver.eigenvectors().col(2 - k);
    (*values)[10 + k] = static_cast<float>(0.5 * std::log(std::max(1e-14, solver.eigenvalues()[2 - k])));
  }
  if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
  const Eigen::Quaterniond turn(axes);
  const double opacity = std::clamp<double>(table(row, CameraGaussians::kOpacity), 1e-6, 1 - 1e-6);
  for (int k = 0; k < 3; ++k) {
    (*values)[k] = table(row, CameraGaussians::kX + k);
    (*values)[3 + k] = 0;
    (*values)[6 + k] = static_cast<float>((table(row, CameraGaussians::kRed + k) - 0.5) / kSh0);
  }
  (*values)[9] = static_cast<float>(std::log(opacity / (1 - opacity)));
  const std::array<double, 4> rotation = {turn.w(), turn.x(), turn.y(), turn.z()};
  std::copy(rotation.begin(), rotation.end(), values->begin() + 13);
  return true;
}

constexpr const char* kAvatarFormat = "bodyloom avatar";
constexpr int kAvatarVersion = 2, kVersionWithoutKinds = 1;
constexpr int64_t kMaxGaussians = 10000000, kMaxShape = 1000, kMaxPoses = 10000000, kMaxNodes = 100000;
constexpr double kMaxLoss = 1e9, kMaxSteps = 1e15;
constexpr int kColumns = GaussianBody::kNumParameters, kInfluences = GaussianBody::kInfluences;

NdArray FromTable(const FloatColumns& table) {
  std::vector<float> rows(static_cast<size_t>(table.rows()) * table.columns());
  for (int c = 0; c < table.columns(); ++c) {
    for (int i = 0; i < table.rows(); ++i) rows[static_cast<size_t>(i) * table.columns() + c] = table(i, c);
  }
  return NdArray::FromFloats(rows.data(), {table.rows(), table.columns()});
}

/// The arrays of one file, each checked for type and shape when it is taken.
class AvatarArrays {
 public:
  AvatarArrays(const NpzArrays& arrays, std::string where) : arrays_(arrays), where_(std::move(where)) {}

  [[nodiscard]] const std::string& where() const { return where_; }
  [[noreturn]] void Fail(const std::string& key, const std::string& message) const {
    ThrowFileError(where_, key, message);
  }

  const NdArray& Take(const std::string& key, DType type, const char* type_name,
                      const std::vector<int64_t>& shape) const {
    const NdArray& array = RequireArray(arrays_, key, where_);
    if (array.dtype != type || array.shape != shape) {
      NdArray expected;
      expected.shape = shape;
      Fail(key, Concatenate("an array of ", array.ShapeText(), " of ", array.item_size, " bytes each, expected ",
                            expected.ShapeText(), " ", type_name));
    }
    return array;
  }
  std::vector<float> Floats(const std::string& key, const std::vector<int64_t>& shape) const {
    std::vector<float> values = Take(key, DType::kF32, "float32", shape).ToFloats();
    if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); })) {
      Fail(key, "numbers that are not finite");
    }
    return values;
  }
  /// Within low..high.
  std::vector<double> Doubles(const std::string& key, const std::vector<int64_t>& shape, double low,
                              double high) const {
    std::vector<double> values = Take(key, DType::kF64, "float64", shape).ToDoubles();
    for (const double v : values) {
      if (!(v >= low && v <= high)) Fail(key, Concatenate(v, ", expected ", low, " to ", high));
    }
    return values;
  }
  /// Within low..high.
  std::vector<int32_t> Ints(const std::string& key, const std::vector<int64_t>& shape, int64_t low,
                            int64_t high) const {
    const std::vector<int64_t> values = Take(key, DType::kI32, "int32", shape).ToInts();
    for (const int64_t v : values) {
      if (v < low || v > high) Fail(key, Concatenate(v, ", expected ", low, " to ", high));
    }
    return {values.begin(), values.end()};
  }
  FloatColumns Table(const std::string& key, int columns, int64_t rows) const {
    const std::vector<float> values = Floats(key, {rows, columns});
    FloatColumns table(columns, static_cast<int>(rows));
    table.Fill(0);
    for (int64_t i = 0; i < rows; ++i) {
      for (int c = 0; c < columns; ++c) table(static_cast<int>(i), c) = values[i * columns + c];
    }
    return table;
  }
  std::string Text(const std::string& key) const {
    const NdArray& array = RequireArray(arrays_, key, where_);
    if (!array.is_text() || array.num_elements() != 1)
      Fail(key, "an array of " + array.ShapeText() + ", expected a text");
    return array.ToStrings()[0];
  }
  /// At least 0.
  double Number(const std::string& key) const {
    const double value = Take(key, DType::kF64, "float64", {}).ToDoubles()[0];
    if (!(value >= 0 && value < 1e15)) Fail(key, Concatenate(value, ", expected 0 or more"));
    return value;
  }
  int64_t Step(const std::string& key) const {
    const double step = Number(key);
    if (step != std::floor(step)) Fail(key, Concatenate(step, ", expected a whole number"));
    return static_cast<int64_t>(step);
  }
  /// Rows of `parameters`, which must be present before memory is allocated for them.
  int64_t NumRows() const {
    const NdArray& array = RequireArray(arrays_, "parameters", where_);
    if (array.shape.size() != 2 || array.shape[1] != kColumns || array.shape[0] < 1 || array.shape[0] > kMaxGaussians) {
      Fail("parameters",
           Concatenate("an array of ", array.ShapeText(), ", expected Nx", kColumns, ", N from 1 to ", kMaxGaussians));
    }
    return array.shape[0];
  }
  Eigen::VectorXd Betas() const {
    const NdArray& array = RequireArray(arrays_, "betas", where_);
    if (array.dtype != DType::kF64 || array.shape.size() != 1 || array.shape[0] > kMaxShape) {
      Fail("betas", Concatenate("an array of ", array.ShapeText(), ", expected at most ", kMaxShape, " float64"));
    }
    const std::vector<double> values = array.ToDoubles();
    if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
      Fail("betas", "numbers that are not finite");
    }
    return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  }

 private:
  const NpzArrays& arrays_;
  std::string where_;
};

void PutGarment(const AvatarGarment& garment, NpzArrays* to) {
  const LooseGarmentOptions& cut = garment.cut;
  const double cut_numbers[5] = {cut.waist_y_m, cut.length_m, cut.fullness, cut.spacing_m, garment.node_spacing_m};
  (*to)["garment_cut"] = NdArray::FromDoubles(cut_numbers, {5});
  (*to)["garment_offsets"] =
      NdArray::FromFloats(garment.offsets_m.data(), {static_cast<int64_t>(garment.offsets_m.size())});
  (*to)["garment_nodes"] = NdArray::FromFloats(garment.nodes.data(), {garment.num_nodes(), 3});
}

void PutAvatar(const AvatarFile& avatar, const GaussianBody& body, NpzArrays* to) {
  std::string why;
  BODYLOOM_CHECK(body.IsValid(avatar.num_bones(), avatar.num_faces, &why), "writing an avatar: ", why);
  const int64_t count = body.size();
  std::vector<int32_t> faces;
  std::vector<float> barycentric, factors;
  std::vector<uint8_t> kinds;
  for (const GaussianKind kind : body.kinds) kinds.push_back(static_cast<uint8_t>(kind));
  for (const SkinAnchor& anchor : body.anchors) {
    faces.push_back(anchor.face);
    barycentric.insert(barycentric.end(), anchor.barycentric.begin(), anchor.barycentric.end());
    factors.push_back(anchor.corrective_factor);
  }
  const int32_t size[3] = {avatar.num_joints, avatar.num_vertices, avatar.num_faces};
  (*to)["format"] = NdArray::FromString(kAvatarFormat);
  (*to)["version"] = NdArray::FromDouble(kAvatarVersion);
  (*to)["body_size"] = NdArray::FromInts32(size, {3});
  (*to)["betas"] = NdArray::FromDoubles(avatar.betas.data(), {avatar.betas.size()});
  (*to)["parameters"] = FromTable(body.parameters);
  (*to)["joints"] = NdArray::FromInts32(body.joints.data(), {count, kInfluences});
  (*to)["kinds"] = NdArray::FromUInt8(kinds.data(), {count});
  (*to)["anchor_face"] = NdArray::FromInts32(faces.data(), {count});
  (*to)["anchor_barycentric"] = NdArray::FromFloats(barycentric.data(), {count, 3});
  (*to)["anchor_factor"] = NdArray::FromFloats(factors.data(), {count});
  (*to)["light"] = NdArray::FromFloats(body.light.data(), {GaussianBody::kLightValues});
  if (avatar.garment) PutGarment(*avatar.garment, to);
}

void PutAdam(const AdamState& adam, const std::string& name, NpzArrays* to) {
  (*to)[name + "_first"] = FromTable(adam.first);
  (*to)[name + "_second"] = FromTable(adam.second);
  (*to)[name + "_steps"] = NdArray::FromInts32(adam.steps.data(), {static_cast<int64_t>(adam.steps.size())});
}

AdamState TakeAdam(const AvatarArrays& arrays, const std::string& name, int columns, int64_t rows) {
  AdamState adam;
  adam.first = arrays.Table(name + "_first", columns, rows);
  adam.second = arrays.Table(name + "_second", columns, rows);
  for (int c = 0; c < columns; ++c) {
    for (const float v : adam.second.values(c)) {
      if (v < 0) arrays.Fail(name + "_second", Concatenate(v, ", expected 0 or more"));
    }
  }
  adam.steps = arrays.Ints(name + "_steps", {rows}, 0, 1000000000);
  return adam;
}

void PutPoses(const PoseCorrections& poses, NpzArrays* to) {
  if (poses.values.rows() == 0) return;
  const auto frames = static_cast<int64_t>(poses.square.size());
  (*to)["pose_values"] = FromTable(poses.values);
  (*to)["pose_mean"] = FromTable(poses.mean);
  (*to)["pose_square"] = NdArray::FromFloats(poses.square.data(), {frames});
  (*to)["pose_steps"] = NdArray::FromInts32(poses.steps.data(), {frames});
}

PoseCorrections TakePoses(const AvatarArrays& arrays, const NpzArrays& npz, int num_joints) {
  PoseCorrections poses;
  const auto is_pose = [](const auto& entry) { return entry.first.starts_with("pose_"); };
  const auto first = std::find_if(npz.begin(), npz.end(), is_pose);
  if (first == npz.end()) return poses;
  const NdArray& any = first->second;
  const int64_t frames = any.shape.empty() ? 0 : std::min(any.shape[0], kMaxPoses);
  poses.values = arrays.Table("pose_values", 3 * num_joints + 3, frames);
  poses.mean = arrays.Table("pose_mean", 3 * num_joints + 3, frames);
  poses.square = arrays.Floats("pose_square", {frames});
  if (std::any_of(poses.square.begin(), poses.square.end(), [](float v) { return v < 0; })) {
    arrays.Fail("pose_square", "numbers below 0");
  }
  poses.steps = arrays.Ints("pose_steps", {frames}, 0, 1000000000);
  return poses;
}

void PutHeldOut(const EarlyStopping& curve, NpzArrays* to) {
  if (curve.losses.empty()) return;
  const double landing[2] = {static_cast<double>(curve.cooldown_step), curve.cooldown_progress};
  (*to)["held_out"] = NdArray::FromDoubles(curve.losses.data(), {static_cast<int64_t>(curve.losses.size())});
  (*to)["held_out_landing"] = NdArray::FromDoubles(landing, {2});
}

EarlyStopping TakeHeldOut(const AvatarArrays& arrays, const NpzArrays& npz) {
  EarlyStopping curve;
  if (!npz.contains("held_out") && !npz.contains("held_out_landing")) return curve;
  const NdArray& losses = RequireArray(npz, "held_out", arrays.where());
  curve.losses = arrays.Doubles("held_out", {losses.shape.empty() ? 0 : losses.shape[0]}, 0, kMaxLoss);
  const std::vector<double> landing = arrays.Doubles("held_out_landing", {2}, 0, kMaxSteps);
  if (landing[0] != std::floor(landing[0]) || landing[1] > 1) {
    arrays.Fail("held_out_landing",
                Concatenate(landing[0], ", ", landing[1], ", expected a whole step and a progress up to 1"));
  }
  curve.cooldown_step = static_cast<int64_t>(landing[0]), curve.cooldown_progress = landing[1];
  return curve;
}

constexpr const char* kBest = "best_";

void PutKept(const AvatarFile& avatar, const KeptAvatar& kept, NpzArrays* to) {
  NpzArrays best;
  PutAvatar(avatar, kept.body, &best);
  for (auto& [key, array] : best) (*to)[kBest + key] = std::move(array);
  (*to)["best_step"] = NdArray::FromDouble(static_cast<double>(kept.step));
  (*to)["best_loss"] = NdArray::FromDouble(kept.loss);
}

/// Throws unless the best avatar so far has the same person and garment as the one in training.
void TakeKept(const NpzArrays& npz, const std::string& where, AvatarCheckpoint* to) {
  NpzArrays best;
  for (const auto& [key, array] : npz) {
    if (key.starts_with(kBest)) best[key.substr(std::string(kBest).size())] = array;
  }
  if (best.empty()) return;
  const AvatarArrays arrays(npz, where);
  AvatarFile avatar = AvatarFromArrays(best, where + ": " + kBest);
  const AvatarFile& own = to->avatar;
  if (avatar.num_bones() != own.num_bones() || avatar.num_vertices != own.num_vertices ||
      avatar.num_faces != own.num_faces) {
    arrays.Fail("best_body_size", "another body or garment than the person's beside it");
  }
  KeptAvatar& kept = to->state.kept.emplace();
  kept.body = std::move(avatar.body);
  kept.step = arrays.Step("best_step"), kept.loss = arrays.Number("best_loss");
}

std::optional<AvatarGarment> TakeGarment(const AvatarArrays& arrays, const NpzArrays& npz, int num_vertices) {
  const auto is_garment = [](const auto& entry) { return entry.first.starts_with("garment_"); };
  if (std::none_of(npz.begin(), npz.end(), is_garment)) return std::nullopt;
  AvatarGarment garment;
  const std::vector<double> cut = arrays.Take("garment_cut", DType::kF64, "float64", {5}).ToDoubles();
  // Bounds of any garment; those of the body it is cut for are checked when it is cut.
  const auto within = [&](int k, const char* name, double low, double high) {
    if (!(cut[k] >= low && cut[k] <= high)) {
      arrays.Fail("garment_cut", Concatenate(name, " ", cut[k], ", expected ", low, " to ", high));
    }
    return cut[k];
  };
  garment.cut.waist_y_m = within(0, "waist", -10, 10), garment.cut.length_m = within(1, "length", 0.01, 10);
  garment.cut.fullness = within(2, "fullness", 0, 0.95), garment.cut.spacing_m = within(3, "spacing", 0.005, 1);
  garment.node_spacing_m = within(4, "nodes' spacing", 0.005, 1);
  garment.offsets_m = arrays.Floats("garment_offsets", {num_vertices});
  const NdArray& nodes = RequireArray(npz, "garment_nodes", arrays.where());
  if (nodes.shape.size() != 2 || nodes.shape[0] < 1 || nodes.shape[0] > kMaxNodes) {
    arrays.Fail("garment_nodes",
                Concatenate("an array of ", nodes.ShapeText(), ", expected Kx3, K from 1 to ", kMaxNodes));
  }
  const std::vector<float> places = arrays.Floats("garment_nodes", {nodes.shape[0], 3});
  garment.nodes = Eigen::Map<const MatrixX3f>(places.data(), nodes.shape[0], 3);
  return garment;
}

std::vector<GaussianKind> TakeKinds(const AvatarArrays& arrays, const std::string& key, GaussianKind last,
                                    int64_t count) {
  std::vector<GaussianKind> kinds;
  for (const int64_t kind : arrays.Take(key, DType::kU8, "uint8", {count}).ToInts()) {
    if (kind > static_cast<int64_t>(last)) {
      arrays.Fail(key, Concatenate(kind, ", expected 0 to ", static_cast<int>(last)));
    }
    kinds.push_back(static_cast<GaussianKind>(kind));
  }
  return kinds;
}

}  // namespace

void WriteAvatar(const std::string& path, const AvatarFile& avatar) {
  NpzArrays arrays;
  PutAvatar(avatar, avatar.body, &arrays);
  WriteNpz(path, arrays);
}

void WriteAvatarCheckpoint(const std::string& path, const AvatarCheckpoint& checkpoint) {
  const AvatarTrainingState& state = checkpoint.state;
  NpzArrays arrays;
  PutAvatar(checkpoint.avatar, state.body, &arrays);
  PutAdam(state.adam, "adam", &arrays);
  PutAdam(state.light_adam, "light", &arrays);
  PutPoses(state.poses, &arrays);
  PutHeldOut(state.held_out, &arrays);
  if (state.kept) PutKept(checkpoint.avatar, *state.kept, &arrays);
  arrays["pull"] = NdArray::FromFloats(state.pull.data(), {static_cast<int64_t>(state.pull.size())});
  arrays["step"] = NdArray::FromDouble(static_cast<double>(state.step));
  arrays["seconds"] = NdArray::FromDouble(state.seconds);
  arrays["options"] = NdArray::FromString(checkpoint.options);
  WriteNpz(path, arrays);
}

AvatarFile AvatarFromArrays(const NpzArrays& npz, const std::string& where) {
  const AvatarArrays arrays(npz, where);
  if (const std::string format = arrays.Text("format"); format != kAvatarFormat) {
    arrays.Fail("format", "\"" + PrintableText(format) + "\", expected \"" + kAvatarFormat + "\"");
  }
  const double version = arrays.Number("version");
  if (version != kAvatarVersion && version != kVersionWithoutKinds) {
    arrays.Fail("version", Concatenate(version, ", expected ", kVersionWithoutKinds, " or ", kAvatarVersion));
  }
  AvatarFile avatar;
  const std::vector<int32_t> size = arrays.Ints("body_size", {3}, 1, 100000000);
  avatar.num_joints = size[0], avatar.num_vertices = size[1], avatar.num_faces = size[2];
  avatar.betas = arrays.Betas();
  const int64_t count = arrays.NumRows();
  GaussianBody& body = avatar.body;
  body.parameters = arrays.Table("parameters", kColumns, count);
  avatar.garment = TakeGarment(arrays, npz, avatar.num_vertices);
  body.joints = arrays.Ints("joints", {count, kInfluences}, 0, avatar.num_bones() - 1);
  body.kinds = version == kVersionWithoutKinds ? TakeKinds(arrays, "is_loose", GaussianKind::kLoose, count)
                                               : TakeKinds(arrays, "kinds", GaussianKind::kCloth, count);
  const std::vector<int32_t> faces = arrays.Ints("anchor_face", {count}, 0, avatar.num_faces - 1);
  const std::vector<float> barycentric = arrays.Floats("anchor_barycentric", {count, 3});
  const std::vector<float> factors = arrays.Floats("anchor_factor", {count});
  body.anchors.resize(count);
  for (int64_t i = 0; i < count; ++i) {
    body.anchors[i] = {faces[i], {barycentric[3 * i], barycentric[3 * i + 1], barycentric[3 * i + 2]}, factors[i]};
  }
  const std::vector<float> light = arrays.Floats("light", {GaussianBody::kLightValues});
  std::copy(light.begin(), light.end(), body.light.begin());
  avatar.had_network = npz.contains("motion_network");
  return avatar;
}

AvatarCheckpoint AvatarCheckpointFromArrays(const NpzArrays& npz, const std::string& where) {
  const AvatarArrays arrays(npz, where);
  AvatarCheckpoint checkpoint;
  checkpoint.avatar = AvatarFromArrays(npz, where);
  AvatarTrainingState& state = checkpoint.state;
  std::swap(state.body, checkpoint.avatar.body);
  const int64_t count = state.body.size();
  state.adam = TakeAdam(arrays, "adam", kColumns, count);
  state.light_adam = TakeAdam(arrays, "light", 1, GaussianBody::kLightValues);
  state.poses = TakePoses(arrays, npz, checkpoint.avatar.num_joints);
  state.held_out = TakeHeldOut(arrays, npz);
  TakeKept(npz, where, &checkpoint);
  state.pull = arrays.Floats("pull", {count});
  state.step = arrays.Step("step");
  state.seconds = arrays.Number("seconds");
  checkpoint.options = arrays.Text("options");
  return checkpoint;
}

AvatarFile ReadAvatar(const std::string& path) { return AvatarFromArrays(ReadNpz(path), path); }

AvatarCheckpoint ReadAvatarCheckpoint(const std::string& path) {
  return AvatarCheckpointFromArrays(ReadNpz(path), path);
}

std::string GaussianPlyBytes(const CameraGaussians& gaussians) {
  std::string rows;
  int count = 0;
  for (int i = 0; i < gaussians.size(); ++i) {
    PlyRow row;
    if (!PlyRowOf(gaussians.columns, i, &row)) continue;
    rows.append(reinterpret_cast<const char*>(row.data()), sizeof row);
    ++count;
  }
  std::string header = Concatenate("ply\nformat binary_little_endian 1.0\nelement vertex ", count, "\n");
  for (const char* property : kPlyProperties) header += Concatenate("property float ", property, "\n");
  return header + "end_header\n" + rows;
}

void WriteGaussianPly(const std::string& path, const CameraGaussians& gaussians) {
  WriteFileAtomically(path, GaussianPlyBytes(gaussians));
}

}  // namespace bodyloom
