// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body_making/refined_cage.h"

#include "data_tools/body_making/subdivision.h"

namespace bodyloom {
namespace {

constexpr int kLevels = 2;

/// Vertices stay, face points are the mean of a quad's corners, edge points of an edge's ends.
SparseRows HalvingOf(int num_coarse, const std::vector<Quad>& coarse_quads, const SubdivisionLevel& level) {
  std::vector<Eigen::Triplet<double>> entries;
  int v = 0;
  for (; v < num_coarse; ++v) entries.emplace_back(v, v, 1);
  for (const Quad& quad : coarse_quads) {
    for (const int corner : quad) entries.emplace_back(v, corner, 0.25);
    ++v;
  }
  for (const Edge& edge : level.edges) {
    for (const int end : edge) entries.emplace_back(v, end, 0.5);
    ++v;
  }
  SparseRows halving(v, num_coarse);
  halving.setFromTriplets(entries.begin(), entries.end());
  return halving;
}

}  // namespace

RefinedCage RefineCage(const Cage& cage) {
  RefinedCage refined;
  refined.quads = cage.quads;
  refined.mirror = cage.mirror;
  const auto num_cage = static_cast<Eigen::Index>(cage.mirror.size());
  refined.fine_from_cage.resize(num_cage, num_cage);
  refined.fine_from_cage.setIdentity();
  refined.bilinear_from_cage = refined.fine_from_cage;
  for (int level = 0; level < kLevels; ++level) {
    const int num_coarse = static_cast<int>(refined.mirror.size());
    const SubdivisionLevel finer = SubdivideCatmullClark(num_coarse, refined.quads);
    refined.mirror = MirrorOfSubdivision(refined.mirror, refined.quads, finer);
    refined.bilinear_from_cage = SparseRows(HalvingOf(num_coarse, refined.quads, finer) * refined.bilinear_from_cage);
    refined.quads = finer.quads;
    refined.fine_from_cage = SparseRows(finer.fine_from_coarse * refined.fine_from_cage);
  }
  refined.num_left_quads = kQuadsPerCageQuad * cage.num_left_quads;
  std::vector<bool> is_left(refined.mirror.size(), false);
  for (int q = 0; q < refined.num_left_quads; ++q) {
    for (int v : refined.quads[q]) is_left[v] = true;
  }
  for (size_t v = 0; v < is_left.size(); ++v) {
    if (is_left[v]) refined.left_vertices.push_back(static_cast<int>(v));
  }
  return refined;
}

void FillWeights(const RefinedCage& refined, const std::vector<int>& joint_mirror,
                 const std::vector<WeightedIndices>& left_weights, BodyModelData* body) {
  std::vector<Eigen::Triplet<double>> entries;
  for (size_t i = 0; i < refined.left_vertices.size(); ++i) {
    const int v = refined.left_vertices[i];
    for (const auto& [joint, weight] : left_weights[i]) {
      entries.emplace_back(v, joint, weight);
      if (refined.mirror[v] != v) entries.emplace_back(refined.mirror[v], joint_mirror[joint], weight);
    }
  }
  body->weights.resize(static_cast<Eigen::Index>(refined.mirror.size()),
                       static_cast<Eigen::Index>(joint_mirror.size()));
  body->weights.setFromTriplets(entries.begin(), entries.end());
}

}  // namespace bodyloom
