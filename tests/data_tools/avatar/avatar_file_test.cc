// SPDX-License-Identifier: Apache-2.0
#include "data_tools/avatar/avatar_file.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/image_file.h"
#include "tests/data_tools/formats/expect_file_error.h"
#include "tests/data_tools/formats/temporary_file.h"

namespace bodyloom::avatar_file_test {
namespace {

constexpr int kCount = 70;

AvatarCheckpoint RandomCheckpoint() {
  std::mt19937 generator(5);
  const auto uniform = [&] { return static_cast<float>(generator() / 2147483648.0 - 1); };
  AvatarCheckpoint checkpoint;
  AvatarFile& avatar = checkpoint.avatar;
  avatar.num_joints = 24, avatar.num_vertices = 99, avatar.num_faces = 120;
  avatar.betas = Eigen::VectorXd::LinSpaced(4, -1, 1);
  AvatarGarment& garment = avatar.garment.emplace();
  garment.cut.waist_y_m = 0.1, garment.cut.length_m = 0.55, garment.cut.fullness = 0.4, garment.cut.spacing_m = 0.03;
  garment.offsets_m.resize(99);
  for (float& v : garment.offsets_m) v = 0.01F * uniform();
  garment.node_spacing_m = 0.06;
  garment.nodes = MatrixX3f::Constant(3, 3, 0.25F);
  GaussianBody body;
  body.Resize(kCount);
  for (int i = 0; i < kCount; ++i) {
    for (int c = 0; c < GaussianBody::kNumParameters; ++c) body.parameters(i, c) = uniform();
    for (int k = 0; k < GaussianBody::kInfluences; ++k) {
      body.joints[GaussianBody::kInfluences * i + k] = static_cast<int32_t>(generator() % 27);
    }
    body.anchors[i] = {static_cast<int32_t>(generator() % 120), {0.2F, 0.3F, 0.5F}, uniform()};
    body.kinds[i] = static_cast<GaussianKind>(i % 3);
  }
  for (float& v : body.light) v = uniform();
  checkpoint.state = AvatarTrainingState::Of(body);
  AvatarTrainingState& state = checkpoint.state;
  for (int i = 0; i < kCount; ++i) {
    state.adam.first(i, 3) = uniform();
    state.adam.second(i, 5) = std::abs(uniform());
    state.adam.steps[i] = i;
    state.pull[i] = uniform();
  }
  state.light_adam.second(26, 0) = 0.25F;
  state.light_adam.steps[3] = 9;
  state.poses.Reset(3, avatar.num_joints);
  for (int t = 0; t < 3; ++t) {
    for (int c = 0; c < 75; ++c) state.poses.values(t, c) = uniform(), state.poses.mean(t, c) = uniform();
    state.poses.square[t] = std::abs(uniform());
    state.poses.steps[t] = 5 + t;
  }
  state.held_out.losses = {0.5, 0.25, 0.375};
  state.held_out.cooldown_step = 4000, state.held_out.cooldown_progress = 0.625;
  state.kept = {state.body, 2500, 0.25};
  state.kept->body.parameters(7, 3) = 0.75F;
  state.kept->body.kinds[8] = GaussianKind::kLoose;
  state.step = 123456, state.seconds = 7.25;
  checkpoint.options = "{\"steps\":6000}";
  return checkpoint;
}

bool SameTables(const FloatColumns& a, const FloatColumns& b) {
  if (a.rows() != b.rows() || a.columns() != b.columns()) return false;
  for (int c = 0; c < a.columns(); ++c) {
    if (std::memcmp(a.column(c), b.column(c), sizeof(float) * a.rows()) != 0) return false;
  }
  return true;
}

void ExpectSameBody(const GaussianBody& a, const GaussianBody& b) {
  EXPECT_TRUE(SameTables(a.parameters, b.parameters));
  EXPECT_EQ(a.joints, b.joints);
  EXPECT_EQ(a.kinds, b.kinds);
  EXPECT_EQ(a.light, b.light);
  ASSERT_EQ(a.anchors.size(), b.anchors.size());
  for (size_t i = 0; i < a.anchors.size(); ++i) {
    EXPECT_EQ(a.anchors[i].face, b.anchors[i].face);
    EXPECT_EQ(a.anchors[i].barycentric, b.anchors[i].barycentric);
    EXPECT_EQ(a.anchors[i].corrective_factor, b.anchors[i].corrective_factor);
  }
}

TEST(AvatarFile, ComesBackAsItWas) {
  const TemporaryFolder folder;
  const AvatarCheckpoint checkpoint = RandomCheckpoint();
  WriteAvatarCheckpoint(folder.File("checkpoint.npz"), checkpoint);
  const AvatarCheckpoint back = ReadAvatarCheckpoint(folder.File("checkpoint.npz"));
  ExpectSameBody(back.state.body, checkpoint.state.body);
  EXPECT_TRUE(SameTables(back.state.adam.first, checkpoint.state.adam.first));
  EXPECT_TRUE(SameTables(back.state.adam.second, checkpoint.state.adam.second));
  EXPECT_EQ(back.state.adam.steps, checkpoint.state.adam.steps);
  EXPECT_TRUE(SameTables(back.state.light_adam.second, checkpoint.state.light_adam.second));
  EXPECT_EQ(back.state.light_adam.steps, checkpoint.state.light_adam.steps);
  EXPECT_EQ(back.state.pull, checkpoint.state.pull);
  EXPECT_TRUE(SameTables(back.state.poses.values, checkpoint.state.poses.values));
  EXPECT_TRUE(SameTables(back.state.poses.mean, checkpoint.state.poses.mean));
  EXPECT_EQ(back.state.poses.square, checkpoint.state.poses.square);
  EXPECT_EQ(back.state.poses.steps, checkpoint.state.poses.steps);
  EXPECT_FALSE(back.avatar.had_network);
  EXPECT_EQ(back.state.held_out.losses, checkpoint.state.held_out.losses);
  EXPECT_EQ(back.state.held_out.cooldown_step, 4000);
  EXPECT_EQ(back.state.held_out.cooldown_progress, 0.625);
  ASSERT_TRUE(back.state.kept.has_value());
  ExpectSameBody(back.state.kept->body, checkpoint.state.kept->body);
  EXPECT_EQ(back.state.kept->step, 2500);
  EXPECT_EQ(back.state.kept->loss, 0.25);
  EXPECT_EQ(back.state.step, 123456);
  EXPECT_EQ(back.state.seconds, 7.25);
  EXPECT_EQ(back.options, checkpoint.options);
  AvatarFile avatar = checkpoint.avatar;
  avatar.body = checkpoint.state.body;
  WriteAvatar(folder.File("avatar.npz"), avatar);
  const AvatarFile person = ReadAvatar(folder.File("avatar.npz"));
  ExpectSameBody(person.body, avatar.body);
  EXPECT_EQ(person.betas, avatar.betas);
  EXPECT_EQ(person.num_vertices, 99);
  ASSERT_TRUE(person.garment.has_value());
  EXPECT_EQ(person.garment->cut.waist_y_m, 0.1);
  EXPECT_EQ(person.garment->cut.length_m, 0.55);
  EXPECT_EQ(person.garment->cut.fullness, 0.4);
  EXPECT_EQ(person.garment->cut.spacing_m, 0.03);
  EXPECT_EQ(person.garment->node_spacing_m, 0.06);
  EXPECT_EQ(person.garment->offsets_m, avatar.garment->offsets_m);
  EXPECT_EQ(person.garment->nodes, avatar.garment->nodes);
  EXPECT_EQ(person.num_bones(), 27);
  // A checkpoint is a person too; a person is no checkpoint.
  ExpectSameBody(ReadAvatar(folder.File("checkpoint.npz")).body, avatar.body);
  FileErrorOf("avatar.npz", [&] { ReadAvatarCheckpoint(folder.File("avatar.npz")); });
}

TEST(AvatarFile, ReadsVersionOne) {
  const TemporaryFolder folder;
  AvatarFile avatar = RandomCheckpoint().avatar;
  avatar.garment.reset();
  avatar.body.Resize(2);
  avatar.body.kinds[1] = GaussianKind::kLoose;
  WriteAvatar(folder.File("new.npz"), avatar);
  NpzArrays arrays = ReadNpz(folder.File("new.npz"));
  arrays["version"] = NdArray::FromDouble(1);
  arrays["is_loose"] = arrays.at("kinds");
  arrays.erase("kinds");
  ExpectSameBody(AvatarFromArrays(arrays, "old.npz").body, avatar.body);
  arrays["is_loose"].bytes[1] = 2;
  const std::string said = FileErrorOf("old.npz", [&] { AvatarFromArrays(arrays, "old.npz"); });
  EXPECT_NE(said.find("is_loose"), std::string::npos) << said;
}

TEST(AvatarFile, LeavesOutANetworkOfTheMotion) {
  const TemporaryFolder folder;
  const AvatarCheckpoint checkpoint = RandomCheckpoint();
  WriteAvatarCheckpoint(folder.File("new.npz"), checkpoint);
  NpzArrays arrays = ReadNpz(folder.File("new.npz"));
  const int32_t sizes[4] = {64, 42, 16, 32};
  for (const char* of : {"", "best_"}) {
    arrays[of + std::string("motion_network")] = NdArray::FromInts32(sizes, {4});
    arrays[of + std::string("motion_parameters")] = NdArray::FromFloats(std::vector<float>(9).data(), {9});
    arrays[of + std::string("motion_fps")] = NdArray::FromDouble(30);
  }
  const AvatarCheckpoint old = AvatarCheckpointFromArrays(arrays, "old.npz");
  EXPECT_TRUE(old.avatar.had_network);
  ExpectSameBody(old.state.body, checkpoint.state.body);
  ExpectSameBody(old.state.kept->body, checkpoint.state.kept->body);
}

TEST(AvatarFile, RefusesWhatIsWrongNamingIt) {
  const TemporaryFolder folder;
  WriteAvatarCheckpoint(folder.File("good.npz"), RandomCheckpoint());
  const NpzArrays good = ReadNpz(folder.File("good.npz"));
  int refused = 0;
  const auto expect = [&](const std::string& key, const std::string& message, const auto& spoil) {
    NpzArrays bad = good;
    spoil(&bad[key]);
    const std::string said = FileErrorOf("bad.npz", [&] { AvatarCheckpointFromArrays(bad, "bad.npz"); });
    EXPECT_NE(said.find(key), std::string::npos) << said;
    EXPECT_NE(said.find(message), std::string::npos) << said;
    ++refused;
  };
  const auto set_float = [](float value) {
    return [value](NdArray* array) { std::memcpy(array->bytes.data() + 8, &value, sizeof value); };
  };
  const auto set_int = [](int32_t value) {
    return [value](NdArray* array) { std::memcpy(array->bytes.data() + 8, &value, sizeof value); };
  };
  expect("format", "expected", [](NdArray* a) { *a = NdArray::FromString("something else"); });
  expect("version", "3, expected 1 or 2", [](NdArray* a) { *a = NdArray::FromDouble(3); });
  expect("parameters", "Nx23", [](NdArray* a) { a->shape = {23, kCount}; });
  expect("parameters", "finite", set_float(std::numeric_limits<float>::quiet_NaN()));
  expect("parameters", "float32", [](NdArray* a) {
    const std::vector<double> values(23 * kCount, 0.0);
    *a = NdArray::FromDoubles(values.data(), {kCount, 23});
  });
  expect("joints", "27, expected 0 to 26", set_int(27));
  expect("joints", "-1, expected 0 to 26", set_int(-1));
  expect("anchor_face", "120, expected 0 to 119", set_int(120));
  expect("anchor_barycentric", "finite", set_float(std::numeric_limits<float>::infinity()));
  expect("kinds", "3, expected 0 to 2", [](NdArray* a) { a->bytes[0] = 3; });
  const auto set_double = [](int at, double value) {
    return [at, value](NdArray* array) { std::memcpy(array->bytes.data() + 8 * at, &value, sizeof value); };
  };
  expect("garment_cut", "expected 5", [](NdArray* a) { a->shape = {1, 5}; });
  expect("garment_cut", "waist", set_double(0, std::numeric_limits<double>::quiet_NaN()));
  expect("garment_cut", "length 0, expected 0.01 to 10", set_double(1, 0));
  expect("garment_cut", "fullness 1, expected 0 to 0.95", set_double(2, 1));
  expect("garment_cut", "spacing 1e-09, expected 0.005 to 1", set_double(3, 1e-9));
  expect("garment_cut", "nodes' spacing 2, expected 0.005 to 1", set_double(4, 2));
  expect("garment_offsets", "expected 99", [](NdArray* a) { a->shape = {33, 3}; });
  expect("garment_offsets", "finite", set_float(std::numeric_limits<float>::infinity()));
  expect("garment_nodes", "expected Kx3", [](NdArray* a) { a->shape = {9}; });
  expect("garment_nodes", "expected 1x3", [](NdArray* a) { a->shape = {1, 9}; });
  expect("garment_nodes", "finite", set_float(std::numeric_limits<float>::quiet_NaN()));
  expect("held_out", "-1, expected 0 to 1e+09", set_double(1, -1));
  expect("held_out", "expected 0 to", set_double(2, std::numeric_limits<double>::quiet_NaN()));
  expect("held_out", "float64", [](NdArray* a) { a->shape = {}; });
  expect("held_out_landing", "a whole step", set_double(0, 2.5));
  expect("held_out_landing", "a progress up to 1", set_double(1, 1.5));
  expect("held_out_landing", "expected 2", [](NdArray* a) { a->shape = {2, 1}; });
  expect("best_step", "whole number", [](NdArray* a) { *a = NdArray::FromDouble(1.5); });
  expect("best_body_size", "another body", set_int(119));
  expect("pose_values", "expected 3x75", [](NdArray* a) { a->shape = {3, 25, 3}; });
  expect("pose_values", "expected 3x75", [](NdArray* a) { a->shape = {75, 3}; });
  expect("pose_square", "below 0", set_float(-1));
  expect("pose_steps", "-1, expected 0", set_int(-1));
  expect("light", "expected 27", [](NdArray* a) { a->shape = {3, 9}; });
  expect("betas", "finite", [](NdArray* a) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    *a = NdArray::FromDoubles(&nan, {1});
  });
  expect("adam_second", "0 or more", set_float(-1));
  expect("adam_steps", "-5", set_int(-5));
  expect("light_first", "expected 27x1", [](NdArray* a) { a->shape = {27}; });
  expect("pull", "expected 70", [](NdArray* a) { a->shape = {35, 2}; });
  expect("step", "whole number", [](NdArray* a) { *a = NdArray::FromDouble(1.5); });
  expect("seconds", "0 or more", [](NdArray* a) { *a = NdArray::FromDouble(-1); });
  expect("body_size", "expected 1", set_int(0));
  for (const auto& [key, array] : good) {
    NpzArrays without = good;
    without.erase(key);
    const std::string said = FileErrorOf("bad.npz", [&] { AvatarCheckpointFromArrays(without, "bad.npz"); });
    const bool of_best = key.starts_with("best_") && key != "best_step" && key != "best_loss";
    EXPECT_NE(said.find(of_best ? "best_: no array '" + key.substr(5) + "'" : key), std::string::npos) << said;
    ++refused;
  }
  EXPECT_GE(refused, 80);
  const std::string bytes = ReadFileBytes(folder.File("good.npz"));
  WriteFileAtomically(folder.File("cut.npz"), bytes.substr(0, bytes.size() / 2));
  FileErrorOf("cut.npz", [&] { ReadAvatarCheckpoint(folder.File("cut.npz")); });
}

TEST(AvatarFile, WritesNoPersonThatDoesNotHoldTogether) {
  const TemporaryFolder folder;
  AvatarCheckpoint checkpoint = RandomCheckpoint();
  checkpoint.avatar.num_joints = 3;
  EXPECT_THROW(WriteAvatarCheckpoint(folder.File("bad.npz"), checkpoint), std::invalid_argument);
}

TEST(GaussianPly, IsTheLayoutOfTheViewers) {
  CameraGaussians gaussians;
  gaussians.Resize(3);
  gaussians.columns.Fill(0);
  // Standard deviations 3, 2, 1 cm along y, z, x, in order of the matrix' columns turned by 120°.
  const float factor[9] = {0, 0, 0.01F, 0.03F, 0, 0, 0, 0.02F, 0};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 9; ++k) gaussians.columns(i, CameraGaussians::kFactor + k) = factor[k];
    gaussians.columns(i, CameraGaussians::kX) = 1.5F;
    gaussians.columns(i, CameraGaussians::kOpacity) = 0.75F;
    gaussians.columns(i, CameraGaussians::kRed) = 0.9F;
  }
  gaussians.columns(1, CameraGaussians::kY) = std::numeric_limits<float>::quiet_NaN();
  gaussians.columns(2, CameraGaussians::kOpacity) = 1;
  const std::string bytes = GaussianPlyBytes(gaussians);
  EXPECT_EQ(bytes.rfind("ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\n", 0), 0U);
  const size_t begin = bytes.find("end_header\n") + 11;
  ASSERT_EQ(bytes.size(), begin + 2 * 17 * sizeof(float));
  float row[17];
  std::memcpy(row, bytes.data() + begin, sizeof row);
  EXPECT_EQ(row[0], 1.5F);
  EXPECT_NEAR(row[6], (0.9 - 0.5) / 0.28209479, 1e-5);
  EXPECT_NEAR(row[9], std::log(3.0), 1e-5);
  EXPECT_NEAR(row[10], std::log(0.03), 1e-4);
  EXPECT_NEAR(row[11], std::log(0.02), 1e-4);
  EXPECT_NEAR(row[12], std::log(0.01), 1e-4);
  // The covariance again, R diag(s²) Rᵀ.
  const Eigen::Quaternionf turn(row[13], row[14], row[15], row[16]);
  EXPECT_NEAR(turn.norm(), 1, 1e-5);
  const Eigen::Matrix3f r = turn.toRotationMatrix();
  const Eigen::Vector3f s(std::exp(row[10]), std::exp(row[11]), std::exp(row[12]));
  const Eigen::Matrix3f covariance = r * s.cwiseAbs2().asDiagonal() * r.transpose();
  EXPECT_NEAR(covariance(0, 0), 1e-4, 1e-8);
  EXPECT_NEAR(covariance(1, 1), 9e-4, 1e-8);
  EXPECT_NEAR(covariance(2, 2), 4e-4, 1e-8);
  EXPECT_NEAR(covariance(0, 1), 0, 1e-8);
  std::memcpy(row, bytes.data() + begin + sizeof row, sizeof row);
  EXPECT_NEAR(row[9], std::log(1e6), 0.01) << "an opacity of 1 has no logit";
}

TEST(AlphaPng, KeepsColoursAndAlpha) {
  const TemporaryFolder folder;
  const std::vector<uint8_t> bgra = {1, 2, 3, 4, 250, 251, 252, 253};
  WriteAlphaPng(folder.File("a.png"), 2, 1, bgra);
  const cv::Mat back = cv::imread(folder.File("a.png"), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(back.type(), CV_8UC4);
  EXPECT_EQ(std::memcmp(back.data, bgra.data(), bgra.size()), 0);
  EXPECT_THROW(WriteAlphaPng(folder.File("a.png"), 3, 1, bgra), std::invalid_argument);
}

}  // namespace
}  // namespace bodyloom::avatar_file_test
