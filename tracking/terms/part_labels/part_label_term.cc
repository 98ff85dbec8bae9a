// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/part_labels/part_label_term.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/equal_bytes.h"
#include "render/raster/raster_simd.h"
#include "render/raster/visible_points.h"
#include "tracking/problem/frame_accumulator.h"

namespace bodyloom {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr uint8_t kBackground = PartLabelSequence::kBackground, kUnknown = PartLabelSequence::kUnknown;
constexpr int kFieldCells = 128;  ///< a field has about this many cells along the person
constexpr int kMinCellPx = 3;     ///< with finer cells the field's gradient would show the mask's pixel steps
constexpr int kMarginCells = 10;  ///< around the region of the field; farther away it is extended as a cone
constexpr int kMaxSilhouette = 160, kMaxPartBoundary = 10, kMaxPartContour = 12, kMaxInside = 10;
constexpr double kAlongBoundary = 0.2;     ///< τ
constexpr double kInsideSigmas = 3;        ///< σ of "somewhere on this part"
constexpr double kBehindTolerance = 0.02;  ///< metres: neighbouring pixels of one surface
constexpr double kBoundaryReach = 0.25;    ///< of the person's height: maximum distance of correspondences

/// At most n of `items`, evenly spread.
template <typename T>
std::vector<T> Thinned(const std::vector<T>& items, size_t n) {
  if (items.size() <= n) return items;
  std::vector<T> result;
  for (size_t k = 0; k < n; ++k) result.push_back(items[k * items.size() / n]);
  return result;
}

/// The parts that a row of a visibility buffer shows; `part_of_seen` has the background's before those of the faces.
void ReadPartsSeen(const int32_t* faces, int width, const std::vector<uint8_t>& part_of_seen, uint8_t* parts) {
  int i = 0;
  for (; i + 8 <= width; i += 8) {
    if (SeeNothing(faces + i)) {
      std::fill_n(parts + i, 8, kBackground);
    } else {
      for (int k = i; k < i + 8; ++k) parts[k] = part_of_seen[size_t(faces[k] + 1)];
    }
  }
  for (; i < width; ++i) parts[i] = part_of_seen[size_t(faces[i] + 1)];
}

}  // namespace

bool IsMask(const PartLabelSequence& labels) {
  const auto is_same = [&](uint8_t part) { return part == labels.part_of_chart[1]; };
  return std::all_of(labels.part_of_chart.begin() + 1, labels.part_of_chart.begin() + kUnknown, is_same);
}

PartLabelMatches::PartLabelMatches(const PartLabelSequence& labels, int t, std::shared_ptr<const Skinner> skinner,
                                   const PartLabelOptions& options)
    : labels_(labels), t_(t), skinner_(std::move(skinner)), options_(options) {
  BODYLOOM_CHECK(t >= 0 && t < labels.num_frames(), "part labels: frame ", t, " of ", labels.num_frames());
  const PartMap map = MakePartMap(labels, t, kSpeckShare);
  boxes_.resize(256);
  pixels_of_part_.resize(256);
  FindBoxes(map);
  if (num_person_pixels_ < kMinPartPixels) {
    num_person_pixels_ = 0;
    return;
  }
  cell_px_ = std::max(kMinCellPx, std::max(boxes_[0].width(), boxes_[0].height()) / kFieldCells);
  AddField(map, kBackground);
  int parts = 0;
  for (int p = 1; p < kUnknown; ++p) parts += pixels_of_part_[p] > 0;
  if (parts > 1 && options.part_weight > 0) {  // a mask has no parts
    for (int p = 1; p < kUnknown; ++p) {
      if (pixels_of_part_[p] >= kMinPartPixels) AddField(map, static_cast<uint8_t>(p));
    }
    SampleInside(map);
  }
  SampleBoundary(map);
  boxes_ = std::vector<PixelBox>();  // clips hold thousands of frames
  pixels_of_part_ = std::vector<int>();
}

const DistanceField* PartLabelMatches::Field(uint8_t part) const {
  const auto it = fields_.find(part);
  return it == fields_.end() ? nullptr : &it->second;
}

