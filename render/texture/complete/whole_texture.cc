// SPDX-License-Identifier: Apache-2.0
#include "render/texture/complete/whole_texture.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/percentile.h"
#include "geometry/uv_maps/uv_charts.h"
#include "render/image/palette.h"
#include "render/texture/complete/texel_counterparts.h"
#include "render/texture/complete/uv_fill.h"
#include "render/texture/uv_sample.h"

namespace bodyloom {
namespace {

constexpr std::array<float, kNumCounterparts> kPreference = {1.0F, 0.7F, 0.5F};
constexpr std::array<TexelSource, kNumCounterparts> kSourceOf = {TexelSource::kMirror, TexelSource::kBehind,
                                                                 TexelSource::kMirroredBack};
constexpr double kMinSkinShare = 0.1;  ///< of the hands' seen texels
constexpr double kMinTapWeight = 1e-3;
constexpr double kNoiseOfLines = 0.08;  ///< of colours, largest channel
constexpr double kHairIsKept = 16;      ///< factor of the screening: skin must not bleed into hair
constexpr double kAroundIsKept = 0.25;  ///< likewise: lines extended around a limb should blend
constexpr double kTolerance = 1e-3;
constexpr int kMaxIterations = 100;
constexpr double kMinWeight = 0.5;     ///< minimum weight of a lookup's seen taps
constexpr double kMinHairShare = 0.1;  ///< of the scalp's seen texels

/// Maximum difference over the channels.
double Contrast(const ChannelTriple& a, const ChannelTriple& b) {
  double contrast = 0;
  for (size_t c = 0; c < 3; ++c) contrast = std::max<double>(contrast, std::abs(a[c] - b[c]));
  return contrast;
}

bool IsOfHead(BodyRegion region) { return region == BodyRegion::kFace || region == BodyRegion::kScalp; }

class Completion {
 public:
  Completion(const BodyModel& body, const UvTexelTable& table, std::span<const BodyRegion> regions, const Texture& seen,
             const WholeTextureOptions& options)
      : body_(body),
        table_(table),
        regions_(regions),
        seen_(seen),
        options_(options),
        charts_(FindUvCharts(body)),
        fill_(body, table),
        pixels_(seen.confidence.size()) {
    result_.bgr.assign(3 * pixels_, 0.0F);
    result_.sources.assign(pixels_, TexelSource::kEmpty);
  }

  WholeTexture Run(const MatrixX3d& rest_vertices) {
    if (!TakeSeen()) throw std::runtime_error("no texel of the body was seen");
    DistrustHands();
    DistrustUnderGarment();
    const RestViews views(rest_vertices, body_.data().faces);
    const MatrixX3d points = TexelPoints(rest_vertices, body_.data().faces, table_);
    const TexelCounterparts counterparts = FindTexelCounterparts(views, points);
    ChooseGuesses(counterparts);
    GuessHair();
    GuessUnderGarment();
    LookAroundLimbs(views, points);
    Spread();
    Join();
    FillGutter(body_, table_, std::vector<uint8_t>(pixels_, 1), 3, result_.bgr);
    return std::move(result_);
  }

 private:
  [[nodiscard]] BodyRegion RegionOf(const SurfacePoint& point) const {
    int corner = 0;
    point.barycentric.maxCoeff(&corner);
    return regions_[body_.data().faces(point.face, corner)];
  }
  [[nodiscard]] BodyRegion RegionOf(size_t i) const {
    return RegionOf({table_.face[i], table_.barycentric[i].cast<double>()});
  }
  [[nodiscard]] bool IsSeen(size_t pixel) const { return result_.sources[pixel] == TexelSource::kSeen; }
  [[nodiscard]] ChannelTriple ColourAt(size_t pixel) const {
    return {result_.bgr[pixel], result_.bgr[pixels_ + pixel], result_.bgr[2 * pixels_ + pixel]};
  }
  void Set(size_t pixel, const ChannelTriple& colour, TexelSource source) {
    for (int c = 0; c < 3; ++c) result_.bgr[c * pixels_ + pixel] = colour[c];
    result_.sources[pixel] = source;
  }
  template <typename Visit>
  void ForEachTexel(const Visit& visit) const {
    for (size_t i = 0; i < table_.size(); ++i) {
      if (!table_.in_gutter[i]) visit(i, static_cast<size_t>(table_.pixel[i]));
    }
  }

