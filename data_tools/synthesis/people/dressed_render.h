// SPDX-License-Identifier: Apache-2.0
/// Renders images of a dressed person with per-pixel ground truth.
///
/// The clothed body and the (two-sided) cloth are rendered to one visibility buffer per resolution:
/// - image: samples × samples samples per pixel. Colour = pattern (wardrobe.h) · light (PersonLight), cloth's inner
///   side at 0.7 of it, averaged with the background;
/// - labels and normals: at the pixel's centre; normals are interpolated, and flipped towards the viewer on cloth seen
///   from inside;
/// - iuv: the bare body without clothes, at the pixel's centre.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/synthesis/people/outfit.h"
#include "data_tools/synthesis/people/wardrobe.h"
#include "geometry/body/body_model.h"
#include "geometry/body/normals.h"
#include "geometry/cloth/cloth_body.h"
#include "geometry/cloth/cloth_material.h"
#include "geometry/cloth/loose_garment.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/camera.h"
#include "render/image/image.h"
#include "render/raster/resolve_pixels.h"
#include "render/raster/visibility_buffer.h"
#include "render/shadows/shadow_map.h"

namespace bodyloom {

// Lighting of a synthetic person.

/// Studio: even ambient light, and two lights from above and beside or behind the person, without shadows: rims are
/// bright, the rest shows mainly its colours. Natural: lights from any azimuth, more often from the camera's side, soft
/// or hard, with shadows and ambient occlusion.
enum class LightStyle { kStudio, kNatural };

std::string ToString(LightStyle style);
/// "studio" or "natural"; throws std::invalid_argument otherwise.
LightStyle LightStyleFromString(const std::string& name);

/// The colour of a surface with normal n is its colour, in image values, times
///   ambient · o + Σ strength · r · max(0, n·towards),
/// o: ambient openness (1 without shadows; render/shadows/shadow_map.h, a fifth of the occlusion compensated for light
/// reflected by the person), r: the share of the light that reaches the point (1 without shadows).
struct PersonLight {
  float ambient = 0.45F;
  std::array<Eigen::Vector3f, 2> towards = {Eigen::Vector3f::UnitY(),
                                            Eigen::Vector3f::UnitY()};  ///< unit, camera frame
  std::array<float, 2> strength = {0.6F, 0.2F};
  std::optional<float> shadow_softness_m;  ///< half the width of a shadow's edge; absent: there are no shadows
};

/// Returns the light of a seed; the first of the two is the stronger. `up_in_camera`: unit; light comes from above.
PersonLight LightOfSeed(const Eigen::Vector3d& up_in_camera, LightStyle style, uint64_t seed);

// A body in the clothes of a synthetic person, with the simulation of its loose garment.
//
// The clothes close to the skin are the skinned surface moved outwards along its normals (outfit.h); the loose garment
// is cloth pinned to that surface and colliding with it (geometry/cloth/cloth_run.h). It depends on the past motion:
// the same pose at another speed gives other folds.

/// Immutable, may be shared by threads. The body must outlive it.
class DressedPerson : public ClothCollisionBody {
 public:
  /// Throws std::invalid_argument when the body does not have SMPL's joints or there are more betas than components.
  DressedPerson(const BodyModel& body, const Eigen::VectorXd& betas, GarmentKind kind, uint64_t seed,
                ClothesStyle style = ClothesStyle::kPatterned, ClothMaterial material = ClothMaterial::kCotton);
  DressedPerson(BodyModel&&, const Eigen::VectorXd&, GarmentKind, uint64_t, ClothesStyle = ClothesStyle::kPatterned,
                ClothMaterial = ClothMaterial::kCotton) = delete;

  [[nodiscard]] const Outfit& outfit() const { return outfit_; }

