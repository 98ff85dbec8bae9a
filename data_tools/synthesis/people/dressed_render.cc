// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/people/dressed_render.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "render/view/view_camera.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Directions about the vertical.
class AroundPerson {
 public:
  explicit AroundPerson(const Vector3d& up)
      : up_(up), side_(up.cross(Vector3d::UnitZ()).normalized()), away_(side_.cross(up)) {}

  /// Azimuth 0: from behind the person, π: from behind the camera.
  [[nodiscard]] Vector3f At(double azimuth, double height) const {
    const Vector3d level = std::cos(azimuth) * away_ + std::sin(azimuth) * side_;
    return (std::cos(height) * level + std::sin(height) * up_).cast<float>().normalized();
  }

 private:
  Vector3d up_, side_, away_;
};

PersonLight StudioLight(const AroundPerson& around, HashRandom* random) {
  PersonLight light;
  const double beside = random->Uniform(0.3, 1.1);
  const double key = random->Uniform() < 0.5 ? -beside : beside;
  const double key_height = random->Uniform(0.4, 0.9), fill_height = random->Uniform(0.0, 0.5);
  light.towards = {around.At(key, key_height), around.At(-1.5 * key, fill_height)};
  light.ambient = float(random->Uniform(0.5, 0.62));
  const auto key_strength = float(random->Uniform(0.5, 0.65)), fill_strength = float(random->Uniform(0.1, 0.25));
  light.strength = {key_strength, fill_strength};
  return light;
}

PersonLight NaturalLight(const AroundPerson& around, HashRandom* random) {
  PersonLight light;
  const double hardness = random->Uniform();  // 0: an overcast sky, 1: the sun
  constexpr double kBehindCamera = std::numbers::pi, kMaxBeside = 2.4;
  const double key = kBehindCamera + random->Uniform(-kMaxBeside, kMaxBeside),
               fill = random->Uniform(0, 2 * std::numbers::pi);
  const double key_height = random->Uniform(0.15, 1.35), fill_height = random->Uniform(-0.2, 0.8);
  light.towards = {around.At(key, key_height), around.At(fill, fill_height)};
  light.ambient = float(0.85 - 0.5 * hardness + random->Uniform(-0.08, 0.08));
  const auto key_strength = float(0.2 + 0.7 * hardness + random->Uniform(-0.05, 0.1)),
             fill_strength = float(random->Uniform(0.02, 0.25));
  light.strength = {key_strength, fill_strength};
  light.shadow_softness_m = float(0.06 - 0.055 * hardness);
  return light;
}

constexpr float kInnerShade = 0.7F;
constexpr int kShadowMapPx = 640;
constexpr double kShadowLift_m = 0.008;  ///< off the surface, so that it does not shade itself
constexpr float kThrownBack = 0.2F;      ///< share of the ambient light at occluded points

/// The faces of clothed body and cloth as a static body, against which pixels are resolved.
BodyModel MeshOf(const DressedPerson& person) {
  const MatrixX3i& body = person.body().data().faces;
  const MatrixX3i& cloth = person.garment().drawn_faces;
  const int V = person.body().num_vertices(), n = V + static_cast<int>(person.garment().drawn_from.size());
  BodyModelData data;
  data.name = "dressed";
  data.joint_names = {"root"};
  data.parents = {-1};
  data.v_template = MatrixX3d::Zero(n, 3);
  data.shapedirs.resize(3 * n, 0);
  data.J_regressor.resize(1, n), data.J_regressor.insert(0, 0) = 1;
  data.weights.resize(n, 1);
  for (int v = 0; v < n; ++v) data.weights.insert(v, 0) = 1;
  data.faces.resize(body.rows() + cloth.rows(), 3);
  data.faces.topRows(body.rows()) = body;
  data.faces.bottomRows(cloth.rows()) = cloth.array() + V;
  return BodyModel(std::move(data));
}

}  // namespace

std::string ToString(LightStyle style) { return style == LightStyle::kNatural ? "natural" : "studio"; }

