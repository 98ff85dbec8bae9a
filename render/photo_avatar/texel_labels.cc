// SPDX-License-Identifier: Apache-2.0
#include "render/photo_avatar/texel_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/base/check.h"
#include "geometry/scene/person_label.h"
#include "render/raster/resolve_pixels.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {
namespace {

constexpr double kDepthWeight = 0.1;

constexpr auto kBackground = static_cast<uint8_t>(PersonLabel::kBackground);
constexpr auto kBottom = static_cast<uint8_t>(PersonLabel::kBottom);
constexpr auto kFace = static_cast<uint8_t>(PersonLabel::kFace);
constexpr auto kHair = static_cast<uint8_t>(PersonLabel::kHair);

bool OfHead(BodyRegion region) { return region == BodyRegion::kFace || region == BodyRegion::kScalp; }

class Labelling {
 public:
  Labelling(const BodyModel& body, const UvTexelTable& table, const MatrixX3d& rest,
            std::span<const BodyRegion> regions)
      : body_(body), table_(table), rest_(rest), regions_(regions), of_vertex_(regions.size(), kBackground) {}

  std::vector<uint8_t> Run(const Texture& seen, std::span<const PhotoLabels> photos) {
    std::vector<uint8_t> texels = SeenTexels(seen, photos);
    Vote(texels);
    FillVertices();
    for (size_t i = 0; i < table_.size(); ++i) {
      uint8_t& label = texels[table_.pixel[i]];
      const auto corners = body_.data().faces.row(table_.face[i]);
      const auto has = [&](int c) { return of_vertex_[corners[c]] == label; };
      if (label == kBackground || !(has(0) || has(1) || has(2))) label = of_vertex_[NearestCorner(i)];
    }
    return texels;
  }

 private:
  [[nodiscard]] int NearestCorner(size_t texel) const {
    Eigen::Index corner = 0;
    table_.barycentric[texel].maxCoeff(&corner);
    return body_.data().faces(table_.face[texel], corner);
  }

  [[nodiscard]] std::vector<uint8_t> SeenTexels(const Texture& seen, std::span<const PhotoLabels> photos) const {
    std::vector<uint8_t> labels(seen.source_frame.size(), kBackground);
    for (const int pixel : table_.pixel) {
      const int frame = seen.source_frame[pixel];
      if (frame < 0) continue;
      const PhotoLabels& photo = photos[frame];
      const int x = std::clamp(static_cast<int>(seen.source_x_px[pixel]), 0, photo.width - 1);
      const int y = std::clamp(static_cast<int>(seen.source_y_px[pixel]), 0, photo.height - 1);
      labels[pixel] = photo.labels[static_cast<size_t>(y) * photo.width + x];
    }
    return labels;
  }

  void Vote(const std::vector<uint8_t>& texels) {
    std::vector<std::array<int, kNumPersonLabels>> votes(of_vertex_.size());
    for (size_t i = 0; i < table_.size(); ++i) {
      const uint8_t label = texels[table_.pixel[i]];
      if (label > kBackground && label < kNumPersonLabels) ++votes[NearestCorner(i)][label];
    }
    for (size_t v = 0; v < votes.size(); ++v) {
      const auto maximum = std::max_element(votes[v].begin(), votes[v].end());
      if (*maximum > 0) of_vertex_[v] = static_cast<uint8_t>(maximum - votes[v].begin());
    }
  }

  void FillVertices() {
    std::vector<int> seen;
    bool hair = false;
    for (size_t v = 0; v < of_vertex_.size(); ++v) {
      if (of_vertex_[v] == kBackground) continue;
      seen.push_back(static_cast<int>(v));
      hair = hair || of_vertex_[v] == kHair;
    }
    std::vector<uint8_t> filled = of_vertex_;
    for (size_t v = 0; v < filled.size(); ++v) {
      if (filled[v] != kBackground) continue;
      filled[v] = hair && regions_[v] == BodyRegion::kScalp ? kHair : NearestLabel(static_cast<int>(v), seen);
    }
    of_vertex_.swap(filled);
  }

  [[nodiscard]] uint8_t NearestLabel(int vertex, const std::vector<int>& seen) const {
    const Eigen::RowVector3d at = rest_.row(vertex);
    const bool garment = regions_[vertex] == BodyRegion::kGarment;
    double nearest = std::numeric_limits<double>::infinity();
    uint8_t label = garment ? kBottom : kBackground;
    for (const int other : seen) {
      const uint8_t theirs = of_vertex_[other];
      if (garment != (regions_[other] == BodyRegion::kGarment)) continue;
      if (!OfHead(regions_[vertex]) && (theirs == kHair || theirs == kFace)) continue;
      const double dx = std::abs(at.x()) - std::abs(rest_(other, 0)), dy = at.y() - rest_(other, 1),
                   dz = at.z() - rest_(other, 2);
      const double distance = dx * dx + dy * dy + kDepthWeight * dz * dz;
      if (distance < nearest) nearest = distance, label = theirs;
    }
    return label;
  }

  const BodyModel& body_;
  const UvTexelTable& table_;
  const MatrixX3d& rest_;
  std::span<const BodyRegion> regions_;
  std::vector<uint8_t> of_vertex_;
};

}  // namespace

std::vector<uint8_t> TexelLabels(const BodyModel& body, const UvTexelTable& table, const MatrixX3d& rest,
                                 std::span<const BodyRegion> regions, const Texture& seen,
                                 std::span<const PhotoLabels> photos) {
  BODYLOOM_CHECK(rest.rows() == body.num_vertices() && regions.size() == static_cast<size_t>(body.num_vertices()),
                 "labels of texels: ", rest.rows(), " vertices and ", regions.size(), " regions of a body of ",
                 body.num_vertices());
  BODYLOOM_CHECK(seen.width == table.width && seen.height == table.height, "labels of texels: a texture of ",
                 seen.width, "x", seen.height, ", the table's is ", table.width, "x", table.height);
  for (const PhotoLabels& photo : photos) {
    BODYLOOM_CHECK(
        photo.width > 0 && photo.height > 0 && photo.labels.size() == static_cast<size_t>(photo.width) * photo.height,
        "labels of texels: ", photo.labels.size(), " labels of a photo of ", photo.width, "x", photo.height);
  }
  for (const int frame : seen.source_frame) {
    BODYLOOM_CHECK(frame < static_cast<int>(photos.size()), "labels of texels: photo ", frame, " of ", photos.size());
  }
  return Labelling(body, table, rest, regions).Run(seen, photos);
}

std::vector<uint8_t> PartsInImage(const BodyModel& body, const MatrixX3d& vertices, const Camera& camera,
                                  int num_threads) {
  VisibilityBuffer buffer;
  VisibilityOptions visibility;
  visibility.num_threads = num_threads;
  buffer.Render(vertices, body.data().faces, camera, visibility);
  ResolveRequest request;
  request.part = true;
  request.num_threads = num_threads;
  ResolvedPixels pixels;
  ResolvePixels(buffer, body, vertices, camera, request, &pixels);
  std::vector<uint8_t> parts(static_cast<size_t>(camera.width) * camera.height, 0);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      if (buffer.FaceAt(x, y) < 0) continue;
      parts[static_cast<size_t>(y) * camera.width + x] = pixels.part[buffer.box().IndexOf(x, y)];
    }
  }
  return parts;
}

}  // namespace bodyloom