  bool TakeSeen() {
    std::vector<double> confidence;
    ForEachTexel([&](size_t, size_t pixel) {
      if (seen_.confidence[pixel] > 0) confidence.push_back(seen_.confidence[pixel]);
    });
    if (confidence.empty()) return false;
    const double minimum = options_.trust * Percentile(confidence, 90);
    ForEachTexel([&](size_t, size_t pixel) {
      if (!(seen_.confidence[pixel] > 0) || seen_.confidence[pixel] < minimum) return;
      Set(pixel, {seen_.bgr[pixel], seen_.bgr[pixels_ + pixel], seen_.bgr[2 * pixels_ + pixel]}, TexelSource::kSeen);
    });
    return true;
  }

  /// The face's colour if enough of the hands is similar (no gloves), else the hands' own.
  [[nodiscard]] ChannelTriple HandColour(const std::vector<ChannelTriple>& hands) const {
    std::vector<ChannelTriple> face;
    ForEachTexel([&](size_t i, size_t pixel) {
      if (IsSeen(pixel) && RegionOf(i) == BodyRegion::kFace) face.push_back(ColourAt(pixel));
    });
    if (!face.empty()) {
      const ChannelTriple skin = MedianColour(face);
      const auto like_skin = std::count_if(hands.begin(), hands.end(), [&](const ChannelTriple& colour) {
        return Contrast(colour, skin) <= options_.hand_contrast;
      });
      if (static_cast<double>(like_skin) >= kMinSkinShare * static_cast<double>(hands.size())) return skin;
    }
    return MedianColour(hands);
  }

  /// Discards seen texels of the hands with other colours.
  void DistrustHands() {
    std::vector<ChannelTriple> colours;
    std::vector<size_t> texels;
    ForEachTexel([&](size_t i, size_t pixel) {
      if (!IsSeen(pixel) || RegionOf(i) != BodyRegion::kHand) return;
      colours.push_back(ColourAt(pixel));
      texels.push_back(pixel);
    });
    if (colours.empty()) return;
    const ChannelTriple hand = HandColour(colours);
    for (size_t k = 0; k < texels.size(); ++k) {
      if (Contrast(colours[k], hand) > options_.hand_contrast) {
        result_.sources[texels[k]] = TexelSource::kEmpty;
      }
    }
  }

  /// Discards texels under a garment: they seem visible only where the simulated hem is off, and mostly show the hem.
  void DistrustUnderGarment() {
    ForEachTexel([&](size_t i, size_t pixel) {
      if (IsSeen(pixel) && RegionOf(i) == BodyRegion::kUnderGarment) result_.sources[pixel] = TexelSource::kEmpty;
    });
  }

  /// True if both are of the loose garment or both of the body.
  [[nodiscard]] bool MayLend(const SurfacePoint& from, size_t to) const {
    return (RegionOf(from) == BodyRegion::kGarment) == (RegionOf(to) == BodyRegion::kGarment);
  }

  /// Calls visit(pixel, weight) for the texels of a bilinear lookup.
  template <typename Visit>
  void ForEachTap(const SurfacePoint& point, const Visit& visit) const {
    const UvTaps taps = TapsAt(table_, UvPointAt(body_, charts_, point.face, point.barycentric));
    for (int k = 0; k < taps.count; ++k) visit(static_cast<size_t>(taps.pixel[k]), taps.weight[k]);
  }

  struct Lookup {
    ChannelTriple colour{};
    float confidence = 0;  ///< 0: not seen there
  };
  /// The seen colour at a counterpart of texel i.
  [[nodiscard]] Lookup LookUp(size_t i, const SurfacePoint& counterpart, TexelCounterpart kind) const {
    Lookup found;
    if (counterpart.face < 0 || !MayLend(counterpart, i)) return found;
    if (kind != kMirror && (IsOfHead(RegionOf(counterpart)) || IsOfHead(RegionOf(i)))) {
      return found;
    }
    double weight = 0, confidence = 0;
    std::array<double, 3> colour{};
    ForEachTap(counterpart, [&](size_t pixel, double share) {
      if (!IsSeen(pixel)) return;
      weight += share;
      confidence += share * seen_.confidence[pixel];
      for (size_t c = 0; c < 3; ++c) colour[c] += share * result_.bgr[c * pixels_ + pixel];
    });
    if (!(weight >= kMinWeight)) return found;
    for (size_t c = 0; c < 3; ++c) found.colour[c] = static_cast<float>(colour[c] / weight);
    found.confidence = static_cast<float>(confidence / weight);
    return found;
  }

  void ChooseGuesses(const TexelCounterparts& counterparts) {
    ForEachTexel([&](size_t i, size_t pixel) {
      if (IsSeen(pixel)) return;
      float best = 0;
      for (int kind = 0; kind < kNumCounterparts; ++kind) {
        const Lookup found = LookUp(i, counterparts[kind][i], static_cast<TexelCounterpart>(kind));
        if (!(kPreference[kind] * found.confidence > best)) continue;
        best = kPreference[kind] * found.confidence;
        Set(pixel, found.colour, kSourceOf[kind]);
      }
    });
  }