std::vector<uint8_t> PartLabelMatches::PartOfFaces(const BodyModel& model) const {
  std::vector<uint8_t> result(model.num_faces());
  for (int f = 0; f < model.num_faces(); ++f) {
    const uint8_t part = labels_.part_of_chart[model.has_parts() ? model.data().face_part[f] : 0];
    result[f] = part == kBackground ? kUnknown : part;
  }
  return result;
}

void PartLabelMatches::FindBoxes(const PartMap& map) {
  const auto grow = [](PixelBox* box, int x_begin, int x_end, int y) {
    *box = box->empty() ? PixelBox{x_begin, y, x_end, y + 1}
                        : PixelBox{std::min(box->x_begin, x_begin), std::min(box->y_begin, y),
                                   std::max(box->x_end, x_end), std::max(box->y_end, y + 1)};
  };
  const int width = map.box.width();
  for (int y = map.box.y_begin; y < map.box.y_end; ++y) {
    const uint8_t* row = &map.parts[map.box.IndexOf(map.box.x_begin, y)];
    for (int begin = 0, end = 0; begin < width; begin = end) {
      end = EndOfRun(row, begin, width);
      const uint8_t part = row[begin];
      if (!IsPart(part)) continue;
      num_person_pixels_ += end - begin;
      pixels_of_part_[part] += end - begin;
      for (PixelBox* box : {&boxes_[part], &boxes_[0]}) grow(box, map.box.x_begin + begin, map.box.x_begin + end, y);
    }
  }
}

void PartLabelMatches::AddField(const PartMap& map, uint8_t part) {
  // Pixels beyond the image are unknown; one cell of them is enough for the field.
  const PixelBox box = boxes_[part].GrownBy(kMarginCells * cell_px_).ClippedTo(map.image.GrownBy(cell_px_));
  using Pixel = DistanceField::Pixel;
  std::array<Pixel, 256> kind;  // by part
  kind.fill(part == kBackground ? Pixel::kInside : Pixel::kOutside);
  kind[kBackground] = Pixel::kOutside;
  if (part != kBackground) kind[part] = Pixel::kInside;
  kind[kUnknown] = Pixel::kUnknown;
  std::vector<uint8_t> parts(size_t(box.width()));
  const auto fill_row = [&](int y, Pixel* row) {
    map.ReadRow(y, box.x_begin, box.x_end, parts.data());
    std::transform(parts.begin(), parts.end(), row, [&kind](uint8_t at) { return kind[at]; });
  };
  fields_.try_emplace(part, box.x_begin, box.y_begin, box.width(), box.height(), cell_px_, fill_row);
}

void PartLabelMatches::SampleBoundary(const PartMap& map) {
  std::vector<BoundarySample> silhouette;
  std::map<std::pair<uint8_t, uint8_t>, std::vector<BoundarySample>> between;
  const PixelBox box = boxes_[0].GrownBy(1).ClippedTo(map.image);
  const int width = box.width();
  std::vector<uint8_t> row(size_t(width) + 1), below(size_t(width) + 1);
  const auto look = [&](int x, int y, uint8_t here, uint8_t there, const Vector2d& half_way) {
    if (here == there || here == kUnknown || there == kUnknown) return;
    const BoundarySample sample{Vector2d(x, y) + half_way, std::min(here, there), std::max(here, there)};
    (sample.a == kBackground ? silhouette : between[{sample.a, sample.b}]).push_back(sample);
  };
  map.ReadRow(box.y_begin, box.x_begin, box.x_end + 1, row.data());
  for (int y = box.y_begin; y < box.y_end; ++y, row.swap(below)) {
    map.ReadRow(y + 1, box.x_begin, box.x_end + 1, below.data());
    for (int i = 0; i < width; ++i) {
      i = FirstDifference(i, width, row.data(), row.data() + 1, below.data());
      if (i == width) break;
      look(box.x_begin + i, y, row[size_t(i)], row[size_t(i) + 1], {0.5, 0});
      look(box.x_begin + i, y, row[size_t(i)], below[size_t(i)], {0, 0.5});
    }
  }
  if (options_.silhouette_weight > 0) boundary_ = Thinned(silhouette, kMaxSilhouette);
  if (fields_.size() < 2) return;
  for (const auto& [pair, all] : between) {
    const std::vector<BoundarySample> some = Thinned(all, kMaxPartBoundary);
    boundary_.insert(boundary_.end(), some.begin(), some.end());
  }
}

