// SPDX-License-Identifier: Apache-2.0
/// Renders images of a dressed person with per-pixel ground truth.
///
/// The clothed body and the (two-sided) cloth are rendered to one visibility buffer per resolution:
/// - image: samples × samples samples per pixel. Colour = pattern (wardrobe.h) · light (person_light.h), cloth's inner
///   side at 0.7 of it, averaged with the background;
/// - labels and normals: at the pixel's centre; normals are interpolated, and flipped towards the viewer on cloth seen
///   from inside;
/// - iuv: the bare body without clothes, at the pixel's centre.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/synthesis/people/dressed_person.h"
#include "data_tools/synthesis/people/person_light.h"
#include "data_tools/synthesis/people/wardrobe.h"
#include "geometry/body/normals.h"
#include "geometry/scene/camera.h"
#include "render/image/image.h"
#include "render/raster/resolve_pixels.h"
#include "render/raster/visibility_buffer.h"
#include "render/shadows/shadow_map.h"

namespace bodyloom {

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
