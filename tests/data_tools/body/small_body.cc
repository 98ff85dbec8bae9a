// SPDX-License-Identifier: Apache-2.0
#include "tests/data_tools/body/small_body.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "geometry/body/body_model.h"
#include "tests/data_tools/formats/pickle_writer.h"

namespace bodyloom {
namespace {

/// Uniform in [-scale, scale], the same on every platform (std::uniform_real_distribution is not).
class Noise {
 public:
  double operator()(double scale) { return scale * (2.0 * static_cast<double>(engine_()) / 4294967295.0 - 1.0); }

 private:
  std::mt19937 engine_{7};
};

}  // namespace

BodyArrays MakeBodyArrays(int V, int J, int B, bool with_posedirs) {
  constexpr int kAround = 10;
  Noise noise;
  BodyArrays body;
  body.V = V;
  body.J = J;
  body.B = B;
  const int rows = V / kAround;
  for (int v = 0; v < V; ++v) {
    const int row = v / kAround;
    const double angle = 2 * M_PI * (v % kAround) / kAround, height = 1.7 * row / std::max(rows, 1) - 0.9;
    for (const double x : {0.2 * std::cos(angle), height, 0.15 * std::sin(angle)}) {
      body.v_template.push_back(x + noise(0.003));
    }
  }
  for (int v = 0; v + kAround < V; ++v) {
    const int next = v % kAround == kAround - 1 ? v - kAround + 1 : v + 1;
    for (const int i : {v, next, next + kAround}) body.f.push_back(std::min(i, V - 1));
    for (const int i : {v, next + kAround, v + kAround}) body.f.push_back(std::min(i, V - 1));
  }
  for (int j = 0; j < J; ++j) {
    body.parents.push_back(j == 0 ? 4294967295 : j < 24 ? SmplParents()[j] : j % 3 == 1 ? 20 : j - 1);
  }
  body.weights.assign(static_cast<size_t>(V) * J, 0.0);
  body.J_regressor.assign(static_cast<size_t>(V) * J, 0.0);
  for (int v = 0; v < V; ++v) {
    const double share = 0.5 + noise(0.5);
    const auto joint = static_cast<size_t>(static_cast<int64_t>(v) * J / V);
    body.weights[static_cast<size_t>(v) * J + joint] += share;
    body.weights[static_cast<size_t>(v) * J + (joint + 1) % J] += 1 - share;
  }
  for (int j = 0; j < J; ++j) {
    const int first = static_cast<int>(static_cast<int64_t>(j) * V / J);
    for (int k = 0; k < 8; ++k) body.J_regressor[static_cast<size_t>(j) * V + (first + k) % V] += 0.125;
  }
  for (int i = 0; i < 3 * V * B; ++i) body.shapedirs.push_back(noise(0.02));
  if (with_posedirs) {
    for (int64_t i = 0; i < int64_t{27} * V * (J - 1); ++i) body.posedirs.push_back(noise(0.01));
  }
  if (J > 24) {
    for (auto& mean : body.hands_mean) {
      for (int i = 0; i < 45; ++i) mean.push_back(noise(0.3));
    }
  }
  return body;
}

std::string OfficialPickle(const BodyArrays& body) {
  using namespace pickle_writer;  // NOLINT(google-build-using-namespace)
  const int V = body.V, J = body.J, B = body.B, F = static_cast<int>(body.f.size() / 3);
  const auto text = [](const std::string& name) { return Str2(name); };
  Items items;
  std::vector<double> data;
  std::vector<int32_t> indices, indptr = {0};
  for (int v = 0; v < V; ++v) {
    for (int j = 0; j < J; ++j) {
      const double x = body.J_regressor[static_cast<size_t>(j) * V + v];
      if (x == 0) continue;
      data.push_back(x);
      indices.push_back(j);
    }
    indptr.push_back(static_cast<int32_t>(indices.size()));
  }
  const auto count = [](const auto& values) { return static_cast<int>(values.size()); };
  items.emplace_back(text("J_regressor"),
                     Object2("scipy.sparse.csc", "csc_matrix",
                             {{text("_shape"), Shape({J, V})},
                              {text("maxprint"), Int(50)},
                              {text("data"), Doubles2(data, {count(data)})},
                              {text("indices"), Array2("i4", '<', {count(indices)}, false, RawOf(indices))},
                              {text("indptr"), Array2("i4", '<', {count(indptr)}, false, RawOf(indptr))}}));
  items.emplace_back(text("v_template"), Doubles2(body.v_template, {V, 3}));
  std::vector<uint32_t> faces(body.f.begin(), body.f.end());
  items.emplace_back(text("f"), Array2("u4", '<', {F, 3}, false, RawOf(faces)));
  items.emplace_back(text("weights"), Doubles2(body.weights, {V, J}));
  std::vector<uint32_t> tree;
  for (const int64_t parent : body.parents) tree.push_back(static_cast<uint32_t>(parent));
  for (int j = 0; j < J; ++j) tree.push_back(static_cast<uint32_t>(j));
  items.emplace_back(text("kintree_table"), Array2("u4", '<', {2, J}, false, RawOf(tree)));
  // shapedirs is the first B columns of a wider array, as a chumpy slice keeps it.
  std::vector<double> wide;
  std::vector<int64_t> kept;
  for (int r = 0; r < 3 * V; ++r) {
    for (int b = 0; b < B; ++b) {
      kept.push_back(static_cast<int64_t>(wide.size()));
      wide.push_back(body.shapedirs[static_cast<size_t>(r) * B + b]);
    }
    wide.push_back(1e9);
  }
  const std::string ch = Object2("chumpy.ch", "Ch", {{text("_itr"), "N"}, {text("x"), Doubles2(wide, {V, 3, B + 1})}});
  items.emplace_back(text("shapedirs"), Object2("chumpy.reordering", "Select",
                                                {{text("a"), ch},
                                                 {text("idxs"), Array2("i8", '<', {count(kept)}, false, RawOf(kept))},
                                                 {text("preferred_shape"), Shape({V, 3, B})}}));
  if (!body.posedirs.empty()) {
    items.emplace_back(text("posedirs"),
                       Object2("chumpy.ch", "Ch", {{text("x"), Doubles2(body.posedirs, {V, 3, 9 * (J - 1)})}}));
  }
  items.emplace_back(text("bs_style"), Str2("lbs"));
  items.emplace_back(text("pose_training_info"), Dict({{text("gender"), Str2("neutral")}}));
  return Pickle(2, Dict(items));
}

NpzArrays OfficialNpz(const BodyArrays& body) {
  NpzArrays arrays;
  const int64_t V = body.V, J = body.J;
  arrays["v_template"] = NdArray::FromDoubles(body.v_template.data(), {V, 3});
  arrays["f"] = NdArray::FromInts32(body.f.data(), {static_cast<int64_t>(body.f.size() / 3), 3});
  arrays["weights"] = NdArray::FromDoubles(body.weights.data(), {V, J});
  arrays["J_regressor"] = NdArray::FromDoubles(body.J_regressor.data(), {J, V});
  arrays["shapedirs"] = NdArray::FromDoubles(body.shapedirs.data(), {V, 3, body.B});
  if (!body.posedirs.empty()) arrays["posedirs"] = NdArray::FromDoubles(body.posedirs.data(), {V, 3, 9 * (J - 1)});
  std::vector<int64_t> tree = body.parents;
  for (int64_t j = 0; j < J; ++j) tree.push_back(j);
  NdArray kintree;
  kintree.dtype = DType::kI64;
  kintree.shape = {2, J};
  kintree.bytes.assign(reinterpret_cast<const char*>(tree.data()), tree.size() * sizeof(int64_t));
  arrays["kintree_table"] = kintree;
  if (!body.hands_mean[0].empty()) {
    arrays["hands_meanl"] = NdArray::FromDoubles(body.hands_mean[0].data(), {45});
    arrays["hands_meanr"] = NdArray::FromDoubles(body.hands_mean[1].data(), {45});
  }
  return arrays;
}

}  // namespace bodyloom