LightStyle LightStyleFromString(const std::string& name) {
  for (const LightStyle style : {LightStyle::kStudio, LightStyle::kNatural}) {
    if (ToString(style) == name) return style;
  }
  throw std::invalid_argument("light style \"" + name + "\", expected studio or natural");
}

PersonLight LightOfSeed(const Vector3d& up_in_camera, LightStyle style, uint64_t seed) {
  HashRandom random(seed, {0x6c696768});
  const AroundPerson around(up_in_camera);
  return style == LightStyle::kNatural ? NaturalLight(around, &random) : StudioLight(around, &random);
}

DressedPerson::DressedPerson(const BodyModel& body, const Eigen::VectorXd& betas, GarmentKind kind, uint64_t seed,
                             ClothesStyle style, ClothMaterial material)
    : DressedPerson(body, betas, Outfit(body, kind, seed, style), seed, material) {}

DressedPerson::DressedPerson(const BodyModel& body, const Eigen::VectorXd& betas, Outfit outfit, uint64_t seed,
                             ClothMaterial material)
    : ClothCollisionBody(body, betas, outfit.offsets_m()), outfit_(std::move(outfit)) {
  const LooseGarmentOptions options = LooseGarmentOf(outfit_, rest_joints(), seed);
  if (options.length_m > 0) Wear(Cut(GarmentOptionsFor(material, options), seed));
}

LooseGarmentOptions LooseGarmentOf(const Outfit& outfit, const MatrixX3d& rest_joints, uint64_t seed) {
  HashRandom random(seed, {0x6c6f6f73});
  LooseGarmentOptions o;
  const double pelvis = rest_joints(0, 1), knee = rest_joints(4, 1), ankle = rest_joints(7, 1),
               spine1 = rest_joints(3, 1), spine2 = rest_joints(6, 1), shoulder = rest_joints(16, 1);
  switch (outfit.kind()) {
    case GarmentKind::kSuit:
      o.length_m = 0;
      break;
    case GarmentKind::kSkirt:
      o.waist_y_m = pelvis + random.Uniform(0.7, 0.9) * (spine1 - pelvis);
      o.fullness = random.Uniform(0.4, 0.62);
      o.length_m =
          (o.waist_y_m - knee + random.Uniform(-0.12, 0.08) * (knee - ankle)) / std::sqrt(1 - 0.25 * o.fullness);
      break;
    case GarmentKind::kCoat:
      o.waist_y_m = std::min(0.35 * spine1 + 0.65 * spine2, shoulder - 0.12);
      o.fullness = random.Uniform(0.22, 0.32);
      o.length_m = o.waist_y_m - (0.5 * rest_joints(1, 1) + 0.5 * knee) + random.Uniform(-0.05, 0.1);
      o.slit_from_m = o.waist_y_m - pelvis + random.Uniform(-0.05, 0.05);
      break;
  }
  return o;
}

DressedScene::DressedScene(const DressedPerson& person, const Camera& camera, uint64_t seed, int samples,
                           const PersonLight& light)
    : person_(person),
      camera_(camera),
      samples_(samples),
      mesh_(MeshOf(person)),
      places_(mesh_.num_vertices(), 3),
      wardrobe_(person.outfit(), person.garment().around_m, seed),
      background_(camera.width, camera.height, seed),
      light_(light) {
  BODYLOOM_CHECK(camera.model == CameraModel::kPinhole, "dressed scene: expected a pinhole camera");
  BODYLOOM_CHECK(samples >= 1 && samples <= 8, "dressed scene: ", samples, " samples, expected 1..8");
  places_ << person.body().data().v_template.cast<float>(), person.garment().pattern;
}