  void GuessHair() {
    std::vector<ChannelTriple> face, scalp;
    ForEachTexel([&](size_t i, size_t pixel) {
      if (!IsSeen(pixel)) return;
      const BodyRegion region = RegionOf(i);
      const ChannelTriple colour = ColourAt(pixel);
      if (region == BodyRegion::kFace) face.push_back(colour);
      if (region == BodyRegion::kScalp) scalp.push_back(colour);
    });
    if (scalp.empty()) return;
    std::vector<ChannelTriple> hair;
    if (!face.empty()) {
      const ChannelTriple skin = MedianColour(face);
      std::copy_if(scalp.begin(), scalp.end(), std::back_inserter(hair),
                   [&](const ChannelTriple& colour) { return Contrast(colour, skin) > options_.hair_contrast; });
    }
    if (static_cast<double>(hair.size()) < kMinHairShare * static_cast<double>(scalp.size())) hair = scalp;
    const ChannelTriple colour = MedianColour(hair);
    ForEachTexel([&](size_t i, size_t pixel) {
      if (result_.sources[pixel] != TexelSource::kEmpty || RegionOf(i) != BodyRegion::kScalp) return;
      Set(pixel, colour, TexelSource::kHair);
    });
  }

  /// Guesses the colour of the shins: skin, tights or trousers.
  void GuessUnderGarment() {
    std::vector<ChannelTriple> below;
    ForEachTexel([&](size_t i, size_t pixel) {
      if (IsSeen(pixel) && RegionOf(i) == BodyRegion::kBelowGarment) below.push_back(ColourAt(pixel));
    });
    if (below.empty()) return;
    const ChannelTriple colour = MedianColour(below);
    ForEachTexel([&](size_t i, size_t pixel) {
      if (RegionOf(i) == BodyRegion::kUnderGarment) Set(pixel, colour, TexelSource::kLimbNeighbour);
    });
  }

  /// True if the texels around a point have a seen or guessed colour.
  [[nodiscard]] bool IsColoured(const SurfacePoint& point) const {
    if (IsOfHead(RegionOf(point))) return false;
    bool any = false;
    ForEachTap(point, [&](size_t pixel, double) { any = any || result_.sources[pixel] != TexelSource::kEmpty; });
    return any;
  }

  void LookAroundLimbs(const RestViews& views, const MatrixX3d& points) {
    const NearestAroundLimb nearest(body_, views, [this](const SurfacePoint& point) { return IsColoured(point); });
    std::vector<std::pair<size_t, ChannelTriple>> guesses;
    ForEachTexel([&](size_t i, size_t pixel) {
      if (result_.sources[pixel] != TexelSource::kEmpty || IsOfHead(RegionOf(i))) return;
      const SurfacePoint found = nearest.At(points.row(static_cast<Eigen::Index>(i)).transpose());
      if (found.face < 0 || !MayLend(found, i)) return;
      double weight = 0;
      ChannelTriple colour{};
      ForEachTap(found, [&](size_t tap, double share) {
        if (result_.sources[tap] == TexelSource::kEmpty) return;
        weight += share;
        for (size_t c = 0; c < 3; ++c) colour[c] += static_cast<float>(share) * result_.bgr[c * pixels_ + tap];
      });
      if (!(weight > kMinTapWeight)) return;
      for (float& value : colour) value /= static_cast<float>(weight);
      guesses.emplace_back(pixel, colour);
    });
    for (const auto& [pixel, colour] : guesses) Set(pixel, colour, TexelSource::kLimbNeighbour);
  }

  void Spread() {
    std::vector<uint8_t> known(pixels_, 0);
    ForEachTexel([&](size_t, size_t pixel) { known[pixel] = result_.sources[pixel] != TexelSource::kEmpty ? 1 : 0; });
    fill_.Fill(known, 3, result_.bgr);
    ForEachTexel([&](size_t, size_t pixel) {
      if (known[pixel] == 0) result_.sources[pixel] = TexelSource::kSmoothFill;
    });
  }

  /// An edge of the graph from a node that was not seen.
  struct Link {
    bool joins = true;      ///< false: boundary between materials
    bool is_alike = false;  ///< both guessed in the same way
  };

