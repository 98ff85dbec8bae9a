// SPDX-License-Identifier: Apache-2.0
#include "render/photo_avatar/transfer_clothes.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/body/normals.h"
#include "geometry/body/posed_body.h"
#include "geometry/cloth/body_with_garment.h"
#include "geometry/scene/person_label.h"
#include "geometry/scene/track_edits.h"
#include "geometry/uv_maps/uv_texels.h"
#include "render/image/image.h"
#include "render/image/palette.h"
#include "render/raster/resolve_pixels.h"
#include "render/texture/body_regions.h"

namespace bodyloom {
namespace {

constexpr int kPelvis = 0, kNeck = 12;  ///< SMPL's joints; a body with a garment has them

bool IsWorn(PersonLabel label) {
  return label == PersonLabel::kTop || label == PersonLabel::kBottom || label == PersonLabel::kShoes;
}

/// The atlas of a person: colours, labels and sources at a point of the surface.
class Atlas {
 public:
  explicit Atlas(const PhotoPerson& person)
      : person_(person), data_(person.body->data()), colours_(person.texture.bgr.begin(), person.texture.bgr.end()) {
    const size_t texels = static_cast<size_t>(person.texture.width) * person.texture.height;
    BODYLOOM_CHECK(person.labels.size() == texels,
                   "clothes: it is not known what the texels show; expected a person made from photos anew");
    of_vertex_.assign(static_cast<size_t>(person.body->num_vertices()), -1);
    for (Eigen::Index f = 0; f < data_.faces.rows(); ++f) {
      for (int c = 0; c < 3; ++c) of_vertex_[data_.faces(f, c)] = data_.ft(f, c);
    }
  }

  [[nodiscard]] Eigen::Vector2f PlaceOf(int face, const Eigen::Vector3f& barycentric) const {
    Eigen::Vector2f uv = Eigen::Vector2f::Zero();
    for (int c = 0; c < 3; ++c) uv += barycentric[c] * data_.vt.row(data_.ft(face, c)).transpose();
    return uv;
  }
  /// Blue, green, red, 0 to 255.
  [[nodiscard]] ChannelTriple ColourAt(const Eigen::Vector2f& uv) const {
    ChannelTriple bgr{};
    SampleTexels({colours_, person_.texture.width, person_.texture.height, 3}, uv.x(), uv.y(), bgr.data());
    return bgr;
  }
  [[nodiscard]] size_t TexelAt(const Eigen::Vector2f& uv) const {
    const int width = person_.texture.width, height = person_.texture.height;
    const int x = std::clamp(static_cast<int>(uv.x() * static_cast<float>(width)), 0, width - 1);
    const int y = std::clamp(static_cast<int>((1 - uv.y()) * static_cast<float>(height)), 0, height - 1);
    return static_cast<size_t>(y) * width + x;
  }
  [[nodiscard]] PersonLabel LabelAt(const Eigen::Vector2f& uv) const {
    return static_cast<PersonLabel>(person_.labels[TexelAt(uv)]);
  }
  [[nodiscard]] PersonLabel LabelOfVertex(int vertex) const {
    return of_vertex_[vertex] < 0 ? PersonLabel::kSkin : LabelAt(data_.vt.row(of_vertex_[vertex]).transpose());
  }
  /// Median colour of the texels with this label; grey if there is none.
  [[nodiscard]] ChannelTriple MedianOf(PersonLabel label) const {
    std::vector<ChannelTriple> colours;
    for (size_t i = 0; i < person_.labels.size(); ++i) {
      if (person_.labels[i] != static_cast<uint8_t>(label)) continue;
      colours.push_back({colours_[3 * i], colours_[3 * i + 1], colours_[3 * i + 2]});
    }
    return colours.empty() ? ChannelTriple{128, 128, 128} : MedianColour(colours);
  }
  /// Median colour of the skin, or of the face if no skin is seen.
  [[nodiscard]] ChannelTriple Skin() const {
    const auto skin = static_cast<uint8_t>(PersonLabel::kSkin);
    const bool any = std::find(person_.labels.begin(), person_.labels.end(), skin) != person_.labels.end();
    return MedianOf(any ? PersonLabel::kSkin : PersonLabel::kFace);
  }

 private:
  const PhotoPerson& person_;
  const BodyModelData& data_;
  std::vector<float> colours_;
  std::vector<int> of_vertex_;  ///< index into vt of each vertex
};

/// Offsets of the clothed body's vertices from the bare one's along its normals (BakeShape()), metres.
std::vector<double> OffsetsOf(const PhotoPerson& person) {
  const MatrixX3d bare = ShapeVertices(*person.bare, person.betas);
  const MatrixX3f normals = VertexNormals(bare, person.bare->data().faces);
  const MatrixX3d& clothed = person.clothed->data().v_template;
  std::vector<double> offsets;
  for (Eigen::Index v = 0; v < bare.rows(); ++v) {
    offsets.push_back((clothed.row(v) - bare.row(v)).dot(normals.row(v).cast<double>()));
  }
  return offsets;
}

class Dressing {
 public:
  Dressing(const PhotoPerson& person, const PhotoPerson& other)
      : person_(person),
        other_(other),
        mine_(person),
        theirs_(other),
        my_skin_(mine_.Skin()),
        their_skin_(theirs_.Skin()) {
    BODYLOOM_CHECK(person.bare->num_vertices() == other.bare->num_vertices() &&
                       person.bare->data().faces == other.bare->data().faces,
                   "clothes: two people made with different bodies, expected the same");
    regions_ = BodyRegions(*person.bare, ShapeVertices(*person.bare, person.betas));
  }