void DressedRenderer::Assemble(const BodyPose& pose, const std::vector<Vector3d>& cloth) {
  const DressedPerson& person = scene_.person();
  const MatrixX3i& faces = person.body().data().faces;
  const LooseGarment& garment = person.garment();
  BODYLOOM_CHECK(cloth.size() == garment.sewn.size(), "dressed person: ", cloth.size(), " vertices of cloth, expected ",
                 garment.sewn.size());
  const int V = person.body().num_vertices();
  bare_ = person.BareVertices(pose);
  vertices_.resize(scene_.mesh().num_vertices(), 3);
  normals_.resize(scene_.mesh().num_vertices(), 3);
  const MatrixX3d clothed = person.Clothed(bare_, bare_normals_.Compute(bare_, faces));
  vertices_.topRows(V) = clothed;
  normals_.topRows(V) = body_normals_.Compute(clothed, faces);
  if (garment.empty()) return;
  MatrixX3d places(static_cast<Eigen::Index>(cloth.size()), 3);
  for (size_t v = 0; v < cloth.size(); ++v) places.row(static_cast<Eigen::Index>(v)) = cloth[v].transpose();
  const MatrixX3f& normals = cloth_normals_.Compute(places, garment.cloth.faces);
  for (size_t i = 0; i < garment.drawn_from.size(); ++i) {
    vertices_.row(V + static_cast<Eigen::Index>(i)) = places.row(garment.drawn_from[i]);
    normals_.row(V + static_cast<Eigen::Index>(i)) = normals.row(garment.drawn_from[i]);
  }
  is_inside_out_.resize(garment.cloth.faces.rows());
  for (Eigen::Index f = 0; f < garment.cloth.faces.rows(); ++f) {
    const auto corner = [&](int c) { return Vector3d(places.row(garment.cloth.faces(f, c)).transpose()); };
    is_inside_out_[f] = corner(0).dot((corner(1) - corner(0)).cross(corner(2) - corner(0))) > 0;
  }
}

void DressedRenderer::Resolve(const Camera& camera, bool with_shadows) {
  buffer_.Render(vertices_, scene_.mesh().data().faces, camera, {.cull_back_faces = false});
  ResolveRequest request;
  request.normal = true;
  request.vertex_normals = &normals_;
  request.vertex_attributes = {{{scene_.places().data(), size_t(scene_.places().size())}, 3}};
  if (with_shadows) request.vertex_attributes.push_back({ambient_occlusion_, 1});
  request.barycentric = with_shadows;
  ResolvePixels(buffer_, scene_.mesh(), vertices_, camera, request, &pixels_);
}

PersonLabel DressedRenderer::LabelOf(int face, const Vector3f& place) const {
  const Outfit& outfit = scene_.person().outfit();
  if (!IsCloth(face)) return outfit.LabelAt(place.cast<double>());
  return outfit.kind() == GarmentKind::kCoat ? PersonLabel::kTop : PersonLabel::kBottom;
}

Vector3f DressedRenderer::NormalOf(int face, size_t at) const {
  const Vector3f normal = Eigen::Map<const Vector3f>(&pixels_.normal[3 * at]);
  return IsCloth(face) && is_inside_out_[face - scene_.num_body_faces()] ? Vector3f(-normal) : normal;
}

/// Computes shadow maps and ambient occlusion of the assembled mesh.
void DressedRenderer::CastShadows() {
  if (!scene_.light().shadow_softness_m) return;
  const MatrixX3i& faces = scene_.mesh().data().faces;
  for (size_t k = 0; k < shadows_.size(); ++k) {
    shadows_[k].Render(vertices_, faces, scene_.light().towards[k].cast<double>(), kShadowMapPx);
  }
  ambient_occlusion_ = open_.Compute(vertices_, normals_, faces);
}

/// Irradiance at a resolved pixel, relative to an unoccluded surface that faces the light.
float DressedRenderer::LightAt(int face, size_t at, const Vector3f& normal) const {
  const PersonLight& light = scene_.light();
  float lit = light.ambient;
  Vector3d place = Vector3d::Zero();
  if (light.shadow_softness_m) {
    lit *= kThrownBack + (1 - kThrownBack) * pixels_.vertex_attributes[1][at];
    for (int c = 0; c < 3; ++c) {
      place += double(pixels_.barycentric[3 * at + c]) * vertices_.row(scene_.mesh().data().faces(face, c)).transpose();
    }
    place += kShadowLift_m * normal.cast<double>();
  }
  for (size_t k = 0; k < light.towards.size(); ++k) {
    const float facing = normal.dot(light.towards[k]);
    if (!(facing > 0)) continue;
    const float reaching =
        light.shadow_softness_m ? float(shadows_[k].ShareReaching(place, *light.shadow_softness_m)) : 1;
    lit += light.strength[k] * reaching * facing;
  }
  return lit;
}

