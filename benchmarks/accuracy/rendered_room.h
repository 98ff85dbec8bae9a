// SPDX-License-Identifier: Apache-2.0
/// Draws a room around the person of a synthetic clip, as the clip's camera sees it: pixels with exact truth for
/// everything that follows a camera's motion from the background.
///
/// The room is a box with furniture, parallel to the floor, larger than all places of the person and the camera. Its
/// floor lies where the lowest point of the body is in the median frame: feet of recorded motions sink and float by a
/// few centimetres about it.
/// Its surfaces carry smooth noise of 2 to 100 cm, rectangles (tiles, pictures, papers) and one colour each, sampled at
/// the size of a pixel. Furniture does not stand where the person walks or the camera goes, nor between them.
///   kFurnished  as above
///   kBlank      walls, floor and ceiling of one colour, lit evenly; two things on the floor keep their patterns
///   kCrowd      more people like the first, moving as the person does, until they cover 60 % of the first frame; when
///               places run out, fewer
/// Bodies are shaded and coloured by part: skin, shirt and trousers. Four samples a pixel, and grey noise with a
/// standard deviation of 2 of 255.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "data_tools/synthesis/clips/synth_clip.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/label_image.h"
#include "render/image/image.h"
#include "render/raster/visibility_buffer.h"

namespace bodyloom {

enum class RoomKind { kFurnished, kBlank, kCrowd };
/// Parses "furnished", "blank" or "crowd"; throws std::invalid_argument for other texts.
RoomKind RoomKindFromString(const std::string& text);

class RenderedRoom {
 public:
  /// Both are referred to and must outlive the room. The body has parts (DensePose's charts).
  RenderedRoom(const BodyModel& body, const SynthClip& clip, RoomKind kind, uint64_t seed);

  /// Draws a frame of the clip; `people`: 1 where a body is seen.
  void Draw(int frame, Image* image, LabelImage* people);

 private:
  /// A rectangle parallel to two of the room's axes.
  struct Surface {
    Eigen::Vector3d corner, along, across;  ///< sides with their lengths, metres
    Eigen::Vector3f colour;                 ///< red, green, blue in [0, 255]
    /// Factors of the colour, rows along `across`: of kTexel metres, then each of half the size.
    std::vector<std::vector<float>> levels;
    int columns = 0, rows = 0;
  };

  void AddSurface(const Eigen::Vector3d& corner, const Eigen::Vector3d& along, const Eigen::Vector3d& across,
                  bool patterned);
  /// All six sides of a box, room coordinates.
  void AddBox(const Eigen::Vector3d& low, const Eigen::Vector3d& high, bool patterned);
  void AddFurniture(const std::vector<Eigen::Vector3d>& people, const std::vector<Eigen::Vector3d>& cameras);
  void AddCrowd();
  [[nodiscard]] Eigen::Vector3f SurfaceColour(int face, const Eigen::Vector3d& ray, const CameraPose& camera_from_room,
                                              double metres_per_pixel_at_1) const;
  [[nodiscard]] CameraPose CameraFromRoom(int frame) const;
  /// Vertices of the clip's person, room coordinates.
  [[nodiscard]] MatrixX3d BodyInRoom(int frame) const;

  const BodyModel& body_;
  const SynthClip& clip_;
  RoomKind kind_;
  uint64_t seed_;
  CameraPose room_from_scene_;
  Eigen::Vector3d low_, high_;  ///< of the room, room coordinates, y up
  std::vector<Surface> surfaces_;
  std::vector<Eigen::Vector3d> crowd_;  ///< places beside the person, room coordinates
  VisibilityBuffer buffer_;
};

}  // namespace bodyloom