void PartLabelMatches::SampleInside(const PartMap& map) {
  std::array<std::vector<Inside>, 256> by_part;
  const PixelBox& box = boxes_[0];
  // A grid of at least kMaxInside points in the smallest part that counts is finer than needed elsewhere: thinned
  // below.
  const int step = std::max(1, cell_px_ / 2);
  for (int y = box.y_begin; y < box.y_end; y += step) {
    for (int x = box.x_begin; x < box.x_end; x += step) {
      const uint8_t part = map.At(x, y);
      if (IsPart(part) && fields_.contains(part)) by_part[part].push_back({x, y, part});
    }
  }
  for (const std::vector<Inside>& all : by_part) {
    const std::vector<Inside> some = Thinned(all, kMaxInside);
    inside_.insert(inside_.end(), some.begin(), some.end());
  }
}

std::vector<PartLabelMatches::Edge> PartLabelMatches::EdgesOfBody(const std::vector<uint8_t>& part_of_face,
                                                                  const VisibilityBuffer& buffer) const {
  std::vector<Edge> edges;
  const PixelBox& box = buffer.box();
  if (box.empty()) return edges;
  const PixelBox image{0, 0, labels_.image_width, labels_.image_height};
  constexpr std::array<std::pair<int, int>, 4> kNeighbours = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};
  // The parts that three rows show, with a pixel of background on either side: pixels among their like are no edges.
  const int width = box.width();
  std::array<std::vector<uint8_t>, 3> rows;
  for (std::vector<uint8_t>& row : rows) row.assign(size_t(width) + 2, kBackground);
  std::vector<uint8_t> part_of_seen(1, kBackground);
  part_of_seen.insert(part_of_seen.end(), part_of_face.begin(), part_of_face.end());
  const auto read = [&](int y, std::vector<uint8_t>* row) {
    if (y >= box.y_end) {
      std::fill(row->begin(), row->end(), kBackground);
    } else {
      ReadPartsSeen(&buffer.faces()[box.IndexOf(box.x_begin, y)], width, part_of_seen, row->data() + 1);
    }
  };
  auto& [above, here, below] = rows;
  read(box.y_begin, &here);
  for (int y = box.y_begin; y < box.y_end; ++y, above.swap(here), here.swap(below)) {
    read(y + 1, &below);
    for (int i = 1; i <= width; ++i) {
      i = FirstDifference(i, width + 1, here.data(), here.data() + 1, here.data() - 1, below.data(), above.data());
      if (i > width) break;
      const int x = box.x_begin + i - 1;
      const int face = buffer.faces()[box.IndexOf(x, y)];
      if (face < 0) continue;
      const uint8_t part = part_of_face[face];
      for (const auto& [dx, dy] : kNeighbours) {
        if (!image.Contains(x + dx, y + dy)) continue;  // the image ends here, not the body
        const int neighbour = buffer.FaceAt(x + dx, y + dy);
        if (neighbour == face) continue;
        const uint8_t other = neighbour < 0 ? kBackground : part_of_face[neighbour];
        if (other == part || other == kUnknown || (part == kUnknown && other != kBackground)) continue;
        if (neighbour >= 0 && buffer.DepthAt(x, y) > buffer.DepthAt(x + dx, y + dy) + kBehindTolerance) continue;
        edges.push_back({x, y, face, part, other});
        if (other == kBackground) break;  // once is enough for the silhouette
      }
    }
  }
  return edges;
}