  PhotoPerson Run() {
    PhotoPerson dressed = person_;
    dressed.clothed = std::make_shared<const BodyModel>(BakeShape(*person_.bare, person_.betas, Offsets()));
    dressed.body = dressed.clothed;
    dressed.garment = {}, dressed.cut = other_.cut;
    if (other_.cut.length_m > 0) {
      dressed.cut.waist_y_m = WaistHere();
      dressed.garment = CutGarment(*dressed.clothed, &dressed.cut);
      dressed.body = std::make_shared<const BodyModel>(BodyWithGarment(*dressed.clothed, dressed.garment));
    }
    dressed.report.garment_length_m = dressed.cut.length_m;
    Paint(&dressed);
    return dressed;
  }

 private:
  [[nodiscard]] bool OfHead(int vertex) const {
    return regions_[vertex] == BodyRegion::kFace || regions_[vertex] == BodyRegion::kScalp;
  }

  [[nodiscard]] std::vector<double> Offsets() const {
    const std::vector<double> theirs = OffsetsOf(other_);
    std::vector<double> offsets = OffsetsOf(person_);
    for (int v = 0; v < person_.bare->num_vertices(); ++v) {
      if (OfHead(v)) continue;
      if (IsWorn(theirs_.LabelOfVertex(v))) {
        offsets[v] = theirs[v];
      } else if (IsWorn(mine_.LabelOfVertex(v))) {
        offsets[v] = std::min(offsets[v], theirs[v]);
      }
    }
    return offsets;
  }

  [[nodiscard]] double WaistHere() const {
    const MatrixX3d here = person_.bare->RestJoints(person_.betas), there = other_.bare->RestJoints(other_.betas);
    const double scale = (here(kNeck, 1) - here(kPelvis, 1)) / (there(kNeck, 1) - there(kPelvis, 1));
    return here(kPelvis, 1) + scale * (other_.cut.waist_y_m - there(kPelvis, 1));
  }

  struct Texel {
    ChannelTriple bgr;
    PersonLabel label;
    const PhotoPerson* from;
    size_t at;  ///< in its atlas
  };

  [[nodiscard]] Texel OfBody(int face, const Eigen::Vector3f& barycentric) const {
    const Eigen::Vector2f here = mine_.PlaceOf(face, barycentric), there = theirs_.PlaceOf(face, barycentric);
    const PersonLabel mine = mine_.LabelAt(here), theirs = theirs_.LabelAt(there);
    const Texel as_i_am = {mine_.ColourAt(here), mine, &person_, mine_.TexelAt(here)};
    Eigen::Index corner = 0;
    barycentric.maxCoeff(&corner);
    const bool head = OfHead(person_.bare->data().faces(face, corner));
    if (head && !IsWorn(mine)) return as_i_am;  // a collar does not belong to the head
    Texel as_they_are = {theirs_.ColourAt(there), theirs, &other_, theirs_.TexelAt(there)};
    if (IsWorn(theirs)) return as_they_are;
    if (!head && (theirs == PersonLabel::kHair || theirs == PersonLabel::kFace)) {  // hair in front of their shirt
      as_they_are.bgr = theirs_.MedianOf(as_they_are.label = PersonLabel::kTop);
      return as_they_are;
    }
    if (!IsWorn(mine) && mine != PersonLabel::kHair) return as_i_am;
    for (size_t c = 0; c < 3; ++c) as_they_are.bgr[c] *= my_skin_[c] / std::max(1.0F, their_skin_[c]);
    return as_they_are;
  }

  void Paint(PhotoPerson* dressed) const {
    const int width = person_.texture.width, height = person_.texture.height;
    const UvTexelTable table = BuildUvTexelTable(*dressed->body, {.width = width, .height = height, .gutter = 1});
    dressed->texture = dressed->sources = Image(width, height);
    dressed->labels.assign(static_cast<size_t>(width) * height, 0);
    const Eigen::Index faces_of_body = person_.bare->data().faces.rows();
    const Atlas strip(*dressed);
    for (size_t i = 0; i < table.size(); ++i) {
      const auto at = static_cast<size_t>(table.pixel[i]);
      Texel texel{};
      if (table.face[i] < faces_of_body) {
        texel = OfBody(table.face[i], table.barycentric[i]);
      } else {  // the same place in the garment's strip, for any number of rings
        const Eigen::Vector2f uv = strip.PlaceOf(table.face[i], table.barycentric[i]);
        texel = {theirs_.ColourAt(uv), theirs_.LabelAt(uv), &other_, theirs_.TexelAt(uv)};
      }
      for (size_t c = 0; c < 3; ++c) {
        dressed->texture.bgr[3 * at + c] = UnitByte(texel.bgr[c] / 255);
        if (!texel.from->sources.empty()) dressed->sources.bgr[3 * at + c] = texel.from->sources.bgr[3 * texel.at + c];
      }
      dressed->labels[at] = static_cast<uint8_t>(texel.label);
    }
  }

  const PhotoPerson& person_;
  const PhotoPerson& other_;
  Atlas mine_, theirs_;
  ChannelTriple my_skin_, their_skin_;
  std::vector<BodyRegion> regions_;
};

}  // namespace

PhotoPerson TransferClothes(const PhotoPerson& person, const PhotoPerson& other) {
  return Dressing(person, other).Run();
}

}  // namespace bodyloom