void DressedRenderer::DrawImage(const Image& background, Image* image) {
  const int n = scene_.samples();
  Resolve(ScaledCamera(scene_.camera(), n), !ambient_occlusion_.empty());
  *image = background;
  const PixelBox& box = buffer_.box();
  const float share = 1.0F / float(n * n);
  for (int y = box.y_begin / n; y * n < box.y_end; ++y) {
    for (int x = box.x_begin / n; x * n < box.x_end; ++x) {
      Vector3f sum = Vector3f::Zero();
      int covered = 0;
      for (int s = 0; s < n * n; ++s) {
        const int i = x * n + s % n, j = y * n + s / n;
        if (!box.Contains(i, j)) continue;
        const size_t at = box.IndexOf(i, j);
        const int face = buffer_.faces()[at];
        if (face < 0) continue;
        const Vector3f place = Eigen::Map<const Vector3f>(&pixels_.vertex_attributes[0][3 * at]);
        const Vector3f normal = NormalOf(face, at);
        const float lit = LightAt(face, at, normal);
        if (IsCloth(face)) {
          const bool inner = is_inside_out_[face - scene_.num_body_faces()] != 0;
          sum += (inner ? kInnerShade : 1.0F) * lit * scene_.wardrobe().OfGarment(place);
        } else {
          sum += lit * scene_.wardrobe().OfBody(LabelOf(face, place), place);
        }
        ++covered;
      }
      if (covered == 0) continue;
      uint8_t* const pixel = image->pixel(x, y);
      const float behind = 1 - share * float(covered);
      for (int k = 0; k < 3; ++k) {
        const float value = share * sum[k] + behind * float(pixel[2 - k]);
        pixel[2 - k] = static_cast<uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
      }
    }
  }
}

void DressedRenderer::DrawTruth(Image* labels, Image* normals) {
  Resolve(scene_.camera(), false);
  const PixelBox& box = buffer_.box();
  for (int y = box.y_begin; y < box.y_end; ++y) {
    for (int x = box.x_begin; x < box.x_end; ++x) {
      const size_t at = box.IndexOf(x, y);
      const int face = buffer_.faces()[at];
      if (face < 0) continue;
      const Vector3f place = Eigen::Map<const Vector3f>(&pixels_.vertex_attributes[0][3 * at]);
      std::fill_n(labels->pixel(x, y), 3, static_cast<uint8_t>(LabelOf(face, place)));
      const Vector3f normal = NormalOf(face, at);
      for (int k = 0; k < 3; ++k) normals->pixel(x, y)[2 - k] = NormalCode(normal[k]);
    }
  }
}

void DressedRenderer::DrawIuv(Image* iuv) {
  const BodyModel& body = scene_.person().body();
  buffer_.Render(bare_, body.data().faces, scene_.camera());
  ResolveRequest request;
  request.part = request.chart_uv = true;
  ResolvePixels(buffer_, body, bare_, scene_.camera(), request, &pixels_);
  const PixelBox& box = buffer_.box();
  for (int y = box.y_begin; y < box.y_end; ++y) {
    for (int x = box.x_begin; x < box.x_end; ++x) {
      const size_t at = box.IndexOf(x, y);
      if (pixels_.part[at] == 0) continue;
      uint8_t* const pixel = iuv->pixel(x, y);
      pixel[0] = pixels_.part[at];
      for (int k = 0; k < 2; ++k) {
        pixel[1 + k] = static_cast<uint8_t>(255 * std::clamp(pixels_.chart_uv[2 * at + k], 0.0F, 1.0F));
      }
    }
  }
}

PersonFrame DressedRenderer::Render(const BodyPose& pose, const std::vector<Vector3d>& cloth, double time_s) {
  Assemble(pose, cloth);
  const Camera& camera = scene_.camera();
  PersonFrame frame;
  frame.background = scene_.background().At(time_s);
  CastShadows();
  DrawImage(frame.background, &frame.rgb);
  frame.labels = frame.normals = frame.iuv = Image(camera.width, camera.height);
  DrawTruth(&frame.labels, &frame.normals);
  if (scene_.person().body().has_parts() && scene_.person().body().data().face_iuv.rows() > 0) DrawIuv(&frame.iuv);
  return frame;
}