void PartLabelMatches::AddContour(const std::vector<Edge>& edges, const BodyModel& model, const VisibleSurface& surface,
                                  const Camera& camera, const Sigmas& sigmas) {
  const auto add = [&](const Edge& edge, const DistanceField* field, bool is_silhouette) {
    if (labels_.PartAt(t_, edge.x, edge.y) == kUnknown) return;
    ContourPoint point;
    point.face = edge.face;
    point.barycentric =
        BarycentricAtPixel(surface.vertices(), model.data().faces, camera, edge.face, Vector2d(edge.x, edge.y));
    point.field = field;
    point.offset_px = -0.5;  // the centre of the last pixel inside
    point.inverse_sigma = 1 / sigmas.contour_px;
    point.inverse_sigma_inside = is_silhouette ? 1 / sigmas.clothes_px : point.inverse_sigma;
    point.is_silhouette = is_silhouette;
    contour_.push_back(point);
  };
  std::vector<Edge> silhouette;
  std::map<uint8_t, std::vector<Edge>> of_part;
  for (const Edge& edge : edges) {
    if (edge.other == kBackground) silhouette.push_back(edge);
    if (Field(edge.part) != nullptr && edge.part != kUnknown) of_part[edge.part].push_back(edge);
  }
  if (options_.silhouette_weight > 0) {
    for (const Edge& edge : Thinned(silhouette, kMaxSilhouette)) add(edge, Field(kBackground), true);
  }
  if (options_.part_weight > 0) {
    for (const auto& [part, all] : of_part) {
      for (const Edge& edge : Thinned(all, kMaxPartContour)) add(edge, Field(part), false);
    }
  }
}

const PartLabelMatches::Edge* PartLabelMatches::Nearest(const std::vector<const Edge*>& edges, const Vector2d& pixel,
                                                        double reach_px) {
  const auto middle =
      std::lower_bound(edges.begin(), edges.end(), pixel.y(), [](const Edge* edge, double y) { return edge->y < y; });
  const Edge* nearest = nullptr;
  double best = reach_px * reach_px;
  // Rows away from the pixel's until they are farther than the best; of equal distances the first edge counts.
  for (auto it = middle; it != edges.end() && (*it)->y - pixel.y() <= std::sqrt(best); ++it) {
    const double squared = (Vector2d((*it)->x, (*it)->y) - pixel).squaredNorm();
    if (squared < best) {
      best = squared;
      nearest = *it;
    }
  }
  for (auto it = middle; it != edges.begin() && pixel.y() - (*std::prev(it))->y <= std::sqrt(best); --it) {
    const Edge* edge = *std::prev(it);
    const double squared = (Vector2d(edge->x, edge->y) - pixel).squaredNorm();
    if (squared < best || (squared == best && nearest != nullptr)) {
      best = squared;
      nearest = edge;
    }
  }
  return nearest;
}

void PartLabelMatches::AddBoundary(const std::vector<Edge>& edges, const BodyModel& model,
                                   const VisibleSurface& surface, const Camera& camera, const Sigmas& sigmas,
                                   double reach_px) {
  std::map<std::pair<uint8_t, uint8_t>, std::vector<const Edge*>> between;
  for (const Edge& edge : edges) {
    const auto key = edge.other == kBackground
                         ? std::pair(kBackground, kBackground)
                         : std::pair(std::min(edge.part, edge.other), std::max(edge.part, edge.other));
    between[key].push_back(&edge);
  }
  for (const BoundarySample& sample : boundary_) {
    const bool is_silhouette = sample.a == kBackground;
    const auto it = between.find(is_silhouette ? std::pair(kBackground, kBackground) : std::pair(sample.a, sample.b));
    const Edge* nearest = it != between.end() ? Nearest(it->second, sample.pixel, reach_px) : nullptr;
    const DistanceField* field =
        is_silhouette ? Field(kBackground) : (nearest != nullptr ? Field(nearest->part) : nullptr);
    if (nearest == nullptr || field == nullptr) {
      ++(is_silhouette ? silhouette_unmatched_ : part_unmatched_);
      continue;
    }
    Eigen::RowVector2d gradient;
    field->Evaluate(sample.pixel, &gradient);
    const double length = gradient.norm();
    Target target;
    target.face = nearest->face;
    target.barycentric = BarycentricAtPixel(surface.vertices(), model.data().faces, camera, nearest->face,
                                            Vector2d(nearest->x, nearest->y));
    target.pixel = sample.pixel;
    target.is_silhouette = is_silhouette;
    // On a ridge of the field no direction is across the boundary.
    target.whitening = target.whitening_inside = Matrix2d::Identity() * (kAlongBoundary / sigmas.contour_px);
    if (length > 0.1) {
      const Vector2d n = gradient.transpose() / length;
      target.outward = n;
      target.pixel -= 0.5 * n;  // the contour's samples are centres of pixels, half a pixel inside
      const double share_inside = is_silhouette ? sigmas.contour_px / sigmas.clothes_px : 1;
      target.whitening += (1 - kAlongBoundary) / sigmas.contour_px * n * n.transpose();
      target.whitening_inside += (share_inside - kAlongBoundary) / sigmas.contour_px * n * n.transpose();
    }
    targets_.push_back(target);
  }
}