 private:
  DressedPerson(const BodyModel& body, const Eigen::VectorXd& betas, Outfit outfit, uint64_t seed,
                ClothMaterial material);
  Outfit outfit_;
};

// Cut of the loose garment of a synthetic person's outfit.

/// Options of the garment for an outfit's kind and seed on a body with these joints (J×3, T-pose, SMPL's tree), with
/// the height of the pinned ring scaled accordingly; for a suit, which has none, length_m is 0.
LooseGarmentOptions LooseGarmentOf(const Outfit& outfit, const MatrixX3d& rest_joints, uint64_t seed);

// The background of a synthetic person: an image of gradients, noise and a few shapes, slowly panning.

/// Immutable, may be shared by threads.
class MovingBackground {
 public:
  /// Throws std::invalid_argument for a size that is not positive.
  MovingBackground(int width, int height, uint64_t seed);

  /// The view at a time (seconds) in the given size: a large image, reflected at its borders, sampled bilinearly at
  /// integer pixels + velocity · time.
  [[nodiscard]] Image At(double time_s) const;
  [[nodiscard]] const Eigen::Vector2d& velocity_px_s() const { return velocity_px_s_; }

 private:
  int width_, height_;
  Image image_;
  Eigen::Vector2d velocity_px_s_;
};

/// Data that do not change between frames. Immutable, may be shared by threads; the person must outlive it.
class DressedScene {
 public:
  /// Pinhole cameras only (std::invalid_argument otherwise). `seed`: of patterns and background.
  DressedScene(const DressedPerson& person, const Camera& camera, uint64_t seed, int samples, const PersonLight& light);

  [[nodiscard]] const DressedPerson& person() const { return person_; }
  [[nodiscard]] const Camera& camera() const { return camera_; }
  [[nodiscard]] const Wardrobe& wardrobe() const { return wardrobe_; }
  [[nodiscard]] const PersonLight& light() const { return light_; }
  [[nodiscard]] const MovingBackground& background() const { return background_; }
  [[nodiscard]] int samples() const { return samples_; }
  /// Clothed body, then cloth, as one mesh; only its faces are used.
  [[nodiscard]] const BodyModel& mesh() const { return mesh_; }
  [[nodiscard]] int num_body_faces() const { return person_.body().num_faces(); }
  /// Position on the template or on the cloth as sewn, three values per vertex of the mesh.
  [[nodiscard]] const MatrixX3f& places() const { return places_; }

 private:
  const DressedPerson& person_;
  Camera camera_;
  int samples_;
  BodyModel mesh_;
  MatrixX3f places_;
  Wardrobe wardrobe_;
  MovingBackground background_;
  PersonLight light_;
};

/// Draws frames of a scene. Keeps its memory between frames; one per thread.
class DressedRenderer {
 public:
  explicit DressedRenderer(const DressedScene& scene) : scene_(scene) {}

  /// `pose` in the camera frame; `cloth` from ClothRun (in the camera frame).
  PersonFrame Render(const BodyPose& pose, const std::vector<Eigen::Vector3d>& cloth, double time_s);

 private:
  void Assemble(const BodyPose& pose, const std::vector<Eigen::Vector3d>& cloth);
  void Resolve(const Camera& camera, bool with_shadows);
  [[nodiscard]] bool IsCloth(int face) const { return face >= scene_.num_body_faces(); }
  [[nodiscard]] PersonLabel LabelOf(int face, const Eigen::Vector3f& place) const;
  [[nodiscard]] Eigen::Vector3f NormalOf(int face, size_t at) const;
  void CastShadows();
  [[nodiscard]] float LightAt(int face, size_t at, const Eigen::Vector3f& normal) const;
  void DrawImage(const Image& background, Image* image);
  void DrawTruth(Image* labels, Image* normals);
  void DrawIuv(Image* iuv);

  const DressedScene& scene_;
  VertexNormalsOfMesh bare_normals_, body_normals_, cloth_normals_;
  MatrixX3d bare_, vertices_;
  MatrixX3f normals_;
  std::array<ShadowMap, 2> shadows_;  ///< of the two lights
  AmbientOcclusion open_;
  std::span<const float> ambient_occlusion_;  ///< by vertex, of open_; empty: there are no shadows
  std::vector<int8_t> is_inside_out_;         ///< by face of the cloth: seen from inside
  VisibilityBuffer buffer_;
  ResolvedPixels pixels_;
};

}  // namespace bodyloom
