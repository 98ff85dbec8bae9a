// SPDX-License-Identifier: Apache-2.0
/// Reads COLMAP's cameras and images, text or binary.
///
/// cameras.txt: CAMERA_ID MODEL WIDTH HEIGHT PARAMS… a line. images.txt: two lines per image, IMAGE_ID QW QX QY QZ TX
/// TY TZ CAMERA_ID NAME and its points (which are not read, but the line is there even when empty). '#': comments.
/// cameras.bin: u64 n; {u32 id, i32 model, u64 width, u64 height, f64 params}. images.bin: u64 n; {u32 id, f64 qw qx qy
/// qz tx ty tz, u32 camera_id, name ending in 0, u64 m, m × (f64 x, f64 y, u64 point3D_id)}. Little endian.
/// Poses are camera from world, quaternions Hamilton, camera axes x right, y down, z forward. The world frame and its
/// scale are arbitrary. The origin of COLMAP's pixels is the image corner: cx = cx_colmap − 0.5.
/// Pinhole models become cameras: SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV; of others only
/// the name is kept.
/// Source: colmap doc/format.rst, scene/reconstruction_io_text.cc and _binary.cc, sensor/models.h.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "geometry/scene/camera.h"

namespace bodyloom {

struct ColmapCamera {
  std::string model;
  bool is_pinhole = false;  ///< `camera` is valid
  Camera camera;
};

struct ColmapImage {
  std::string name;
  uint32_t camera_id = 0;
  CameraPose pose;
};

/// Cameras by id.
std::map<uint32_t, ColmapCamera> ColmapCamerasFromText(const std::string& text, const std::string& where);
std::map<uint32_t, ColmapCamera> ColmapCamerasFromBytes(const std::string& bytes, const std::string& where);
/// Images in the file's order.
std::vector<ColmapImage> ColmapImagesFromText(const std::string& text, const std::string& where);
std::vector<ColmapImage> ColmapImagesFromBytes(const std::string& bytes, const std::string& where);

struct ColmapModel {
  std::map<uint32_t, ColmapCamera> cameras;  ///< empty if the folder has none
  std::vector<ColmapImage> images;
};

/// Returns true if the folder contains images.bin or images.txt.
bool IsColmapFolder(const std::string& path);

/// Reads images.bin or images.txt (of a folder the binary one, as in COLMAP) and the cameras in the same folder. Throws
/// std::runtime_error naming file and place: what was found, what was expected.
ColmapModel ReadColmapModel(const std::string& folder_or_images);

}  // namespace bodyloom