void PartLabelMatches::AddInside(const std::vector<uint8_t>& part_of_face, const BodyModel& model,
                                 const VisibleSurface& surface, const Camera& camera, double sigma_px) {
  const MatrixX3i& faces = model.data().faces;
  struct Corner {
    Vector2d pixel;
    int face, corner;
  };
  std::map<uint8_t, std::vector<Corner>> facing;  // one entry a vertex and part, for parts that some pixel misses
  std::vector<Inside> missed;
  for (const Inside& inside : inside_) {
    const int face = surface.buffer().FaceAt(inside.x, inside.y);
    if (face >= 0 && part_of_face[face] == inside.part) continue;
    missed.push_back(inside);
    facing.try_emplace(inside.part);
  }
  if (missed.empty()) return;
  std::vector<uint8_t> taken(model.num_vertices(), 0);
  for (int f = 0; f < model.num_faces(); ++f) {
    const uint8_t part = part_of_face[f];
    const auto it = facing.find(part);
    if (it == facing.end()) continue;
    std::array<Vector2d, 3> pixel;
    bool visible = true;
    for (int c = 0; c < 3 && visible; ++c) visible = camera.Project(surface.vertices().row(faces(f, c)), &pixel[c]);
    if (!visible) continue;
    const Vector2d a = pixel[1] - pixel[0], b = pixel[2] - pixel[0];
    if (a.x() * b.y() - a.y() * b.x() >= 0) continue;  // y is down: faces seen from outside turn clockwise
    for (int c = 0; c < 3; ++c) {
      if (taken[faces(f, c)] == part) continue;
      taken[faces(f, c)] = part;
      it->second.push_back({pixel[c], f, c});
    }
  }
  for (const Inside& inside : missed) {
    const Vector2d pixel(inside.x, inside.y);
    const Corner* nearest = nullptr;
    double best = std::numeric_limits<double>::infinity();
    for (const Corner& corner : facing[inside.part]) {
      const double squared = (corner.pixel - pixel).squaredNorm();
      if (squared < best) {
        best = squared;
        nearest = &corner;
      }
    }
    if (nearest == nullptr) {
      ++part_unmatched_;
      continue;
    }
    Target target;
    target.face = nearest->face;
    target.barycentric = Vector3d::Unit(nearest->corner);
    target.pixel = pixel;
    target.whitening = target.whitening_inside = Matrix2d::Identity() / (kInsideSigmas * sigma_px);
    targets_.push_back(target);
  }
}

void PartLabelMatches::Weigh(double factor) {
  std::array<double, 2> count = {0, 0};
  for (const Target& target : targets_) ++count[target.is_silhouette];
  for (const ContourPoint& point : contour_) ++count[point.is_silhouette];
  const std::array<double, 2> weight = {
      factor * options_.part_weight * std::min(1.0, kPartCount / std::max(1.0, count[0])),
      factor * options_.silhouette_weight * std::min(1.0, kSilhouetteCount / std::max(1.0, count[1]))};
  for (Target& target : targets_) target.weight = weight[target.is_silhouette];
  for (ContourPoint& point : contour_) point.weight = weight[point.is_silhouette];
  for (const Target& target : targets_) num_rows_[target.is_silhouette] += 2;
  for (const ContourPoint& point : contour_) ++num_rows_[point.is_silhouette];
}