  [[nodiscard]] Link LinkOf(size_t pixel, size_t other) const {
    const TexelSource a = result_.sources[pixel], b = result_.sources[other];
    if (a == TexelSource::kSmoothFill || b == TexelSource::kSmoothFill) return {};
    if (a == b && a != TexelSource::kLimbNeighbour) return {true, true};
    // Lines extended around a limb are joined if they differ by image noise only, not across a hem.
    if (a == b) return {Contrast(ColourAt(pixel), ColourAt(other)) <= kNoiseOfLines, false};
    return {Contrast(ColourAt(pixel), ColourAt(other)) <= options_.largest_step, false};
  }

  void Join() {
    const UvGraph graph = BuildUvGraph(body_, table_);
    const double screening = 1 / std::pow(options_.reach * table_.width, 2);
    std::vector<int> unknown_of(graph.num_nodes(), -1), node_of;
    for (int n = 0; n < graph.num_nodes(); ++n) {
      if (IsSeen(graph.pixel[n])) continue;
      unknown_of[n] = static_cast<int>(node_of.size());
      node_of.push_back(n);
    }
    if (node_of.empty()) return;
    const auto count = static_cast<int>(node_of.size());
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count, 3), start(count, 3);
    for (int u = 0; u < count; ++u) {
      const int n = node_of[u];
      const auto pixel = static_cast<size_t>(graph.pixel[n]);
      const bool guessed = result_.sources[pixel] != TexelSource::kSmoothFill;
      double diagonal = guessed ? screening : 0;
      if (result_.sources[pixel] == TexelSource::kHair) diagonal *= kHairIsKept;
      if (result_.sources[pixel] == TexelSource::kLimbNeighbour) diagonal *= kAroundIsKept;
      for (int c = 0; c < 3; ++c) {
        start(u, c) = result_.bgr[c * pixels_ + pixel];
        right(u, c) += diagonal * start(u, c);
      }
      for (int k = graph.begin[n]; k < graph.begin[n + 1]; ++k) {
        const auto other_pixel = static_cast<size_t>(graph.pixel[graph.neighbour[k]]);
        const Link link = LinkOf(pixel, other_pixel);
        if (!link.joins) continue;
        diagonal += 1;
        const int v = unknown_of[graph.neighbour[k]];
        if (v >= 0) entries.emplace_back(u, v, -1.0);
        for (int c = 0; c < 3; ++c) {
          const double other = result_.bgr[c * pixels_ + other_pixel];
          if (v < 0) right(u, c) += other;
          if (link.is_alike) right(u, c) += start(u, c) - other;
        }
      }
      // A texel without joined neighbours keeps its colour.
      if (!(diagonal > 0)) diagonal = 1, right.row(u) = start.row(u);
      entries.emplace_back(u, u, diagonal);
    }
    Eigen::SparseMatrix<double, Eigen::RowMajor> matrix(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::MatrixXd solution(count, 3);
    ParallelFor(3, 3, [&](int c) {
      // One solver per channel: it stores its iteration count.
      Eigen::ConjugateGradient<Eigen::SparseMatrix<double, Eigen::RowMajor>, Eigen::Lower | Eigen::Upper> solver;
      solver.setTolerance(kTolerance);
      solver.setMaxIterations(kMaxIterations);
      solver.compute(matrix);
      solution.col(c) = solver.solveWithGuess(right.col(c), start.col(c));
    });
    for (int u = 0; u < count; ++u) {
      for (size_t c = 0; c < 3; ++c) {
        const double value = std::clamp(solution(u, static_cast<Eigen::Index>(c)), 0.0, 1.0);
        result_.bgr[c * pixels_ + graph.pixel[node_of[u]]] = static_cast<float>(value);
      }
    }
  }

  const BodyModel& body_;
  const UvTexelTable& table_;
  std::span<const BodyRegion> regions_;
  const Texture& seen_;
  const WholeTextureOptions& options_;
  const UvCharts charts_;
  const PyramidFill fill_;
  const size_t pixels_;
  WholeTexture result_;
};

}  // namespace

WholeTexture MakeWholeTexture(const BodyModel& body, const UvTexelTable& table, const MatrixX3d& rest_vertices,
                              std::span<const BodyRegion> regions, const Texture& seen,
                              const WholeTextureOptions& options) {
  BODYLOOM_CHECK(seen.width == table.width && seen.height == table.height &&
                     seen.confidence.size() == size_t(table.width) * table.height,
                 "a texture of ", seen.width, "x", seen.height, ", the table is for ", table.width, "x", table.height);
  BODYLOOM_CHECK(static_cast<int>(regions.size()) == body.num_vertices() && rest_vertices.rows() == body.num_vertices(),
                 regions.size(), " regions and ", rest_vertices.rows(), " vertices at rest, expected ",
                 body.num_vertices());
  return Completion(body, table, regions, seen, options).Run(rest_vertices);
}

}  // namespace bodyloom