namespace {

/// 0 1 2 … n−1 n−1 … 1 0 0 1 …
int Mirrored(int i, int n) {
  const int m = ((i % (2 * n)) + 2 * n) % (2 * n);
  return m < n ? m : 2 * n - 1 - m;
}

struct Shape {
  float x, y, rx, ry;  ///< in heights of the image
  bool is_box;
  Vector3f colour;
};

}  // namespace

MovingBackground::MovingBackground(int width, int height, uint64_t seed)
    : width_(width), height_(height), image_(2 * width, height + height / 4) {
  BODYLOOM_CHECK(width > 0 && height > 0, "background: ", width, "x", height, " pixels");
  HashRandom random(seed, {0x6261636b});
  const auto colour = [&](double low, double high) {
    Vector3f c;
    for (float& x : c) x = float(random.Uniform(low, high));
    return c;
  };
  const Vector3f above = colour(110, 220), below = colour(60, 170), stain = colour(-45, 45);
  std::vector<Shape> shapes(6 + random.Below(5));
  for (Shape& s : shapes) {
    s = {float(random.Uniform(0, 1.6)),    float(random.Uniform(0, 1)), float(random.Uniform(0.04, 0.25)),
         float(random.Uniform(0.04, 0.3)), random.Uniform() < 0.5,      colour(40, 230)};
  }
  const uint64_t noise = random.Next();
  for (int y = 0; y < image_.height; ++y) {
    for (int x = 0; x < image_.width; ++x) {
      const float u = float(x) / float(height), v = float(y) / float(height);
      Vector3f c = above + std::min(v, 1.0F) * (below - above);
      for (const Shape& s : shapes) {
        const float dx = std::abs(u - s.x) / s.rx, dy = std::abs(v - s.y) / s.ry;
        if (s.is_box ? std::max(dx, dy) < 1 : dx * dx + dy * dy < 1) c += 0.55F * (s.colour - c);
      }
      c += (ValueNoise({6 * u, 6 * v, 0}, noise) - 0.5F) * stain +
           Vector3f::Constant(18 * (ValueNoise({40 * u, 40 * v, 0}, noise + 1) - 0.5F));
      for (int k = 0; k < 3; ++k) image_.pixel(x, y)[2 - k] = uint8_t(std::clamp(c[k], 0.0F, 255.0F));
    }
  }
  const double speed = random.Uniform(0.02, 0.06) * height, angle = random.Uniform(0, 2 * M_PI);
  velocity_px_s_ = {speed * std::cos(angle), 0.3 * speed * std::sin(angle)};
}

Image MovingBackground::At(double time_s) const {
  Image view(width_, height_);
  const Eigen::Vector2d shift = velocity_px_s_ * time_s;
  const int x0 = static_cast<int>(std::floor(shift.x())), y0 = static_cast<int>(std::floor(shift.y()));
  const int fx = static_cast<int>(256 * (shift.x() - x0)), fy = static_cast<int>(256 * (shift.y() - y0));
  std::vector<int> column(width_ + 1);
  for (int x = 0; x <= width_; ++x) column[x] = 3 * Mirrored(x + x0, image_.width);
  for (int y = 0; y < height_; ++y) {
    const uint8_t* const upper = image_.pixel(0, Mirrored(y + y0, image_.height));
    const uint8_t* const lower = image_.pixel(0, Mirrored(y + y0 + 1, image_.height));
    uint8_t* to = view.pixel(0, y);
    for (int x = 0; x < width_; ++x) {
      for (int k = 0; k < 3; ++k) {
        const int a = column[x] + k, b = column[x + 1] + k;
        const int up = (256 - fx) * upper[a] + fx * upper[b], low = (256 - fx) * lower[a] + fx * lower[b];
        *to++ = static_cast<uint8_t>(((256 - fy) * up + fy * low + 32768) >> 16);
      }
    }
  }
  return view;
}

}  // namespace bodyloom