void PartLabelMatches::Correspond(const FrameLayout& layout, const FrameState& state, const Eigen::VectorXd& betas,
                                  double log_focal, double person_height_px, double kernel, double weight,
                                  VisibleSurface* surface) {
  targets_.clear();
  contour_.clear();
  kernel_ = kernel;
  num_rows_ = {0, 0};
  silhouette_unmatched_ = part_unmatched_ = 0;
  if (num_person_pixels_ == 0) return;
  const BodyModel& model = *layout.model;
  const Camera camera = layout.CameraAt(state, log_focal);
  if (!surface->Render(skinner_, model, betas, state.rotations, layout.BodyTranslation(state), camera)) return;
  const double sigma_px = std::max(0.5, options_.sigma_share * person_height_px);
  const double clothes_px = std::max(sigma_px, options_.clothes_sigma_share * person_height_px);
  const Sigmas sigmas{sigma_px, IsMask(labels_) ? clothes_px : sigma_px};
  const std::vector<uint8_t> part_of_face = PartOfFaces(model);
  const std::vector<Edge> edges = EdgesOfBody(part_of_face, surface->buffer());
  AddContour(edges, model, *surface, camera, sigmas);
  AddBoundary(edges, model, *surface, camera, sigmas, kBoundaryReach * person_height_px);
  AddInside(part_of_face, model, *surface, camera, sigma_px);
  targets_.shrink_to_fit();
  contour_.shrink_to_fit();
  Weigh(weight);
}

int PartLabelMatches::MaxMaskRows() { return 3 * kMaxSilhouette; }

void AddMatches(const PartLabelSource& source, bool of_silhouette, FrameAccumulator* sums) {
  const std::shared_ptr<const PartLabelMatches> held = source.Get(sums->layout());
  const PartLabelMatches& matches = *held;
  const MatrixX3i& faces = sums->layout().model->data().faces;
  const Kinematics& kinematics = sums->kinematics();
  const bool derivatives = sums->derivatives();
  PixelResiduals* residuals = sums->residuals(of_silhouette ? "silhouette" : "part labels");
  for (const PartLabelMatches::Target& target : matches.targets()) {
    if (target.is_silhouette != of_silhouette) continue;
    const Vector3d x = sums->points().Evaluate(kinematics, faces.row(target.face).data(), target.barycentric.data(),
                                               &sums->vertices(), derivatives);
    FrameAccumulator::Projected at;
    if (!sums->Project(x, &at)) {
      sums->AddSaturated(matches.kernel(), target.weight);
      continue;
    }
    const Matrix2d& whitening = target.WhiteningAt(at.pixel);
    sums->AddImageRows<2>(at, whitening * (at.pixel - target.pixel), whitening, matches.kernel(), target.weight);
  }
  for (const PartLabelMatches::ContourPoint& point : matches.contour()) {
    if (point.is_silhouette != of_silhouette) continue;
    const Vector3d x = sums->points().Evaluate(kinematics, faces.row(point.face).data(), point.barycentric.data(),
                                               &sums->vertices(), derivatives);
    FrameAccumulator::Projected at;
    if (!sums->Project(x, &at)) {
      sums->AddSaturated(matches.kernel(), point.weight);
      continue;
    }
    Eigen::RowVector2d gradient;
    const double distance = point.field->Evaluate(at.pixel, &gradient) - point.offset_px;
    if (residuals != nullptr) residuals->px.push_back(std::abs(distance));
    const double inverse_sigma = point.InverseSigmaAt(distance);
    sums->AddImageRows<1>(at, Eigen::Matrix<double, 1, 1>(distance * inverse_sigma), gradient * inverse_sigma,
                          matches.kernel(), point.weight);
  }
  if (residuals != nullptr) {
    residuals->unmatched += of_silhouette ? matches.silhouette_unmatched() : matches.part_unmatched();
  }
}

}  // namespace bodyloom
